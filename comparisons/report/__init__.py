"""What a person looks at: tables, figures, stress, VTU files, pages and films."""

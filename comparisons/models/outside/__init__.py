"""Programs that others wrote, asked the same questions."""

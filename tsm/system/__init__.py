"""Linear systems, Newton's method, the index."""

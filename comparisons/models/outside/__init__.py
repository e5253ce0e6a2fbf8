"""Other programs, for comparison on the same problems."""

"""The figures and claims of the paper: what is computed for them, and what becomes of the claims."""

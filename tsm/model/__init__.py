"""Numbering, the elements of a structure, and what varies along them."""

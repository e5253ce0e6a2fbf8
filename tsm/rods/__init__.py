"""Exact elements: the Reissner rod's equations from load to load."""

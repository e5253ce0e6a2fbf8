"""Following the path of equilibria."""

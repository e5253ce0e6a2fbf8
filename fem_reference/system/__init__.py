"""One equilibrium: residual, tangent, Newton's method."""

"""The contact curve, touch and friction."""

"""Which contacts are closed, and the events that change them."""

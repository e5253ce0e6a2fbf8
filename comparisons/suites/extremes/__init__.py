"""Where the models hold, where they stop, and that they say so: a matrix of extreme cases, run and judged."""

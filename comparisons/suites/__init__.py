"""Claims about the models, each judged by numbers: the verification manual, gates, extremes, the paper, the solid."""

"""What is asked: beams, supports, pins, stages, settings."""

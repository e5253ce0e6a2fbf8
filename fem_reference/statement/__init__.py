"""What is asked: strips, materials, supports, pins, stages, settings."""

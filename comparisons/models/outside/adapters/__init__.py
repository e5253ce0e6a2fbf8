"""Adapters of programs of others. Each is a program by itself: it reads a resolved scene and writes a response."""

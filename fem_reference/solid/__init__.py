"""Meshes and assembly."""

"""Renderers of what a camera sees in a home, and the film that they share."""

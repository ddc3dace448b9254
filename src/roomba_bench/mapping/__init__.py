"""Explored homes, and how far their maps are off the truth."""

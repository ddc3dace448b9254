"""Runs as a document that stands alone in one file."""

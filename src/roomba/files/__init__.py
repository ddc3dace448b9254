"""Formats of files: read strictly, written atomically."""

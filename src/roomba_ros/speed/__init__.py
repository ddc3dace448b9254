"""The speed node."""

"""The arrays of the compiled step."""

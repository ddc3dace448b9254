"""The rooms of a map, and its zones."""

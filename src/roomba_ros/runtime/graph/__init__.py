"""A node among the others of its graph: how it comes in, and which of them are there."""

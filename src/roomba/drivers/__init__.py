"""Robots that people own, as bodies of the brain: what is said on their lines."""

"""Dirty floor: where it is, when to look for it, and the way to it; `second_pass` plans it."""

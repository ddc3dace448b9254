"""Neato's robots (XV-11, Botvac D3 to D7): lines of text over USB or a serial line."""

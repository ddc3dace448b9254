"""Robots that people own, made up: their protocols over a robot in a simulated home."""

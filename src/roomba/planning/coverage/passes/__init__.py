"""Passes over the floor: along its edges and in swaths."""

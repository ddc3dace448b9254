"""The floor that was swept, and how dirty it was."""

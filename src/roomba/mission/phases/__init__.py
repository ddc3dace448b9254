"""The phases of the mission, and what leads from one to another."""

"""The phases of the mission, and the state machine of their transitions."""

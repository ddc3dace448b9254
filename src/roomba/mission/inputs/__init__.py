"""The inputs of the mission: the senses, and the planning context."""

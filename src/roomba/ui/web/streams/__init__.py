"""What is told to many at once: messages made text once, and events for programs."""

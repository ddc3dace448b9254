"""The headless robot living in real time, or faster, as a page sees and commands it."""

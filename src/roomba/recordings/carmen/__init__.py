"""CARMEN logs: text, a line for each reading, as of most of the older published drives."""

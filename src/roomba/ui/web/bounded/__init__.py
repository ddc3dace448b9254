"""What the server takes at most, and connections that are held to it."""

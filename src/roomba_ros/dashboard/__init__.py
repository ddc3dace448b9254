"""The web page over the running graph."""

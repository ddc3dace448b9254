"""The web page under viewers."""

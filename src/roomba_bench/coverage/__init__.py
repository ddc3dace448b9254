"""Cleans and what is compared with them: by area, by way, by time."""

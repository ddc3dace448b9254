"""Lidars on a serial line of their own: frames of bytes become scans."""

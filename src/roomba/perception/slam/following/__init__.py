"""The robot is followed from scan to scan, and found back where scans stop to fit."""

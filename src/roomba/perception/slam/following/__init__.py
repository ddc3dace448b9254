"""Following the robot from scan to scan, and finding it again when scans no longer fit."""

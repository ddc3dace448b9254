"""What exact scans are compared with."""

"""References for exact scans."""

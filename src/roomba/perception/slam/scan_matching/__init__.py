"""Points on surfaces of a scan, and where they fit: on surfels nearby, or in a wide window."""

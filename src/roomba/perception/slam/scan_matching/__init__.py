"""Surface points of a scan, and matching: to surfels nearby, or in a wide window."""

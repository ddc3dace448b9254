"""Recognition of floors, and of changes on them."""

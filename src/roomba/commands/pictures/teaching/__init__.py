"""Pictures of the tutorials, and of the pages of the algorithms."""

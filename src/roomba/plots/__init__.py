"""How plots look, and how homes are drawn in them."""

"""The style of plots, and the drawing of homes in them."""

"""The order of the passes, and the ways between them."""

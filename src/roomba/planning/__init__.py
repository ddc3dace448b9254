"""Planning of paths, coverage and exploration over a map."""

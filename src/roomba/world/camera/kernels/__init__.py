"""The camera's compiled loops, a file for each kind of surface."""

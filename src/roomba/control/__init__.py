"""Control loops: from setpoints and paths to twists, and the limits above them."""

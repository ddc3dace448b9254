"""Times of recorded messages: mended, made up where there are none, and in order."""

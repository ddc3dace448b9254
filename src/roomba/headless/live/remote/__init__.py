"""A robot that cleans by its own brain, watched and told what to do from other threads."""

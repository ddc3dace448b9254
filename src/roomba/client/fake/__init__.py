"""A robot for tests of user interfaces."""

"""The robots that people own and this brain drives: one table."""

"""The demonstrations of the documents: robots that people own, made up, clean by their plans."""

"""What is to be cleaned, what was, and what was missed."""

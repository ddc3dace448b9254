"""What floor was cleaned, and how dirty it was."""

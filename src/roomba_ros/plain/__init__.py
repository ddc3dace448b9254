"""Any message as plain values for JSON, and back."""

"""Messages become values, and values messages, here alone."""

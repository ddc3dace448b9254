"""A clean: its request, its ledger, and its result."""

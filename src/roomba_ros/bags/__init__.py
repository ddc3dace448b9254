"""Recorded drives: localized, mapped, written."""

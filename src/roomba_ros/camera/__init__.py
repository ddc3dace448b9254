"""The picture service and its client."""

"""Finishing a map after the drive: keyframes are made to agree, and walls laid along the axes."""

"""The runs of a campaign: their definition, where they are made, and their results."""

"""The runs of a campaign: what they are to be, where they are made, and what is stored."""

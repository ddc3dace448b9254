"""The simulated home and robot body: the truth, which the brain never reads."""

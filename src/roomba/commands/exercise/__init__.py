"""``./roomba exercise``: tasks for learners, and checks that run what they wrote."""

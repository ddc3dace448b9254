"""Maps that the robot makes: ``./roomba map``, and how far they are off the truth."""

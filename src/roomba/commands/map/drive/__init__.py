"""``./roomba map --bag``: maps of recorded drives."""

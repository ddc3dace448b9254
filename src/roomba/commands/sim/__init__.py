"""``./roomba sim``: the whole robot cleans a home, without ROS and as fast as it can."""

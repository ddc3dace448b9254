"""A robot vacuum: its simulated world, its brain and its user interfaces, without ROS."""

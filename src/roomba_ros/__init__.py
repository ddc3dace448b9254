"""ROS at the edge: messages become values in ``convert``; each node has a file."""

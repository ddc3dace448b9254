"""ROS at the edge: messages become values in convert.py, and one node stands in each file."""

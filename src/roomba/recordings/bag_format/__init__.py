"""The format of bags of ROS 1: their records, and the index of one that was cut short."""

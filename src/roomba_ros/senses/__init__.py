"""What the robot senses, on ROS: messages become readings here, once."""

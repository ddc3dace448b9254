"""What is done once a drive is over: keyframes agree, and walls lie along the axes."""

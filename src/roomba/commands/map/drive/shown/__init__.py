"""What the scans of a recorded drive show: of its lidar, its odometry and its gyro."""

"""The Gaussian belief of the pose: predicted by dead reckoning, corrected by scans."""

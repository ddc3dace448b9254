"""The runs of the robot, kept: what each achieved, and a recording to look at it again."""

"""Keep a robot on its path."""


def drive(pose, path, speed):
    return speed, 0.0  # TODO: turn towards the path, and stand at its end

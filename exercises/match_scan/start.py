"""Where a scan was taken."""


def matched_pose(ranges, angles, solid, resolution, origin, guess):
    return guess  # TODO: the pose near it by which the beams end on walls

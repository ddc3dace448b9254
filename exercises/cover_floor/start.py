"""Pass over all of a floor."""


def coverage_path(free, start):
    return [start, (start[0], free.shape[1] - 4)]  # TODO: all the other rows

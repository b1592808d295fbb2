"""What a share of lifts tells: intervals, and where it crosses one half."""
import math

import numpy


def wilson(events, runs, z=1.959964):
    share = events / runs
    middle = (share + z * z / (2 * runs)) / (1 + z * z / runs)
    half = z / (1 + z * z / runs) * math.sqrt(share * (1 - share) / runs + z * z / (4 * runs * runs))
    return max(0.0, middle - half), min(1.0, middle + half)


def share_of_nodes(survived, inside=None):
    """survived: [noise][acceleration], one lift at a node. Share of the nodes inside, and the variance of a lift about the
    probability of its node: of a map only that makes the share uncertain. It is half the mean square of the difference to
    the next acceleration, whose probability is nearly the same."""
    survived = numpy.asarray(survived, float)
    inside = numpy.ones(survived.shape, bool) if inside is None else inside
    pairs = inside[:, 1:] & inside[:, :-1]
    return {"nodes": int(inside.sum()), "survived": float(survived[inside].mean()),
            "variance": float((numpy.diff(survived, axis=1)[pairs] ** 2).mean() / 2)}


def falling(values):
    """The falling curve nearest to the values, by pooling those that rise."""
    blocks = []
    for value in values:
        blocks.append([value, 1])
        while len(blocks) > 1 and blocks[-2][0] < blocks[-1][0]:
            (a, n), (b, m) = blocks[-2:]
            blocks[-2:] = [[(a * n + b * m) / (n + m), n + m]]
    return numpy.concatenate([numpy.full(n, value) for value, n in blocks])


def half_crossing(x, share):
    """Where the falling curve crosses one half, between neighbouring places."""
    curve = falling(share)
    below = numpy.flatnonzero(curve < 0.5)
    if not len(below) or below[0] == 0:
        return float(x[-1] if not len(below) else x[0])
    i = below[0]
    return float(x[i - 1] + (curve[i - 1] - 0.5) / (curve[i - 1] - curve[i]) * (x[i] - x[i - 1]))


def half_crossing_error(x, share, runs, seed, times=2000):
    """Standard error of half_crossing, by drawing the lifts of every node again."""
    random = numpy.random.Generator(numpy.random.PCG64(seed))
    again = [half_crossing(x, random.binomial(runs, share) / runs) for _ in range(times)]
    return float(numpy.std(again, ddof=1))

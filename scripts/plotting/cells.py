"""The cells of a map: where each begins and ends, and the range of their colours."""
import math

import numpy as np


def cell_size(values, limits):
    """The smallest distance between values that differ by more than rounding; of one value, a share of the panel."""
    gaps = np.diff(distinct(values))
    if gaps.size:
        return gaps.min()
    return 1.0 if any(math.isnan(limit) for limit in limits) else abs(limits[1] - limits[0]) / 50


def distinct(values):
    """In order, those that differ by more than rounding. Positive values may span many decades."""
    known = np.unique(values[np.isfinite(values)])
    if not known.size:
        return known
    span = np.ptp(known)
    rounding = np.clip(1e-6 * known[1:], 1e-12 * span, 1e-6 * span) if known[0] > 0 else 1e-6 * span
    return known[np.append(True, np.diff(known) > rounding)]


def asks_for_log(columns):
    """Returns whether the axis of these columns is logarithmic: declared so, or four values or more over a decade or
    more in equal ratios."""
    if any(column.is_log for column in columns):
        return True
    if not columns or any(column.names for column in columns):
        return False
    values = distinct(np.concatenate([column.values for column in columns]))
    if not 4 <= values.size <= 100 or values[0] <= 0 or values[-1] < 10 * values[0]:
        return False
    ratios = values[1:] / values[:-1]
    return bool(ratios.max() < 1.05 * ratios.min())


def cell_edges(column, is_log):
    """Of each value of a whole grid the ends of its cell: half-way to its neighbours, on a log axis in equal ratios."""
    places = distinct(column.values)
    if not places.size:
        return column.values, column.values
    at = np.log(places) if is_log else places
    if at.size == 1:
        half = 0.5 if is_log or column.names else 0.5 * (abs(at[0]) or 1.0)
        edges = np.array([at[0] - half, at[0] + half])
    else:
        middle = (at[1:] + at[:-1]) / 2
        edges = np.concatenate([[2 * at[0] - middle[0]], middle, [2 * at[-1] - middle[-1]]])
    edges = np.exp(edges) if is_log else edges
    cell = np.maximum(np.searchsorted(places, column.values, side="right") - 1, 0)
    return edges[cell], edges[cell + 1]


def cell_ends(curve, panel):
    """Left and right, and lower and upper ends of the cells of all samples. A map is a grid; squares are some cells of
    one."""
    return tuple(ends_along(curve, name, limits, asks_for_log([getattr(other, name) for other in panel.curves]))
                 for name, limits in (("x", panel.x_range), ("y", panel.y_range)))


def ends_along(curve, name, limits, is_log):
    """Both ends of the cells along one axis, which is logarithmic or not."""
    column = getattr(curve, name)
    if curve.style == "map":
        return cell_edges(column, is_log)
    at = np.log(column.values) if is_log else column.values
    half = cell_size(at, [math.nan, math.nan] if is_log else limits) / 2
    return tuple(np.exp(end) if is_log else end for end in (at - half, at + half))


def outlines(curve, panel, shown):
    """The four corners of each cell that is shown."""
    (left, right), (low, high) = (tuple(end[shown] for end in ends) for ends in cell_ends(curve, panel))
    return np.stack([np.stack(corner, axis=-1) for corner in ((left, low), (right, low), (right, high), (left, high))],
                    axis=1)


def colour_range(column):
    """Of a map: that of its values. What is declared a fraction has the same colours in all figures, from 0 to 1, and an
    enum has a colour for each name."""
    if column.limits:
        return column.limits
    values = np.array(list(column.names), dtype=float) if column.names else column.values[np.isfinite(column.values)]
    low, high = (values.min(), values.max()) if values.size else (0.0, 1.0)
    if column.is_fraction:
        return min(low, 0.0), max(high, 1.0)
    around = 0.1 * abs(low) or 1.0
    return (low, high) if high > low else (low - around, high + around)

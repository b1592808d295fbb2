"""Draws a panel whose one curve is a surface: heights over a grid, in perspective, with three axes."""
import math

import matplotlib.ticker
import numpy as np

from .typeset import typeset

LONGEST = 150  # lines of the grid along each axis that are drawn
DEGREES_UP, DEGREES_ROUND = 32, -62  # where the viewer is
TICKS = 6  # along the longest axis


def is_surface(panel):
    return any(curve.style == "surface" for curve in panel.curves)


def grid_of(curve):
    """The two axes and, by row and column, the heights; NaN where the grid has no sample."""
    (across, at_column), (along, at_row) = (np.unique(column.values, return_inverse=True) for column in (curve.x, curve.y))
    heights = np.full((along.size, across.size), math.nan)
    heights[at_row, at_column] = curve.z.values
    return across, along, heights


def thinned(heights, axis):
    """Numbers of the lines across this axis that are drawn: the first, the last, and those with the lowest and with the
    highest point of each share."""
    count = heights.shape[axis]
    if count <= LONGEST:
        return np.arange(count)
    low, high = (end(heights, axis=1 - axis, initial=empty, where=np.isfinite(heights))
                 for end, empty in ((np.min, math.inf), (np.max, -math.inf)))
    shares = np.array_split(np.arange(1, count - 1), LONGEST // 2 - 1)
    return np.unique([0, count - 1, *(share[end(of[share])] for share in shares for of, end in ((low, np.argmin), (high, np.argmax)))])


def few_ticks(low, high):
    """Returns round ticks of a short axis, and their labels. There is room for the first and the last label only."""
    ticks = matplotlib.ticker.MaxNLocator(3, steps=[1, 2, 5, 10]).tick_values(low, high)
    ticks = ticks[(ticks >= low) & (ticks <= high)]
    labels = [f"{tick:g}".replace("-", "\u2212") for tick in ticks]
    return ticks, [*labels[:1], *("" for _ in labels[1:-1]), *labels[1:][-1:]]


def draw_surface(axes, panel, axis_label):
    """axes: of three dimensions, equally scaled. axis_label: names an axis."""
    curve = next(curve for curve in panel.curves if curve.style == "surface")
    across, along, heights = grid_of(curve)
    columns, rows = thinned(heights, 1), thinned(heights, 0)
    shown = heights[np.ix_(rows, columns)]
    x, y = np.meshgrid(across[columns], along[rows])
    surface = axes.plot_surface(x, y, shown, cmap="viridis", rcount=rows.size, ccount=columns.size, linewidth=0,
                                antialiased=False, rasterized=True)
    surface.set_clip_on(False)  # a long surface is wider than the square that the axes take
    limits = [(values.min(), values.max()) for values in (across, along, shown[np.isfinite(shown)])]
    for set_limits, ends in zip((axes.set_xlim, axes.set_ylim, axes.set_zlim), limits):
        set_limits(*ends)
    axes.set_box_aspect([max(high - low, 1e-9) for low, high in limits], zoom=1.7)
    axes.tick_params(pad=-3)
    axes.tick_params("z", pad=-1)
    axes.view_init(DEGREES_UP, DEGREES_ROUND)
    labels = (panel.x_label, panel.y_label, axis_label("", [curve.z]))
    longest = max(max(high - low for low, high in limits), 1e-9)
    for axis, label, (low, high), pad in zip((axes.xaxis, axes.yaxis, axes.zaxis), labels, limits, (2, -5, -4)):
        bins = round(TICKS * (high - low) / longest)
        if bins > 1:
            axis.set_major_locator(matplotlib.ticker.MaxNLocator(bins))
        else:
            axis.set_ticks(*few_ticks(low, high))
        axis.set_label_text(typeset(label))
        axis.labelpad = pad


def add_title(axes):
    """Moves the title above the left end of the panel, because a view in perspective takes only the middle of it."""
    whole, middle = axes.get_position(original=True), axes.get_position()
    axes.set_title(axes.get_title(loc="left"), loc="left", x=(whole.x0 - middle.x0) / middle.width)

"""Draws a panel whose one curve is a surface: heights over a grid, in perspective, with three axes."""
import math

import matplotlib.ticker
import numpy as np

from .typeset import typeset

LONGEST = 150  # lines of the grid along each axis that are drawn
DEGREES_UP, DEGREES_ROUND = 32, -62  # where the viewer is
TICKS = 6  # along the longest axis
BAR_IN = 0.1  # the width of the colour bar


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


def draw_surface(axes, panel, add_colour_bar):
    """axes: of three dimensions, equally scaled. add_colour_bar: of plotting.drawing. None: the
    picture is too small for a bar and for numbers."""
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
    axes.view_init(DEGREES_UP, DEGREES_ROUND)
    longest = max(max(high - low for low, high in limits), 1e-9)
    for axis, label, (low, high), pad in zip((axes.xaxis, axes.yaxis), (panel.x_label, panel.y_label), limits, (2, -5)):
        axis.set_major_locator(matplotlib.ticker.MaxNLocator(max(2, round(TICKS * (high - low) / longest))))
        axis.set_label_text(typeset(label))
        axis.labelpad = pad
    axes.set_zticks([])  # the colour bar says the heights
    if add_colour_bar:
        add_colour_bar(axes, surface, curve.z, BAR_IN)
    else:
        axes.set(xticks=[], yticks=[], xlabel="", ylabel="")


def use_width(axes):
    """Moves the title and the colour bar to the left end of the panel, because a view in perspective takes only the middle
    of it."""
    whole, middle = axes.get_position(original=True), axes.get_position()
    axes.set_title(axes.get_title(loc="left"), loc="left", x=(whole.x0 - middle.x0) / middle.width)
    width_in, height_in = axes.figure.get_size_inches()
    for bar in axes.child_axes:
        bar.set_axes_locator(None)
        bar.set_position([whole.x0, whole.y0 + 0.15 * whole.height, BAR_IN / width_in, 0.65 * whole.height])

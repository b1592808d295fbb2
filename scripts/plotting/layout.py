"""Puts the panels of a figure on one canvas, one or two columns of a journal wide."""
import dataclasses
import math

import matplotlib
import matplotlib.figure
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg

from plotting.cells import colour_range
from plotting.curves import has_cells
from plotting.drawing import draw_panel, is_image
from plotting.legends import LARGEST_SHARE, add_legends, share
from plotting.picture_file import save
from plotting.scene import draw_scene
from plotting.style import COLUMN_IN, LETTER_IN, LINES, PAGE_IN, PNG_DPI, RC, looks
from plotting.surface import add_title, is_surface
from plotting.typeset import wrapped
from plotting.units import in_shown_units

PAD_IN, HEADING_LINE_IN = 0.06, 0.155
LABELS_IN = 0.6  # about what the labels of an axis and the gap to the next panel take
TALLEST_IN, SMALLEST = 9.2, 0.6  # a picture fits on a page, unless its panels became smaller than this share
DENSE = 30  # a curve that goes up and down so often needs a wide picture


def has_range(panel):
    return not all(math.isnan(limit) for limit in panel.x_range + panel.y_range)


def set_equal_aspect(axes, panel):
    """One metre as long across as up. Ranges that the file gives stay; automatic ones may grow to fill the panel."""
    axes.set_aspect("equal", adjustable="box" if has_range(panel) else "datalim", anchor="SW")


def is_dense(curve):
    values = curve.y.values[np.isfinite(curve.y.values)]
    return curve.style in LINES and values.size > 200 and np.abs(np.diff(values)).sum() > DENSE * np.ptp(values) > 0


def places(panels):
    """Row and column of each panel: as the file says where it says so for all, else one below the other."""
    given = [panel.place for panel in panels]
    if None in given or len(set(given)) < len(given):
        return [(row, 0) for row in range(len(panels))]
    return given


def widths_in(panels, columns):
    """The widths that the picture may have, the first that is wide enough for its legends is taken."""
    wide = columns > 1 or any(is_surface(panel) or any(map(is_dense, panel.curves)) for panel in panels)
    return (PAGE_IN,) if wide else (COLUMN_IN, PAGE_IN)


def panel_height(axes, panel, width, size):
    """Inches for a panel that is so wide. size: rows and columns of the figure."""
    rows, columns = size
    if panel.scene:
        return width * panel.scene.proportion
    (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
    if is_image(panel):
        return width * abs(y1 - y0) / abs(x1 - x0)
    if is_surface(panel):
        return 0.34 * width
    usual = min(max(0.7 * width, 1.0), 2.0) if columns > 1 else max(1.05, min(2.0, 3.2 / rows))
    if has_cells(panel):
        usual = max(usual, min(0.8 * width, 2.6))
    if panel.equal_aspect:
        return min(max(width * abs(y1 - y0) / abs(x1 - x0), 0.4 if has_range(panel) else usual), 3.2)
    return usual


def margins(canvas, axes):
    """What labels and legend need left, right, below and above, in inches. A view in perspective has its labels inside
    its panel, and only the title above it."""
    if axes.name == "3d":
        return [PAD_IN, PAD_IN, PAD_IN, PAD_IN + 0.2]
    outer = axes.get_tightbbox(canvas.canvas.get_renderer(), for_layout_only=True)
    whole, inner = (axes.get_position(original).transformed(canvas.transFigure) for original in (True, False))
    return [max(0.0, size) / canvas.dpi + PAD_IN  # equal aspect may have made it narrower for now
            for size in (whole.x0 - outer.x0, outer.x1 - whole.x1, inner.y0 - outer.y0, outer.y1 - inner.y1)]


def guess(canvas, drawn, size):
    """Places for the panels before anything is known about their labels."""
    rows, columns = size
    width, height = canvas.get_size_inches()
    for (row, column), axes, _ in drawn:
        axes.set_position([column / columns + LABELS_IN / width, 1 - (row + 1) / rows + 0.4 / height,
                           1 / columns - 1.1 * LABELS_IN / width, 1 / rows - 0.7 / height])


def arrange(canvas, drawn, size, top_in):
    """All panels are equally wide, rows as high as their panels ask, and the canvas as high as the rows. Returns the
    factor by which the heights were reduced to fit on a page; 1: not reduced. (Constrained layout measures everything
    twice, which takes half of the time of a figure.)"""
    rows, columns = size
    guess(canvas, drawn, size)
    needs = [(cell, margins(canvas, axes)) for cell, axes, _ in drawn]
    left, right = ([max((need[side] for cell, need in needs if cell[1] == column), default=PAD_IN)
                    for column in range(columns)] for side in (0, 1))
    below, above = ([max((need[side] for cell, need in needs if cell[0] == row), default=PAD_IN)
                     for row in range(rows)] for side in (2, 3))
    inner = (canvas.get_figwidth() - sum(left) - sum(right)) / columns
    heights = [max((panel_height(axes, panel, inner, size) for cell, axes, panel in drawn if cell[0] == row), default=0)
               for row in range(rows)]
    around = top_in + sum(above) + sum(below) + PAD_IN
    smaller = min(1.0, max((TALLEST_IN - around) / sum(heights), SMALLEST))
    heights = [smaller * height for height in heights]
    width, height = canvas.get_figwidth(), around + sum(heights)
    canvas.set_size_inches(width, height)
    for (row, column), axes, _ in drawn:
        x = sum(left[:column + 1]) + sum(right[:column]) + column * inner
        y = height - top_in - sum(above[:row + 1]) - sum(below[:row]) - sum(heights[:row + 1])
        axes.set_position([x / width, y / height, inner / width, heights[row] / height])
    return smaller


def align(drawn):
    """Equal aspect may narrow a panel. Those below it with the same x_range follow, so that x stays above x."""
    for _, axes, panel in drawn:
        axes.apply_aspect()
        if is_surface(panel):
            add_title(axes, panel)
    for (_, column), narrowed, panel in drawn:
        if not (panel.equal_aspect and has_range(panel)):
            continue
        x, width = narrowed.get_position().x0, narrowed.get_position().width
        for (_, other_column), axes, other in drawn:
            if other_column == column and other.x_range == panel.x_range and not other.equal_aspect:
                box = axes.get_position()
                axes.set_position([x, box.y0, width, box.height])


def is_plot(panel):
    return not (panel.scene or is_surface(panel) or is_image(panel))


def say_once(drawn):
    """Removes an axis label that repeats that of the panel to the left, or of the panel below if its limits are equal
    too."""
    at = {cell: (axes, panel) for cell, axes, panel in drawn if is_plot(panel)}
    heights = {cell: axes.get_ylabel() for cell, (axes, _) in at.items()}
    for (row, column), (axes, panel) in at.items():
        below = at.get((row + 1, column))
        if heights.get((row, column - 1)) == axes.get_ylabel():
            axes.set_ylabel("")
        same = below and below[0].get_xlabel() == axes.get_xlabel() and not panel.equal_aspect
        if same and np.allclose(below[0].get_xlim(), axes.get_xlim()):
            axes.set_xlabel("")
            axes.tick_params(labelbottom=False)


def bars_of(panels, cells):
    """Whether each panel has a bar for its colours: in a row with the same colours only the last."""
    def colours(panel):
        return next(((colour_range(c.z), c.z.units, c.z.long_name) for c in panel.curves if c.style == "map"), None)

    by_cell = {cell: colours(panel) for cell, panel in zip(cells, panels)}
    return [by_cell[cell] is None or by_cell.get((cell[0], cell[1] + 1)) != by_cell[cell] for cell in cells]


def composed(figure, width_in, titled):
    """The canvas with everything in its place, and what arrange() returns."""
    cells = places(figure.panels)
    rows, columns = size = tuple(1 + max(cell[i] for cell in cells) for i in (0, 1))
    canvas = matplotlib.figure.Figure(figsize=(width_in, 1.8 * rows), dpi=PNG_DPI)
    FigureCanvasAgg(canvas)
    of_curve, about_in, drawn = looks(figure.panels), width_in / columns - LABELS_IN, []
    for i, (panel, cell, bar) in enumerate(zip(figure.panels, cells, bars_of(figure.panels, cells))):
        axes = canvas.add_axes([0, 0, 1, 1], label=str(i), projection="3d" if is_surface(panel) else None)
        if panel.scene:
            draw_scene(axes, panel, width_in / columns)
        else:
            draw_panel(axes, panel, of_curve, about_in, bar, about_in + (0.35 if cell[1] < columns - 1 else 0))
        if panel.equal_aspect:
            set_equal_aspect(axes, panel)
        drawn.append((cell, axes, panel))
    say_once(drawn)
    heading = wrapped(figure.heading, int((width_in - 2 * PAD_IN) / LETTER_IN / 1.12)) if titled else ""
    top_in = PAD_IN + (HEADING_LINE_IN * (1 + heading.count("\n")) + PAD_IN if heading else 0)
    top_in += add_legends(canvas, [axes for _, axes, _ in drawn], about_in, top_in, PAD_IN)
    smaller = arrange(canvas, drawn, size, top_in)
    canvas.suptitle(heading, x=PAD_IN / width_in, y=1 - PAD_IN / canvas.get_figheight(), ha="left", va="top")
    align(drawn)
    return canvas, smaller


def draw_figure(figure, files, titled):
    """files: with the endings png, svg or pdf. titled: with its heading, which a page shows above it."""
    matplotlib.rcParams.update(RC)
    figure = in_shown_units(figure)
    for width_in in widths_in(figure.panels, 1 + max(cell[1] for cell in places(figure.panels))):
        canvas, smaller = composed(figure, width_in, titled)
        if share(canvas) <= LARGEST_SHARE:
            break
    if smaller < 0.9 and not any(panel.place for panel in figure.panels):  # too many below each other
        beside = [dataclasses.replace(panel, place=divmod(i, 2)) for i, panel in enumerate(figure.panels)]
        canvas, _ = composed(dataclasses.replace(figure, panels=beside), PAGE_IN, titled)
    for file in files:
        save(canvas, file, figure)
    return canvas

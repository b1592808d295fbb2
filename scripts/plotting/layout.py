"""Puts the panels of a figure on one canvas, one or two columns of a journal wide."""
import dataclasses
import math
import re

import matplotlib
import matplotlib.figure
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg

from .cells import colour_range
from .curves import has_cells, room_above_in
from .drawing import add_colour_bar, add_words, draw_panel, is_image, title_words
from .legends import LARGEST_SHARE, add_legends, share
from .picture_file import save
from .scene import draw_scene
from .style import COLUMN_IN, LINES, PAGE_IN, PNG_DPI, RC, looks
from .surface import is_surface, use_width
from .units import in_shown_units
from .wrapping import HEADING, TITLE, text_width_in, wrapped

PAD_IN, HEADING_LINE_IN = 0.06, 0.155
MARGIN_IN = 0.45  # the widest right margin that is made for titles
LABELS_IN = 0.6  # about what the labels of an axis and the gap to the next panel take
TALLEST_IN, SMALLEST = 9.2, 0.5  # a picture fits on a page, unless its plots became smaller than this share
BESIDE = 0.75  # how high a plot is, if a panel beside it cannot be higher
SMALL_IN = 2.2  # width of a picture in a gallery
FLAT = 0.3  # a panel of equal aspect that is lower than this share of its width needs a wide picture
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


def is_flat(panel):
    """Returns whether a panel of equal aspect would be a narrow strip in one column."""
    if not panel.equal_aspect or math.isnan(panel.x_range[0]):
        return False
    heights = np.concatenate([np.ravel(curve.y.values) for curve in panel.curves] or [np.zeros(0)])
    heights = heights[np.isfinite(heights)]
    return heights.size > 0 and np.ptp(heights) < FLAT * (panel.x_range[1] - panel.x_range[0])


def widths_in(panels, columns):
    """The widths that the picture may have, the first that is wide enough for its legends is taken."""
    wide = columns > 1 or any(is_surface(panel) or is_flat(panel) or any(map(is_dense, panel.curves)) for panel in panels)
    return (PAGE_IN,) if wide else (COLUMN_IN, PAGE_IN)


def plot_height(width, size):
    """Returns the height of a plot of this width, in inches. size: rows and columns of the figure."""
    rows, columns = size
    return min(max(0.7 * width, 1.0), 2.0) if columns > 1 else max(1.05, min(2.0, 3.2 / rows))


def is_flexible(panel):
    """Returns whether a panel can become lower without becoming narrower."""
    return is_plot(panel) and not panel.equal_aspect


def panel_height(axes, panel, width, size):
    """Returns the height of a panel of this width, in inches."""
    if panel.scene:
        return width * panel.scene.proportion
    (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
    if is_image(panel):
        return width * abs(y1 - y0) / abs(x1 - x0)
    if is_surface(panel):
        return 0.34 * width
    usual = plot_height(width, size)
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
    inner = axes.get_position().transformed(canvas.transFigure)
    return [max(0.0, size) / canvas.dpi + PAD_IN  # equal aspect may have made it smaller for now
            for size in (inner.x0 - outer.x0, outer.x1 - inner.x1, inner.y0 - outer.y0, outer.y1 - inner.y1)]


def guess(canvas, drawn, size):
    """Places for the panels before anything is known about their labels."""
    rows, columns = size
    width, height = canvas.get_size_inches()
    for (row, column), axes, _ in drawn:
        axes.set_position([column / columns + LABELS_IN / width, 1 - (row + 1) / rows + 0.4 / height,
                           1 / columns - 1.1 * LABELS_IN / width, 1 / rows - 0.7 / height])


def columns_in(canvas, drawn, columns):
    """Returns the room that labels need left and right of each column, and the width of a panel. All are equally
    wide."""
    needs = [(cell, margins(canvas, axes)) for cell, axes, _ in drawn]
    left, right = ([max((need[side] for cell, need in needs if cell[1] == column), default=PAD_IN)
                    for column in range(columns)] for side in (0, 1))
    return left, right, (canvas.get_figwidth() - sum(left) - sum(right)) / columns


def heights_in(drawn, width, size, around):
    """Returns the heights of the rows, and the factor by which plots were made lower to fit on a page; 1: not lower.
    around: the height of labels, titles and legends."""
    rows = [[(axes, panel) for cell, axes, panel in drawn if cell[0] == row] for row in range(size[0])]
    wanted = [max((panel_height(axes, panel, width, size) for axes, panel in row), default=0) for row in rows]
    fixed = [max((panel_height(axes, panel, width, size) for axes, panel in row if not is_flexible(panel)), default=0)
             for row in rows]
    wanted = [max(low, BESIDE * high) if low else high for low, high in zip(fixed, wanted)]
    flexible = sum(high - low for high, low in zip(wanted, fixed))
    smaller = min(1.0, max((TALLEST_IN - around - sum(fixed)) / flexible, SMALLEST)) if flexible > 0 else 1.0
    return [max(low, smaller * high) for low, high in zip(fixed, wanted)], smaller


def arrange(canvas, drawn, size, columns, top_in):
    """Puts the panels in their places and sets the height of the canvas. columns: of columns_in(). Returns the factor
    of heights_in(). (Constrained layout measures everything twice, which takes half of the time of a figure.)"""
    left, right, inner = columns
    needs = [(cell, margins(canvas, axes)) for cell, axes, _ in drawn]
    below, above = ([max((need[side] for cell, need in needs if cell[0] == row), default=0)
                     for row in range(size[0])] for side in (2, 3))
    around = top_in + sum(above) + sum(below) + PAD_IN
    heights, smaller = heights_in(drawn, inner, size, around)
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
            use_width(axes)
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


def repeats_below(at, cell):
    """Returns whether the panel below has the same x label and limits. at: axes and panel of each plot."""
    axes, panel = at[cell]
    below = at.get((cell[0] + 1, cell[1]))
    same = below and below[0].get_xlabel() == axes.get_xlabel() and not panel.equal_aspect
    return bool(same) and np.allclose(below[0].get_xlim(), axes.get_xlim())


def say_once(drawn):
    """Removes an axis label that repeats that of the panel to the left. Labels and numbers that the panels below repeat
    are removed if that is so in the whole row, which else would keep an empty band."""
    at = {cell: (axes, panel) for cell, axes, panel in drawn if is_plot(panel)}
    heights = {cell: axes.get_ylabel() for cell, (axes, _) in at.items()}
    kept = {cell[0] for cell in at if not repeats_below(at, cell)}
    for (row, column), (axes, _) in at.items():
        if heights.get((row, column - 1)) == axes.get_ylabel():
            axes.set_ylabel("")
        if row not in kept:
            axes.tick_params(labelbottom=False)
    for (row, _), (axes, _) in at.items():
        if row not in kept:
            axes.set_xlabel("")


def bars_of(panels, cells):
    """Whether each panel has a bar for its colours: in a row with the same colours only the last."""
    def colours(panel):
        return next(((colour_range(c.z), c.z.units, c.z.long_name) for c in panel.curves if c.style == "map"), None)

    by_cell = {cell: colours(panel) for cell, panel in zip(cells, panels)}
    return [by_cell[cell] is None or by_cell.get((cell[0], cell[1] + 1)) != by_cell[cell] for cell in cells]


def letter_of(cells, i):
    """Returns the letter of a panel in reading order: a, b, ..., z, aa, ab, ...; a single panel has none."""
    at = sorted(cells).index(cells[i])
    return ("" if at < 26 else chr(96 + at // 26)) + chr(97 + at % 26) if len(cells) > 1 else ""


def title_of(panel, letter):
    """Returns the title of a panel. Beside others one without a title has the name of its vertical axis."""
    return panel.title or (letter and re.sub(r" \([^()]*\)$", "", panel.y_label))


def draw_panels(figure, canvas, cells, size, with_keys):
    """Draws the panels without titles. with_keys: also colour bars of maps. Returns the cell, the axes and the panel of each."""
    of_curve, drawn, (rows, columns) = looks(figure.panels), [], size
    about_in = canvas.get_figwidth() / columns - LABELS_IN
    label_in = min(plot_height(about_in, size), 0.95 * TALLEST_IN / rows - LABELS_IN) + 0.1
    for i, (panel, cell, bar) in enumerate(zip(figure.panels, cells, bars_of(figure.panels, cells))):
        axes = canvas.add_axes([0, 0, 1, 1], label=str(i), projection="3d" if is_surface(panel) else None)
        if panel.scene:
            draw_scene(axes, panel, canvas.get_figwidth() / columns, add_colour_bar)
        else:
            draw_panel(axes, panel, of_curve, about_in, bar and with_keys, label_in)
        if panel.equal_aspect:
            set_equal_aspect(axes, panel)
        drawn.append((cell, axes, panel))
    return drawn


def with_room_for_titles(columns, drawn, titles):
    """Makes the right margin wider if titles of the last column then fit in one line. titles: of each panel."""
    left, right, inner = columns
    count = len(left)
    widths = [text_width_in(title, TITLE) for (cell, _, _), title in zip(drawn, titles) if cell[1] == count - 1]
    more = (max(widths, default=0) - inner) * count / max(count - 1, 1)
    if count == 1 or not right[-1] < PAD_IN + more < MARGIN_IN:
        return columns
    return left, [*right[:-1], right[-1] + more], inner - more / count


def write_words(drawn, titles, columns):
    """Writes titles and wraps the labels below the panels. A title may be wider than its panel, up to the next
    panel."""
    left, right, inner = columns
    for ((_, column), axes, panel), title in zip(drawn, titles):
        gap_in = right[column] + (left[column + 1] if column + 1 < len(left) else PAD_IN) - 2 * PAD_IN
        add_words(axes, panel, title, inner, inner + gap_in)


def composed(figure, width_in, with_heading, with_keys=True):
    """Returns the canvas with everything in its place, and the result of arrange(). with_keys: legends and colour bars."""
    cells = places(figure.panels)
    size = tuple(1 + max(cell[i] for cell in cells) for i in (0, 1))
    canvas = matplotlib.figure.Figure(figsize=(width_in, 1.8 * size[0]), dpi=PNG_DPI)
    FigureCanvasAgg(canvas)
    drawn = draw_panels(figure, canvas, cells, size, with_keys)
    say_once(drawn)
    guess(canvas, drawn, size)
    letters = [letter_of(cells, i) for i in range(len(cells))]
    titles = [title_words(title_of(panel, letter), letter) for panel, letter in zip(figure.panels, letters)]
    columns = with_room_for_titles(columns_in(canvas, drawn, size[1]), drawn, titles)
    write_words(drawn, titles, columns)
    heading = wrapped(figure.heading, width_in - 2 * PAD_IN, HEADING) if with_heading else ""
    top_in = PAD_IN + (HEADING_LINE_IN * (1 + heading.count("\n")) + PAD_IN if heading else 0)
    panels = [(cell, axes, room_above_in(panel)) for cell, axes, panel in drawn]
    if with_keys:
        top_in += add_legends(canvas, panels, columns[2], top_in, PAD_IN)
    smaller = arrange(canvas, drawn, size, columns, top_in)
    canvas.suptitle(heading, x=PAD_IN / width_in, y=1 - PAD_IN / canvas.get_figheight(), ha="left", va="top")
    align(drawn)
    return canvas, smaller


def draw_small(figure, file):
    """Draws one panel so small that its letters can be read in a gallery: the first that is a picture, else the first."""
    matplotlib.rcParams.update(RC)
    shown = in_shown_units(figure)
    pictures = [panel for panel in shown.panels if panel.scene or is_image(panel) or has_cells(panel)]
    plots = [panel for panel in shown.panels if not is_surface(panel)]
    chosen = [*pictures, *plots, *shown.panels][0]
    alone = dataclasses.replace(shown, panels=[dataclasses.replace(chosen, title="", place=(2, 0))])  # as low as one of three
    save(composed(alone, SMALL_IN, False, with_keys=False)[0], file, figure)


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

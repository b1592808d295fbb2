"""Puts the panels of a figure on one canvas and saves it as a PNG."""
import math
import textwrap

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

from plotting.drawing import curve_key, draw_panel, has_cells, is_image, legend_below
from plotting.scene import draw_scene

WIDTH_IN, HEIGHT_IN, DPI = 9.0, 6.0, 130
COLOURS = ["#1f4e79", "#c8501e", "#2f7d4f", "#8a4f9e", "#b08900", "#555555", "#2f93b5", "#a3224a"]
RC = {
    "font.size": 11, "axes.titlesize": 12, "axes.labelsize": 11, "legend.fontsize": 10,
    "figure.titlesize": 14, "axes.spines.top": False, "axes.spines.right": False,
    "axes.edgecolor": "#666666", "axes.grid": True, "axes.axisbelow": True,
    "grid.color": "#e3e3e3", "grid.linewidth": 0.8, "legend.frameon": False,
    "agg.path.chunksize": 20000,  # without it a long dense line can overflow the rasteriser
}


def colours(panels):
    """A label has one colour in all panels."""
    keys = dict.fromkeys(curve_key(curve, i) for panel in panels for i, curve in enumerate(panel.curves))
    return {key: COLOURS[i % len(COLOURS)] for i, key in enumerate(keys)}


def has_range(panel):
    return not all(math.isnan(limit) for limit in panel.x_range + panel.y_range)


def set_equal_aspect(axes, panel):
    """One metre as long across as up. Ranges that the file gives stay; automatic ones may grow to fill the panel."""
    axes.set_aspect("equal", adjustable="box" if has_range(panel) else "datalim", anchor="W")


def legend_height(axes):
    """In inches."""
    legend = axes.get_legend()
    return legend.get_window_extent().height / axes.figure.dpi if legend else 0


def canvas_width(columns):
    return WIDTH_IN if columns == 1 else 1.5 * WIDTH_IN


def row_height(row, columns, rows):
    """Inches for the panels of one row: what equal aspect asks for, else a share of the page."""
    share = max(HEIGHT_IN / rows, 2.3)
    heights = []
    for axes, panel in row:
        height = max(share, 3.8) if has_cells(panel) else share
        if panel.scene:
            height = 0.95 * canvas_width(columns) / columns * panel.scene.proportion + 0.6
        (x0, x1), (y0, y1) = axes.get_xlim(), axes.get_ylim()
        if is_image(panel):
            height = 0.95 * canvas_width(columns) / columns * abs(y1 - y0) / abs(x1 - x0) + 0.6
        elif panel.equal_aspect:
            across = 0.7 * WIDTH_IN / columns
            asked = across * abs(y1 - y0) / abs(x1 - x0) + 0.9
            height = min(max(asked, 1.8 if has_range(panel) else share), HEIGHT_IN)
        heights.append(height + (legend_height(axes) if legend_below(panel) else 0))
    return max(heights, default=share)


def places(panels):
    """Row and column of each panel: as the file says where it says so for all, else one below the other."""
    given = [panel.place for panel in panels]
    if None in given or len(set(given)) < len(given):
        return [(row, 0) for row in range(len(panels))]
    return given


def align(canvas, drawn):
    """Equal aspect may narrow a panel. Those below it with the same x_range follow, so that x stays above x."""
    canvas.draw_without_rendering()  # lays the panels out
    canvas.set_layout_engine("none")
    for (_, column), narrowed, panel in drawn:
        if not (panel.equal_aspect and has_range(panel)):
            continue
        x, width = narrowed.get_position().x0, narrowed.get_position().width
        for (_, other_column), axes, other in drawn:
            if other_column == column and other.x_range == panel.x_range and not other.equal_aspect:
                box = axes.get_position()
                axes.set_position([x, box.y0, width, box.height])


def draw_figure(figure, png):
    plt.rcParams.update(RC)
    cells = places(figure.panels)
    rows, columns = (1 + max(cell[i] for cell in cells) for i in (0, 1))
    canvas = plt.figure(layout="constrained")
    canvas.get_layout_engine().set(w_pad=0.1, h_pad=0.1)
    grid = canvas.add_gridspec(rows, columns)
    of_label = colours(figure.panels)
    drawn = []
    for panel, cell in zip(figure.panels, cells):
        axes = canvas.add_subplot(grid[cell])
        if panel.scene:
            draw_scene(axes, panel, columns)
        else:
            draw_panel(axes, panel, of_label)
        drawn.append((cell, axes, panel))
    heights = [row_height([(a, p) for cell, a, p in drawn if cell[0] == row], columns, rows)
               for row in range(rows)]
    for _, axes, panel in drawn:
        if panel.equal_aspect:
            set_equal_aspect(axes, panel)
    grid.set_height_ratios(heights)
    canvas.set_size_inches(canvas_width(columns), sum(heights) + 0.5)
    canvas.suptitle(textwrap.fill(figure.heading, 80 if columns == 1 else 120))
    align(canvas, drawn)
    canvas.savefig(png, dpi=DPI, metadata={"Software": None})  # equal results are equal files
    plt.close(canvas)

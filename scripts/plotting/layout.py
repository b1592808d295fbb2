"""Puts the panels of a figure on one canvas and saves it as a PNG."""
import math
import textwrap

import matplotlib
import matplotlib.figure
import PIL.Image
from matplotlib.backends.backend_agg import FigureCanvasAgg

from plotting.drawing import curve_key, draw_panel, has_cells, is_image, legend_below
from plotting.scene import draw_scene
from plotting.surface import add_title, is_surface

WIDTH_IN, HEIGHT_IN, PAD_IN, DPI = 9.0, 6.0, 0.1, 130
LETTER_IN = 0.095  # mean width of a letter of a panel's title
OWN_COLOURS = ("surface", "letters")  # styles that take no colour of the list
COLOURS = ["#1f4e79", "#c8501e", "#2f7d4f", "#8a4f9e", "#b08900", "#555555", "#2f93b5", "#a3224a"]
RC = {
    "font.size": 11, "axes.titlesize": 12, "axes.labelsize": 11, "legend.fontsize": 10,
    "figure.titlesize": 14, "axes.spines.top": False, "axes.spines.right": False,
    "axes.edgecolor": "#666666", "axes.grid": True, "axes.axisbelow": True,
    "grid.color": "#e3e3e3", "grid.linewidth": 0.8, "legend.frameon": False,
    "text.parse_math": False,  # a dollar sign in a name is no formula
    "agg.path.chunksize": 20000,  # without it a long dense line can overflow the rasteriser
}


def colours(panels):
    """A label has one colour in all panels."""
    keys = dict.fromkeys(curve_key(curve, i) for panel in panels for i, curve in enumerate(panel.curves)
                         if curve.style not in OWN_COLOURS)
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


def title_width(columns):
    """Letters of a panel's title that fit over the panel, beside its labels."""
    return 80 if columns == 1 else int((canvas_width(columns) / columns - 0.8) / LETTER_IN)


def row_height(row, columns, rows):
    """Inches for the panels of one row: what equal aspect asks for, else a share of the page."""
    share = max(HEIGHT_IN / rows, 2.3)
    heights = []
    for axes, panel in row:
        height = max(share, 3.8) if has_cells(panel) else share
        if panel.scene:
            height = 0.95 * canvas_width(columns) / columns * panel.scene.proportion + 0.6
        elif is_surface(panel):
            height = 0.4 * canvas_width(columns) / columns
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


def guess(canvas, drawn, rows, columns):
    """Places for the panels before anything is known about their labels."""
    width, height = canvas.get_size_inches()
    for (row, column), axes, _ in drawn:
        across, up = 1 / columns, 1 / rows
        axes.set_position([column * across + 0.8 / width, 1 - (row + 1) * up + 0.6 / height,
                           across - 1.0 / width, max(up - 1.0 / height, 0.3 * up)])


def margins(canvas, axes):
    """What labels and legend need left, right, below and above, in inches. A view in perspective has its labels inside
    its panel, and only the title above it."""
    if axes.name == "3d":
        return [PAD_IN, PAD_IN, PAD_IN, PAD_IN + 0.25]
    outer = axes.get_tightbbox(canvas.canvas.get_renderer(), for_layout_only=True)
    inner = axes.get_position().transformed(canvas.transFigure)
    return [max(0.0, size) / canvas.dpi + PAD_IN
            for size in (inner.x0 - outer.x0, outer.x1 - inner.x1, inner.y0 - outer.y0, outer.y1 - inner.y1)]


def arrange(canvas, drawn, heights, columns, top_in):
    """Panels of a column are equally wide, rows as high as asked for, and nothing runs into anything. (Constrained
    layout measures everything twice, which takes half of the time of a figure.)"""
    width, height = canvas.get_size_inches()
    guess(canvas, drawn, len(heights), columns)
    needs = [(cell, margins(canvas, axes)) for cell, axes, _ in drawn]
    left, right = ([max((need[side] for cell, need in needs if cell[1] == column), default=PAD_IN)
                    for column in range(columns)] for side in (0, 1))
    below, above = ([max((need[side] for cell, need in needs if cell[0] == row), default=PAD_IN)
                     for row in range(len(heights))] for side in (2, 3))
    inner_width = (width - sum(left) - sum(right)) / columns
    scale = (height - top_in - sum(below) - sum(above)) / sum(heights)
    for (row, column), axes, _ in drawn:
        x = sum(left[:column + 1]) + sum(right[:column]) + column * inner_width
        y = height - top_in - sum(above[:row + 1]) - sum(below[:row]) - scale * sum(heights[:row + 1])
        axes.set_position([x / width, y / height, inner_width / width, scale * heights[row] / height])


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


def save(canvas, png):
    """Drawn once, where Figure.savefig() draws twice. Nothing but pixels is saved: equal results are equal files."""
    surface = canvas.canvas
    surface.draw()
    pixels = PIL.Image.frombuffer("RGBA", surface.get_width_height(), surface.buffer_rgba(), "raw", "RGBA", 0, 1)
    pixels.convert("RGB").save(png, compress_level=4)


def draw_figure(figure, png, titled):
    """titled: with its heading, which a page shows above it."""
    matplotlib.rcParams.update(RC)
    cells = places(figure.panels)
    rows, columns = (1 + max(cell[i] for cell in cells) for i in (0, 1))
    canvas = matplotlib.figure.Figure(dpi=DPI)
    FigureCanvasAgg(canvas)
    of_label = colours(figure.panels)
    drawn = []
    for i, (panel, cell) in enumerate(zip(figure.panels, cells)):
        projection = "3d" if is_surface(panel) else None
        axes = canvas.add_axes([0, 0, 1, 1], label=str(i), projection=projection)
        if panel.scene:
            draw_scene(axes, panel, columns)
        else:
            draw_panel(axes, panel, of_label, title_width(columns))
        drawn.append((cell, axes, panel))
    heights = [row_height([(a, p) for cell, a, p in drawn if cell[0] == row], columns, rows)
               for row in range(rows)]
    for _, axes, panel in drawn:
        if panel.equal_aspect:
            set_equal_aspect(axes, panel)
    heading = textwrap.fill(figure.heading, 80 if columns == 1 else 120) if titled else ""
    top_in = PAD_IN + 0.25 * (1 + heading.count("\n")) if heading else 0
    canvas.set_size_inches(canvas_width(columns), sum(heights) + 0.25 + top_in)
    canvas.suptitle(heading, y=1 - PAD_IN / canvas.get_figheight(), va="top")
    arrange(canvas, drawn, heights, columns, top_in)
    align(drawn)
    save(canvas, png)

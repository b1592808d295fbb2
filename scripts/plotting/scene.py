"""Draws a panel that is a picture of things in space, with plotting.raster."""
import math

import matplotlib
import matplotlib.cm
import matplotlib.colors
import matplotlib.lines
import matplotlib.patches
import matplotlib.patheffects
import numpy as np
from matplotlib.colors import to_hex

from .cells import colour_range
from .raster import Camera, Canvas
from .style import COLOURS, OF_LABEL, PNG_DPI, meaning
from .typeset import typeset
from .units import shown_column

FINER = 2  # pixels are drawn so much finer, then averaged
LARGEST_PX = 1100  # a picture of one column has 1050: 300 dpi
BAR_SHARE = 0.25  # the largest share of the width of a picture that its scale bar takes
EDGE = [matplotlib.patheffects.withStroke(linewidth=2.4, foreground="white")]


def rgb(colour):
    """0xRRGGBB, one or many, as numbers from 0 to 1."""
    colour = np.asarray(colour).astype(np.int64)
    return np.stack([colour >> 16 & 255, colour >> 8 & 255, colour & 255], axis=-1) / 255


def turned(points, pose):
    """By the unit quaternion pose[3:], then moved by pose[:3]."""
    w, axis = pose[3], pose[4:]
    return points + 2 * np.cross(axis, np.cross(axis, points) + w * points) + pose[:3]


def colour_of(part):
    """What has a meaning has its colour, whatever the file says."""
    name = meaning(part.label, OF_LABEL) if part.label else None
    return np.array(matplotlib.colors.to_rgb(COLOURS[name])) if name else rgb(part.colour)


def colour_scale(column):
    """Returns the colours of the values of a column, for a colour bar."""
    return matplotlib.cm.ScalarMappable(matplotlib.colors.Normalize(*colour_range(column)), "viridis")


def colours_of_points(part, count):
    if part.coloured_by:
        column = shown_column(part.coloured_by)
        return colour_scale(column).to_rgba(column.values)[:, :3]
    return rgb(part.table["colour"]) if "colour" in part.table else np.tile(colour_of(part), (count, 1))


def draw_part(canvas, part):
    x = part.columns("x", "y", "z")
    if part.kind == "segments":
        canvas.segments(x, part.columns("x_end", "y_end", "z_end"), colour_of(part))
    elif part.kind == "solid":
        canvas.mesh(turned(x, part.pose), part.triangles, colour_of(part), part.opacity)
    else:
        own = colours_of_points(part, len(x))
        normals = part.columns("nx", "ny", "nz") if "nx" in part.table else None
        canvas.points(x, own, part.size, normals)


def picture(scene, width):
    """As an array of pixels. Transparent things are drawn last."""
    size = (FINER * width, FINER * round(width * scene.proportion))
    canvas = Canvas(Camera(scene.eye, scene.target, scene.up, scene.width), size)
    for part in sorted(scene.parts, key=lambda part: part.opacity < 1):
        draw_part(canvas, part)
    return canvas.image(FINER)


def add_scale_bar(axes, scene):
    """Adds a bar whose length is true at the distance of the target. Nearer things appear larger."""
    longest = BAR_SHARE * scene.width
    decade = 10.0 ** math.floor(math.log10(longest))
    length = next(factor * decade for factor in (5, 2, 1) if factor * decade <= longest * (1 + 1e-9))
    x, y = 1 - 0.03 - length / scene.width, 0.035
    bar, = axes.plot([x, 0.97], [y, y], color="black", linewidth=1.6, solid_capstyle="butt", transform=axes.transAxes,
                     path_effects=EDGE)
    words = axes.annotate(f"{1000 * length:g} mm", (x + length / scene.width / 2, y), xycoords="axes fraction",
                          xytext=(0, 2.5), textcoords="offset points", ha="center", va="bottom", path_effects=EDGE)
    bar.set_in_layout(False), words.set_in_layout(False)


def handle(part):
    """Returns an entry of the legend: a dot for points, a line for segments, an area for a solid. Points of several
    colours are shown in their median colour."""
    colour, label = colour_of(part), typeset(part.label)
    if part.kind == "points":
        own = colours_of_points(part, 1)
        median = np.median(own, axis=0) if len(own) else colour
        return matplotlib.lines.Line2D([], [], linestyle="none", marker="o", color=to_hex(median), label=label)
    if part.kind == "segments":
        return matplotlib.lines.Line2D([], [], color=to_hex(colour), label=label)
    return matplotlib.patches.Rectangle((0, 0), 0, 0, facecolor=colour, alpha=part.opacity, label=label)


def draw_scene(axes, panel, width_in, add_colour_bar):
    """Draws the picture; the names of its parts become entries of a legend. add_colour_bar: of plotting.drawing."""
    pixels = picture(panel.scene, min(LARGEST_PX, int(PNG_DPI * width_in)))
    axes.imshow(pixels, interpolation="antialiased", extent=(0, 1, 0, panel.scene.proportion))
    axes.set_anchor("SW")
    axes.set_xticks([]), axes.set_yticks([])
    axes.spines[:].set_visible(False)
    axes.grid(False)
    add_scale_bar(axes, panel.scene)
    for part in panel.scene.parts:
        if part.label and not part.coloured_by:
            entry = handle(part)
            axes.add_line(entry) if part.kind != "solid" else axes.add_patch(entry)
        if part.coloured_by:
            column = shown_column(part.coloured_by)
            add_colour_bar(axes, colour_scale(column), column, width_in)

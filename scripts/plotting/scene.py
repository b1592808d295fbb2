"""Draws a panel that is a picture of things in space, with plotting.raster."""
import matplotlib.colors
import matplotlib.patches
import numpy as np

from plotting.raster import Camera, Canvas
from plotting.style import BOLD_IN, COLOURS, OF_LABEL, PNG_DPI, meaning
from plotting.typeset import typeset, wrapped

FINER = 2  # pixels are drawn so much finer, then averaged
LARGEST_PX = 800


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


def draw_part(canvas, part):
    x = part.columns("x", "y", "z")
    if part.kind == "segments":
        canvas.segments(x, part.columns("x_end", "y_end", "z_end"), colour_of(part))
    elif part.kind == "solid":
        canvas.mesh(turned(x, part.pose), part.triangles, colour_of(part), part.opacity)
    else:
        own = rgb(part.table["colour"]) if "colour" in part.table else np.tile(colour_of(part), (len(x), 1))
        normals = part.columns("nx", "ny", "nz") if "nx" in part.table else None
        canvas.points(x, own, part.size, normals)


def picture(scene, width):
    """As an array of pixels. Transparent things are drawn last."""
    size = (FINER * width, FINER * round(width * scene.proportion))
    canvas = Canvas(Camera(scene.eye, scene.target, scene.up, scene.width), size)
    for part in sorted(scene.parts, key=lambda part: part.opacity < 1):
        draw_part(canvas, part)
    return canvas.image(FINER)


def draw_scene(axes, panel, width_in):
    """With the names of its parts as entries of a legend."""
    axes.imshow(picture(panel.scene, min(LARGEST_PX, int(PNG_DPI * width_in))), interpolation="antialiased")
    axes.set_anchor("SW")
    axes.set_xticks([]), axes.set_yticks([])
    axes.spines[:].set_visible(False)
    axes.grid(False)
    axes.set_title(wrapped(panel.title, int(width_in / BOLD_IN)), loc="left")
    for part in panel.scene.parts:
        if part.label:
            axes.add_patch(matplotlib.patches.Rectangle((0, 0), 0, 0, facecolor=colour_of(part), alpha=part.opacity,
                                                        label=typeset(part.label)))

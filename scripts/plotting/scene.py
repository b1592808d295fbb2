"""Draws a panel that is a picture of things in space, with plotting.raster."""
import matplotlib.patches
import numpy as np

from plotting.raster import Camera, Canvas

FINER = 2  # pixels are drawn so much finer, then averaged
LARGEST_PX = 700


def rgb(colour):
    """0xRRGGBB, one or many, as numbers from 0 to 1."""
    colour = np.asarray(colour).astype(np.int64)
    return np.stack([colour >> 16 & 255, colour >> 8 & 255, colour & 255], axis=-1) / 255


def turned(points, pose):
    """By the unit quaternion pose[3:], then moved by pose[:3]."""
    w, axis = pose[3], pose[4:]
    return points + 2 * np.cross(axis, np.cross(axis, points) + w * points) + pose[:3]


def draw_part(canvas, part):
    x = part.columns("x", "y", "z")
    if part.kind == "segments":
        canvas.segments(x, part.columns("x_end", "y_end", "z_end"), rgb(part.colour))
    elif part.kind == "solid":
        canvas.mesh(turned(x, part.pose), part.triangles, rgb(part.colour), part.opacity)
    else:
        own = rgb(part.table["colour"]) if "colour" in part.table else np.tile(rgb(part.colour), (len(x), 1))
        normals = part.columns("nx", "ny", "nz") if "nx" in part.table else None
        canvas.points(x, own, part.size, normals)


def picture(scene, width):
    """As an array of pixels. Transparent things are drawn last."""
    size = (FINER * width, FINER * round(width * scene.proportion))
    canvas = Canvas(Camera(scene.eye, scene.target, scene.up, scene.width), size)
    for part in sorted(scene.parts, key=lambda part: part.opacity < 1):
        draw_part(canvas, part)
    return canvas.image(FINER)


def draw_scene(axes, panel, columns):
    """columns: of panels side by side; fewer are larger."""
    axes.imshow(picture(panel.scene, min(LARGEST_PX, 1200 // columns)), interpolation="antialiased")
    axes.set_xticks([]), axes.set_yticks([])
    axes.spines[:].set_visible(False)
    axes.grid(False)
    axes.set_title(panel.title, loc="left")
    entries = [matplotlib.patches.Patch(facecolor=rgb(part.colour), alpha=part.opacity, label=part.label)
               for part in panel.scene.parts if part.label]
    if entries:  # below: inside it would cover something
        axes.legend(handles=entries, loc="upper left", bbox_to_anchor=(0, 0), ncol=len(entries), borderaxespad=0.2)

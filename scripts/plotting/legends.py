"""Legends stand above the panels, so they cover no curve. What several panels have in common is said once, above all."""
import math

from matplotlib.colors import to_hex
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.transforms import ScaledTranslation

from plotting.style import DASHES, TEXT_PT
from plotting.wrapping import folded

GAP_IN = 0.05  # between a legend and what is below it
MARKER_IN = 0.45  # what an entry needs beside its words
LINE_IN = 0.14  # height of a line of a legend
LARGEST_SHARE = 0.15  # of a picture's area, that legends may take


def entries(axes):
    """Handles by label; the two edges of an interval have one label."""
    if axes.name == "3d":
        return {}
    handles, labels = axes.get_legend_handles_labels()
    found = dict(zip(reversed(labels), reversed(handles)))
    return {label: found[label] for label in dict.fromkeys(labels)}


def is_area(handle):
    return isinstance(handle, Patch)


def appearance(handle):
    """Its colour, and a line style and a marker, empty where it has none."""
    if isinstance(handle, Line2D):
        line, marker = handle.get_linestyle(), str(handle.get_marker())
        return to_hex(handle.get_color()), line.replace("None", ""), marker.replace("None", "")
    colour = handle.get_facecolor() if hasattr(handle, "get_facecolor") else type(handle).__name__
    return to_hex(colour) if is_area(handle) else str(colour), "", ""


def has_entry(shared, label, handle):
    """Whether the entry says what the handle shows. A line with markers says it for lines without and for dots, and a line
    for a thing in a picture that has its colour."""
    if label not in shared:
        return False
    (known, *styles), (own, *others) = appearance(shared[label]), appearance(handle)
    equal = styles == others or any(one and one == other for one, other in zip(styles, others))
    return known == own and (equal or is_area(handle))


def not_in(shared, one):
    """The entries of a panel without those that are shared."""
    return {label: handle for label, handle in one.items() if not has_entry(shared, label, handle)}


def shared_entries(every, has_columns):
    """What is said once above all panels: entries that two panels have with the same look. Without columns of panels, only
    if two panels have no other entries: else the first panel that has an entry says it for those below."""
    common = {}
    for label in dict.fromkeys(label for one in every for label in one):
        handles = sorted((one[label] for one in every if label in one), key=lambda handle: appearance(handle).count(""))
        if sum(has_entry({label: handles[0]}, label, handle) for handle in handles) > 1:
            common[label] = handles[0]
    alike = [one for one in every if one and not not_in(common, one)]
    if has_columns:
        return common
    return {label: common[label] for one in alike for label in one} if len(alike) > 1 else {}


def own_entries(every, shared):
    """Of each panel, what neither the shared legend nor a panel before it says."""
    own, said = [], dict(shared)
    for one in every:
        own.append(not_in(said, one))
        said |= {label: handle for label, handle in own[-1].items() if label not in said}
    return own


def by_rows(items, columns):
    """The order in which a legend, which is filled column by column, has the items row by row."""
    return [items[i] for column in range(columns) for i in range(column, len(items), columns)]


def fitted(owner, found, width_in, **options):
    """A legend of as many columns as fit, all about equally full. Of two rows, the upper one is filled first, so the lower
    one may be incomplete."""
    is_short = all(isinstance(handle, Line2D) and handle.get_linestyle() == "None" for handle in found.values())
    options |= {"handlelength": 1.2} if is_short else {}
    items = [(folded(label, width_in - MARKER_IN), handle) for label, handle in found.items()]
    renderer = owner.figure.canvas.get_renderer() if owner.figure else owner.canvas.get_renderer()
    for columns in range(len(items), 0, -1):
        columns = math.ceil(len(items) / math.ceil(len(items) / columns))
        ordered = by_rows(items, columns) if len(items) < 2 * columns else items
        labels, handles = zip(*ordered)
        legend = owner.legend(handles, labels, ncol=columns, borderaxespad=0, **options)
        if columns == 1 or legend.get_window_extent(renderer).width <= width_in * 72 * renderer.points_to_pixels(1):
            break
        legend.remove()
    for line, handle in zip(legend.get_lines(), (handle for handle in handles if isinstance(handle, Line2D))):
        line.set_markersize(max(3, line.get_markersize()))  # small dots are hard to tell apart there
        whole_dashes(line, handle)
    return legend


def whole_dashes(line, handle):
    """A handle begins with a whole dash, wherever that of the curve begins."""
    if dash := getattr(handle, "dash", 0):
        line.set_linestyle(DASHES[dash])


def height_in(legend):
    return legend.get_window_extent(legend.figure.canvas.get_renderer()).height / legend.figure.dpi


def add_panel_legend(axes, found, width_in, above_in):
    """Between the panel and its title, which moves up. Returns its height. above_in: room for what stands directly above
    the panel."""
    above = ScaledTranslation(0, GAP_IN + above_in, axes.figure.dpi_scale_trans)
    return height_in(fitted(axes, found, width_in, loc="lower left", bbox_to_anchor=(0, 1),
                            bbox_transform=axes.transAxes + above))


def tallest(heights, cells):
    """Index of the panel whose legend is a line or more higher than another of its row, which it would leave empty there;
    None: there is no such panel."""
    low = {row: min(height for height, cell in zip(heights, cells) if cell[0] == row) for row, _ in cells}
    above = [height - low[cell[0]] for height, cell in zip(heights, cells)]
    return above.index(max(above)) if max(above) > 0.9 * LINE_IN else None


def add_panel_legends(panels, shared, width_in):
    """Each panel's own entries above it; those of a legend that is taller than others of its row are added to `shared`."""
    own = own_entries([entries(axes) for _, axes, _ in panels], shared)
    heights = [add_panel_legend(axes, one, width_in, above_in) if one else 0.0
               for one, (_, axes, above_in) in zip(own, panels)]
    while (i := tallest(heights, [cell for cell, _, _ in panels])) is not None:
        left = {label: handle for label, handle in own[i].items() if label in shared}  # with another look
        if len(left) == len(own[i]):
            break
        shared |= {label: handle for label, handle in own[i].items() if label not in left}
        own[i] = left
        panels[i][1].get_legend().remove()
        heights[i] = add_panel_legend(panels[i][1], left, width_in, panels[i][2]) if left else 0.0
    for (_, axes, above_in), height in zip(panels, heights):
        if height or above_in:
            gap_in = GAP_IN if height else 0
            axes.set_title(axes.get_title(loc="left"), loc="left", pad=72 * (height + gap_in + above_in) + TEXT_PT / 2)


def add_legends(canvas, panels, width_in, top_in, pad_in):
    """The legends of all panels; returns the height of the one above them all. panels: cell, axes, and what stands directly
    above the axes, in inches. width_in: of a panel."""
    shared = shared_entries([entries(axes) for _, axes, _ in panels], any(cell[1] for cell, _, _ in panels))
    add_panel_legends(panels, shared, width_in)
    if not shared:
        return 0.0
    place = canvas.transFigure + ScaledTranslation(pad_in, -top_in, canvas.dpi_scale_trans)
    legend = fitted(canvas, shared, canvas.get_figwidth() - 2 * pad_in, loc="upper left", bbox_to_anchor=(0, 1),
                    bbox_transform=place)
    return height_in(legend) + 2 * GAP_IN


def legends(canvas):
    return canvas.legends + [axes.get_legend() for axes in canvas.axes if axes.get_legend()]


def share(canvas):
    """Of the picture's area, that legends take."""
    boxes = [legend.get_window_extent(canvas.canvas.get_renderer()) for legend in legends(canvas)]
    return sum(box.width * box.height for box in boxes) / (canvas.bbox.width * canvas.bbox.height)

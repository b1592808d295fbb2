"""Legends stand above the panels, so they cover no curve. Entries that several panels have are written once, above
all."""
import itertools
import math

from matplotlib.colors import to_hex
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.transforms import ScaledTranslation

from .style import DASHES, TEXT_PT
from .wrapping import folded, text_width_in

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
    """Returns the colour, the line style and the marker of a handle; empty where it has none."""
    if isinstance(handle, Line2D):
        line, marker = handle.get_linestyle(), str(handle.get_marker())
        return to_hex(handle.get_color()), line.replace("None", ""), marker.replace("None", "")
    colour = handle.get_facecolor() if hasattr(handle, "get_facecolor") else type(handle).__name__
    return to_hex(colour) if is_area(handle) else str(colour), "", ""


def has_entry(shared, label, handle):
    """Returns whether the shared entry explains the handle too. A line with markers also explains lines without markers
    and dots, and any entry explains a solid of its colour."""
    if label not in shared:
        return False
    (known, *styles), (own, *others) = appearance(shared[label]), appearance(handle)
    equal = styles == others or any(one and one == other for one, other in zip(styles, others))
    return known == own and (equal or is_area(handle))


def not_in(shared, one):
    """Returns the entries of a panel without those that are shared."""
    return {label: handle for label, handle in one.items() if not has_entry(shared, label, handle)}


def shared_entries(every, has_columns):
    """Returns the entries above all panels: those that two panels have with the same look. If the panels are in one
    column, these are shared only if two panels have no other entries; else only the first panel has a repeated
    entry."""
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
    """Returns the entries of each panel that neither the shared legend nor an earlier panel has."""
    own, said = [], dict(shared)
    for one in every:
        own.append(not_in(said, one))
        said |= {label: handle for label, handle in own[-1].items() if label not in said}
    return own


def by_rows(items, columns):
    """Returns the items in the order in which a legend, which is filled column by column, shows them row by row."""
    return [items[i] for column in range(columns) for i in range(column, len(items), columns)]


def width_of_columns(labels, columns):
    """Returns the sum of the widths of the widest labels."""
    rows = math.ceil(len(labels) / columns)
    short = columns * rows - len(labels)  # the number of columns that have one label less
    starts = [k * rows - max(0, k - (columns - short)) for k in range(columns + 1)]
    lines = [label.split("\n") for label in labels]
    return sum(max(text_width_in(line) for label in lines[a:b] for line in label) for a, b in zip(starts, starts[1:]))


def in_order(labels, columns):
    """Returns the labels in the order of the columns. Each group, such as `look-ahead, 1 mm` to `look-ahead, 3 mm`,
    gets a row or a column. Without groups the upper of two rows is filled first, unless that is wider."""
    rows, across = math.ceil(len(labels) / columns), by_rows(labels, columns)
    groups = {len(list(group)) for _, group in itertools.groupby(label.split(", ")[0] for label in labels)}
    if len(groups) == 1 and groups <= {rows, columns} - {1}:
        return labels if groups == {rows} else across
    is_narrow = width_of_columns(across, columns) < width_of_columns(labels, columns) + 0.1
    return across if rows == 2 and len(labels) < 2 * columns and is_narrow else labels


def fitted(owner, found, width_in, **options):
    """A legend of as many columns as fit, all about equally full."""
    is_short = all(isinstance(handle, Line2D) and handle.get_linestyle() == "None" for handle in found.values())
    options |= {"handlelength": 1.2} if is_short else {}
    items = {folded(label, width_in - MARKER_IN): handle for label, handle in found.items()}
    renderer = owner.figure.canvas.get_renderer() if owner.figure else owner.canvas.get_renderer()
    for columns in range(len(items), 0, -1):
        columns = math.ceil(len(items) / math.ceil(len(items) / columns))
        labels = in_order(list(items), columns)
        handles = [items[label] for label in labels]
        legend = owner.legend(handles, labels, ncol=columns, borderaxespad=0, **options)
        if columns == 1 or legend.get_window_extent(renderer).width <= width_in * 72 * renderer.points_to_pixels(1):
            break
        legend.remove()
    for line, handle in zip(legend.get_lines(), (handle for handle in handles if isinstance(handle, Line2D))):
        line.set_markersize(max(3, line.get_markersize()))  # small dots are hard to tell apart there
        whole_dashes(line, handle)
    return legend


def whole_dashes(line, handle):
    """Lets the handle begin with a whole dash, even if the curve begins within one."""
    if dash := getattr(handle, "dash", 0):
        line.set_linestyle(DASHES[dash])


def height_in(legend):
    return legend.get_window_extent(legend.figure.canvas.get_renderer()).height / legend.figure.dpi


def add_panel_legend(axes, found, width_in, above_in):
    """Adds a legend between the panel and its title. Returns its height. above_in: height of what stands directly above
    the panel."""
    above = ScaledTranslation(0, GAP_IN + above_in, axes.figure.dpi_scale_trans)
    return height_in(fitted(axes, found, width_in, loc="lower left", bbox_to_anchor=(0, 1),
                            bbox_transform=axes.transAxes + above))


def tallest(heights, cells):
    """Returns the index of the panel whose legend would leave an empty band above another panel of its row, because it
    is higher by three lines, or by one if the other panel has no legend. None: there is no such panel."""
    low = {row: min(height for height, cell in zip(heights, cells) if cell[0] == row) for row, _ in cells}
    lines = [(height - low[cell[0]]) / LINE_IN - (2 if low[cell[0]] else 0) for height, cell in zip(heights, cells)]
    return lines.index(max(lines)) if max(lines) > 0.9 else None


def add_panel_legends(panels, shared, width_in):
    """Adds the legend of each panel. Entries of a legend that is too tall for its row are added to `shared` instead."""
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
    """Adds all legends. Returns the height of the one above all panels. panels: cell, axes, and the height of what
    stands directly above the axes. width_in: of a panel."""
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

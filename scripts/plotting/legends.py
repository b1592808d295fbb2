"""Legends stand above the panels, so they cover no curve. What several panels have in common is said once, above all."""
import math
import re
import textwrap

from matplotlib.transforms import ScaledTranslation

from plotting.style import LETTER_IN, TEXT_PT

GAP_IN = 0.05  # between a legend and what is below it
MARKER_IN = 0.45  # what an entry needs beside its words
LARGEST_SHARE = 0.15  # of a picture's area, that legends may take


def entries(axes):
    """Handles by label; the two edges of an interval have one label."""
    handles, labels = axes.get_legend_handles_labels()
    found = dict(zip(reversed(labels), reversed(handles)))
    return {label: found[label] for label in dict.fromkeys(labels)}


def shared_entries(every):
    """What is said once: the entries of two panels or more that have nothing of their own to say."""
    common = {label for one in every for label in one if sum(label in other for other in every) > 1}
    alike = [one for one in every if one and common.issuperset(one)]
    shared = {label: handle for one in reversed(alike) for label, handle in one.items()}
    order = dict.fromkeys(label for one in alike for label in one)
    return {label: shared[label] for label in order} if len(alike) > 1 else {}


def folded(label, letters):
    """In lines of so many letters, each formula counted as one or two."""
    formulas = re.findall(r"(?<!\\)\$.*?(?<!\\)\$", label)
    for formula in formulas:
        label = label.replace(formula, "\ue000\ue001" if "_" in formula else "\ue000", 1)
    label = textwrap.fill(label, max(letters, 12), break_on_hyphens=False)
    for formula in formulas:
        label = re.sub("\ue000\ue001?", lambda _: formula, label, count=1)
    return label


def fitted(owner, found, width_in, **options):
    """A legend of as many columns as fit, all about equally full."""
    letters = int((width_in - MARKER_IN) / LETTER_IN)
    labels = [folded(label, letters) for label in found]
    renderer = owner.figure.canvas.get_renderer() if owner.figure else owner.canvas.get_renderer()
    for columns in range(len(labels), 0, -1):
        columns = math.ceil(len(labels) / math.ceil(len(labels) / columns))
        legend = owner.legend(list(found.values()), labels, ncol=columns, borderaxespad=0, **options)
        if columns == 1 or legend.get_window_extent(renderer).width <= width_in * 72 * renderer.points_to_pixels(1):
            break
        legend.remove()
    for line in legend.get_lines():  # small dots are hard to tell apart there
        line.set_markersize(max(3, line.get_markersize()))
    return legend


def height_in(legend):
    return legend.get_window_extent(legend.figure.canvas.get_renderer()).height / legend.figure.dpi


def add_panel_legend(axes, found, width_in):
    """Between the panel and its title, which moves up."""
    above = ScaledTranslation(0, GAP_IN, axes.figure.dpi_scale_trans)
    legend = fitted(axes, found, width_in, loc="lower left", bbox_to_anchor=(0, 1),
                    bbox_transform=axes.transAxes + above)
    axes.set_title(axes.get_title(loc="left"), loc="left", pad=72 * (height_in(legend) + GAP_IN) + TEXT_PT / 2)


def add_legends(canvas, every, width_in, top_in, pad_in):
    """The legends of all panels; returns the height of the one above them all. width_in: of a panel."""
    found = [entries(axes) if axes.name != "3d" else {} for axes in every]
    shared = shared_entries(found)
    for axes, one in zip(every, found):
        own = {label: one[label] for label in one if label not in shared or not shared.keys() <= one.keys()}
        if not one.keys() <= shared.keys():
            add_panel_legend(axes, own, width_in)
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

"""Draws one panel of a figure: its curves, limits, ticks and legend."""
import math
import re
import textwrap

import matplotlib.collections
import matplotlib.patches
import matplotlib.patheffects
import matplotlib.ticker
import matplotlib.transforms
import numpy as np

from plotting.cells import cell_ends, cell_size, colour_range, distinct, outlines
from plotting.scene import rgb
from plotting.surface import draw_surface, is_surface

NOTHING, NOTHING_COLOUR = "no value", "#d4d4d4"  # where a map or a bar chart has none
CELLS = ("squares", "map")  # the styles that draw cells
HALO = [matplotlib.patheffects.withStroke(linewidth=4, foreground="white")]  # about a line over cells

# Each style draws one curve of the panel it is in.

def alone(curve):
    """The samples whose neighbours have no value: a line through one point would not be seen."""
    seen = np.pad(is_finite(curve), 1)
    return [int(i) for i in np.flatnonzero(seen[1:-1] & ~seen[:-2] & ~seen[2:])]


def draw_line(axes, curve, panel, colour, **options):
    dots = alone(curve)
    if dots:
        options |= {"marker": "o", "markevery": dots}
    width = 1.5 if curve.x.values.size <= 2000 else 1.0  # a noisy trace stays a line
    if has_cells(panel):
        width, options = 2.0, options | {"path_effects": HALO}
    axes.plot(curve.x.values, curve.y.values, color=colour, linewidth=width, label=curve.label, **options)


def draw_dashed(axes, curve, panel, colour):
    draw_line(axes, curve, panel, colour, linestyle=(0, (5, 3)))


def draw_steps(axes, curve, panel, colour):
    draw_line(axes, curve, panel, colour, drawstyle="steps-post")


def draw_dots(axes, curve, panel, colour):
    """The fewer dots are in sight, the larger they are. Few dots of a second series may lie on those of the first:
    they are rings around them, those of a third are wider rings."""
    count = np.count_nonzero(in_sight(curve, panel))
    size = 6 if count <= 30 else 4 if count <= 100 else 2.5 if count <= 300 else 1.5 if count <= 3000 else 1
    series = [other for other in panel.curves if other.style == "dots"].index(curve)
    options = {"markeredgewidth": 0}
    if series > 0 and count <= 100:
        size, options = size + 5 * series, {"markerfacecolor": "none", "markeredgewidth": 1.5}
    axes.plot(curve.x.values, curve.y.values, "o", color=colour, markersize=size, label=curve.label, **options)


def draw_letters(axes, curve, _, __):
    """Dots with the names of z above them."""
    axes.plot(curve.x.values, curve.y.values, "o", color="black", markersize=5, zorder=4)
    for x, y, name in zip(*(column.values[is_finite(curve)] for column in (curve.x, curve.y, curve.z))):
        axes.annotate(curve.z.names[name], (x, y), xytext=(0, 6), textcoords="offset points", ha="center", va="bottom",
                      fontweight="bold", path_effects=HALO)


def draw_circles(axes, curve, _, colour):
    """Circles of a radius in data units; an empty line makes the legend entry."""
    axes.plot([], [], "o", color=colour, markersize=9, markerfacecolor="none", label=curve.label)
    centres = np.column_stack([curve.x.values, curve.y.values])
    centres = centres[np.isfinite(centres).all(axis=1)]
    circles = [matplotlib.patches.Circle(centre, curve.radius) for centre in centres]
    axes.add_collection(matplotlib.collections.PatchCollection(
        circles, facecolor="none", edgecolor=colour, linewidth=1.0))
    axes.autoscale_view()


def draw_bars(axes, curve, panel, colour):
    """The bar charts of one panel stand side by side. A cross stands where there is no value, which is not 0."""
    charts = [other for other in panel.curves if other.style == "bars"]
    places = np.unique(curve.x.values[np.isfinite(curve.x.values)])
    spacing = np.diff(places).min() if places.size > 1 else 1.0
    width = 0.8 * spacing / len(charts)
    offset = (charts.index(curve) - (len(charts) - 1) / 2) * width
    axes.bar(curve.x.values + offset, curve.y.values, width=0.94 * width, color=colour, label=curve.label)
    none = ~np.isfinite(curve.y.values)
    if none.any():
        axes.plot(curve.x.values[none] + offset, np.zeros(none.sum()), "x", color="black", label=NOTHING)


def draw_squares(axes, curve, panel, colour):
    """Filled cells; an empty line makes the legend entry."""
    axes.plot([], [], "s", color=colour, markersize=9, markeredgewidth=0, label=curve.label)
    add_cells(axes, curve, panel, is_finite(curve), facecolor=colour)


def draw_map(axes, curve, panel, _):
    """Cells coloured by z. The colour bar hangs on the panel, so it follows where equal aspect puts that."""
    known = is_finite(curve)
    none = ~known & np.isfinite(curve.x.values) & np.isfinite(curve.y.values)
    if none.any():
        axes.plot([], [], "s", color=NOTHING_COLOUR, markersize=9, markeredgewidth=0, label=NOTHING)
        add_cells(axes, curve, panel, none, facecolor=NOTHING_COLOUR)
    cells = add_cells(axes, curve, panel, known, array=curve.z.values[known], cmap="viridis")
    cells.set_clim(colour_range(curve.z))
    width = 0.03 if panel.place is None else 0.05
    bar = axes.figure.colorbar(cells, cax=axes.inset_axes([1.02, 0, width, 1]))
    bar.outline.set_visible(False)
    bar.set_label(textwrap.fill(with_units("", [curve.z]), 36))
    set_ticks(bar.ax.yaxis, cells.get_clim(), [curve.z])


def draw_band(axes, curve, _, colour):
    axes.fill_between(curve.x.values, curve.y.values, curve.z.values, color=colour, alpha=0.25, linewidth=0,
                      label=curve.label)


def draw_image(axes, curve, _, __):
    """Its pixels as they are, over the places of their centres; the limits of the panel say which way is up."""
    (columns, at_column), (rows, at_row) = (np.unique(values, return_inverse=True)
                                            for values in (curve.x.values, curve.y.values))
    pixels = np.ones((rows.size, columns.size, 3))
    known = is_finite(curve)
    pixels[at_row[known], at_column[known]] = rgb(curve.z.values[known])
    across, up = (cell_size(values, (math.nan, math.nan)) / 2 for values in (columns, rows))
    axes.imshow(pixels, origin="lower", interpolation="nearest",
                extent=(columns[0] - across, columns[-1] + across, rows[0] - up, rows[-1] + up))


DRAW = {"line": draw_line, "dashed": draw_dashed, "steps": draw_steps, "dots": draw_dots,
        "circle": draw_circles, "bars": draw_bars, "squares": draw_squares, "map": draw_map, "band": draw_band,
        "image": draw_image, "letters": draw_letters}


def has_cells(panel):
    return any(curve.style in CELLS for curve in panel.curves)


def add_cells(axes, curve, panel, shown, **options):
    """Without a seam between neighbours. Automatic limits end where the cells end. shown: which of the samples."""
    drawn = outlines(curve, panel, shown)
    cells = matplotlib.collections.PolyCollection(drawn, linewidth=0, antialiased=False, **options)
    if drawn.size:
        corners = drawn.reshape(-1, 2)
        cells.sticky_edges.x[:], cells.sticky_edges.y[:] = np.transpose([corners.min(axis=0), corners.max(axis=0)])
        axes.update_datalim(corners)  # what a collection says of itself is wrong on a log axis
    axes.add_collection(cells, autolim=False)
    axes.autoscale_view()
    return cells


def is_finite(curve):
    """Which samples can be drawn."""
    columns = [column.values for column in (curve.x, curve.y, curve.z) if column]
    return np.isfinite(columns).all(axis=0)


def in_sight(curve, panel):
    """Which samples are finite and inside x_range."""
    low, high = panel.x_range
    return is_finite(curve) & ~(curve.x.values < low) & ~(curve.x.values > high)  # no comparison with NaN holds


def reach(curve, panel):
    """The y values that a curve covers in sight."""
    seen = in_sight(curve, panel)
    y = curve.y.values[seen]
    if curve.style == "band":
        return np.concatenate([y, curve.z.values[seen]])
    if curve.style in CELLS:
        return np.concatenate([ends[seen] for ends in cell_ends(curve, panel)[1]])
    return y


def with_units(label, columns):
    """The label, or else the columns' name; with the columns' unit where they agree on one not written yet."""
    names, units = ({getattr(column, field) for column in columns} for field in ("long_name", "units"))
    label = label or (names.pop() if len(names) == 1 else "")
    unit = units.pop() if len(units) == 1 else ""
    written = re.search(rf"[\[(/]|\bin {re.escape(unit)}\b", label) or label == unit
    return label if written or unit in ("", "1") else f"{label} [{unit}]".strip()


def set_y_range(axes, panel):
    """Automatic limits see what x_range shows, and do not blow up rounding noise about a constant."""
    automatic = all(math.isnan(limit) for limit in panel.y_range)
    extended = any(curve.style in ("bars", "circle") for curve in panel.curves)  # reach beyond their samples
    values = np.concatenate([reach(curve, panel) for curve in panel.curves] or [[]])
    if not automatic or extended or not values.size or any(curve.y.is_log for curve in panel.curves):
        set_given(axes.set_ylim, panel.y_range)
        return
    size, span = np.abs(values).max(), np.ptp(values)
    if 0 < span < 1e-6 * size:
        axes.set_ylim(values.mean() - 0.01 * size, values.mean() + 0.01 * size)
    elif span > 0 and not all(math.isnan(limit) for limit in panel.x_range):
        margin = 0 if has_cells(panel) else 0.05 * span
        axes.set_ylim(values.min() - margin, values.max() + margin)


def set_given(set_limits, limits):
    set_limits(*(None if math.isnan(limit) else limit for limit in limits))


def plain(value, _=None):
    return f"{value:.6g}".replace("-", "\u2212")


def set_names(axis, names):
    """Below a panel long words lean, so that they do not run into each other."""
    words = [textwrap.fill(names[value], 24) for value in sorted(names)]
    axis.set_ticks(sorted(names), words)
    if axis.axis_name == "x" and sum(map(len, words)) > 60:
        for label in axis.get_ticklabels():
            label.set(rotation=25, ha="right", rotation_mode="anchor")


def set_log_ticks(axis):
    """At 1, 2 and 5 of each decade."""
    axis.set_major_locator(matplotlib.ticker.LogLocator(subs=(1, 2, 5)))
    axis.set_major_formatter(matplotlib.ticker.FuncFormatter(lambda value, _: plain(float(f"{value:.3g}"))))
    axis.set_minor_locator(matplotlib.ticker.NullLocator())


def few_values(columns):
    """Those of the cells of a map, where each has room for its number."""
    values = distinct(np.concatenate([column.values for column in columns]))
    at = np.log(values) if any(column.is_log for column in columns) else values
    return values if 1 < values.size <= 8 and np.diff(at).min() > np.ptp(at) / 12 else None


def set_ticks(axis, limits, columns, of_map=False):
    """Plain numbers without a common offset or factor; the names of an enum; no half of what is counted."""
    names = next((column.names for column in columns if column.names), None)
    if names:
        set_names(axis, names)
        return
    few = few_values(columns) if of_map else None
    if any(column.is_log for column in columns):
        set_log_ticks(axis)
    elif columns and all(column.is_count for column in columns):
        axis.set_major_locator(matplotlib.ticker.MaxNLocator("auto", steps=[1, 2, 5, 10], integer=True))
    if few is not None:
        axis.set_major_locator(matplotlib.ticker.FixedLocator(few))
    if axis.get_scale() == "log":
        return
    size = max(abs(limit) for limit in limits)
    if 1e-3 <= size < 1e6:
        formatter = matplotlib.ticker.ScalarFormatter(useOffset=False)
        formatter.set_scientific(False)
    else:
        formatter = matplotlib.ticker.FuncFormatter(plain)
    axis.set_major_formatter(formatter)


def legend_below(panel):
    """Where it would cover an area, or much of a small panel, if it were inside, or a colour bar if it were beside."""
    styles = {curve.style for curve in panel.curves}
    crowded = len({curve.label for curve in panel.curves if curve.label}) > 3
    return "map" in styles or (panel.place is not None and (crowded or not styles.isdisjoint(("squares", "band"))))


def legend_place(axes, panel):
    """Beside a panel that has the width for itself, inside one of several in a row."""
    if legend_below(panel):
        under_labels = matplotlib.transforms.ScaledTranslation(0, -0.55, axes.figure.dpi_scale_trans)
        return dict(loc="upper left", bbox_to_anchor=(0, 0), bbox_transform=axes.transAxes + under_labels,
                    borderaxespad=0, ncol=3 if panel.place is None else 1)
    return dict(loc="upper left", bbox_to_anchor=(1.0, 1.02)) if panel.place is None else dict(loc="best")


def add_legend(axes, panel):
    handles, labels = axes.get_legend_handles_labels()
    if not handles:
        return
    entries = dict(zip(reversed(labels), reversed(handles)))  # the two edges of an interval have one label
    labels = list(dict.fromkeys(labels))
    legend = axes.legend([entries[label] for label in labels], [textwrap.fill(label, 24) for label in labels],
                         **legend_place(axes, panel))
    for line in legend.get_lines():  # small dots are hard to tell apart there
        line.set_markersize(max(5, line.get_markersize()))


def is_image(panel):
    """Such a panel is drawn without axes, as wide as it can be."""
    return any(curve.style == "image" for curve in panel.curves)


def without_axes(axes):
    axes.set_xticks([]), axes.set_yticks([])
    axes.spines[:].set_visible(False)
    axes.grid(False)


def curve_key(curve, i):
    """What has one colour throughout a figure: a label, or else a quantity and its place in the panel."""
    return curve.label or (curve.y.long_name, i)


def draw_panel(axes, panel, colours, title_width=80):
    """colours: of each curve, by curve_key. title_width: in letters."""
    if is_surface(panel):
        draw_surface(axes, panel, with_units)
        return
    xs, ys = [c.x for c in panel.curves], [c.y for c in panel.curves]
    for set_scale, columns in ((axes.set_xscale, xs), (axes.set_yscale, ys)):
        if any(column.is_log for column in columns):
            set_scale("log")
    for i, curve in enumerate(panel.curves):
        DRAW[curve.style](axes, curve, panel, colours.get(curve_key(curve, i)))
    set_given(axes.set_xlim, panel.x_range)
    set_y_range(axes, panel)
    axes.set_title(textwrap.fill(panel.title, title_width), loc="left")
    if is_image(panel):
        without_axes(axes)
        return
    of_map = any(curve.style == "map" for curve in panel.curves)
    set_ticks(axes.xaxis, axes.get_xlim(), xs, of_map)
    set_ticks(axes.yaxis, axes.get_ylim(), ys, of_map)
    if panel.place is not None and axes.get_xscale() == "linear":  # narrow: the labels would run into each other
        axes.locator_params(axis="x", nbins=5)
    axes.set_xlabel(with_units(panel.x_label, xs))
    axes.set_ylabel(textwrap.fill(with_units(panel.y_label, ys), 36))
    add_legend(axes, panel)

"""Draws one panel of a figure: its curves, scales, limits, ticks and labels."""
import math
import re

import matplotlib.ticker
import numpy as np

from .cells import asks_for_log, distinct
from .curves import DRAW, has_cells, is_sampled, reach, room_aside_in
from .style import LINES, is_formula, looks_in_panel
from .surface import draw_surface, is_surface
from .typeset import capitalised, typeset, with_unit
from .wrapping import TITLE, folded, text_width_in, wrapped

LONGEST_NAME_IN, LONGEST_BAR_LABEL_IN = 1.4, 1.8
LOG_PARTS = ((1,), (1, 3), (1, 2, 5), (1, 2, 3, 5, 7), range(1, 10))  # of a decade, that may have labels
MOST_DECADES = 6  # labels of an axis


def axis_label(label, columns):
    """The label, or else the columns' name; with the columns' unit where they agree on one not written yet."""
    names, units = ({getattr(column, field) for column in columns} for field in ("long_name", "units"))
    label = label or (names.pop() if len(names) == 1 else "")
    return with_unit(label, units.pop() if len(units) == 1 else "")


def wrapped_label(label, width_in):
    """The unit stays with the last word, where that leaves room for both."""
    last = re.search(r"\S+ \([^()]*\)$", label)
    if last and text_width_in(typeset(last[0])) <= width_in:
        label = label[:last.start()] + last[0].replace(" ", "\u00a0")
    return wrapped(label, width_in).replace("\u00a0", " ")


def asks_for_log_heights(panel):
    """Few positive values that span four decades would all lie on the axis. More than eight decades are rounding
    errors, unless y_range leaves them out."""
    curves = panel.curves
    if not curves or any(curve.style not in (*LINES, "dots") for curve in curves):
        return False
    values = np.concatenate([curve.y.values for curve in curves])
    values = values[np.isfinite(values)]
    if not 4 <= values.size <= 200:
        return False
    low, high = panel.y_range if np.isfinite(panel.y_range).all() else (values.min(), values.max())
    return low > 0 and 1e4 < high / low < 1e8


def set_y_range(axes, panel):
    """Automatic limits see what x_range shows, and do not blow up rounding noise about a constant."""
    automatic = all(math.isnan(limit) for limit in panel.y_range)
    extended = any(curve.style in ("bars", "circle") for curve in panel.curves)  # reach beyond their samples
    values = np.concatenate([reach(curve, panel) for curve in panel.curves] or [[]])
    if not automatic or extended or not values.size or axes.get_yscale() == "log":
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
    """Returns the number as text; a small or large one has a power of ten."""
    number, _, power = f"{value:.6g}".replace("-", "\u2212").partition("e")
    if not power:
        return number
    times = "" if number == "1" else f"{number} × "
    return f"{times}$10^{{{int(power.replace(chr(0x2212), '-'))}}}$"


def set_names(axis, names):
    """Below a panel long words lean, so that they do not run into each other."""
    words = [wrapped(names[value], LONGEST_NAME_IN) for value in sorted(names)]
    axis.set_ticks(sorted(names), words)
    if axis.axis_name == "x" and sum(map(len, words)) > 30:
        for label in axis.get_ticklabels():
            label.set(rotation=25, ha="right", rotation_mode="anchor")


def log_places(low, high, parts):
    """Returns these parts of each decade that lie between two positive values."""
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    return [part * 10.0**k for k in decades for part in parts if low * (1 - 1e-9) <= part * 10.0**k <= high * (1 + 1e-9)]


def power_of_ten(value, _=None):
    return f"$10^{{{round(math.log10(value))}}}$"


def short_number(places):
    """Returns a function that writes a number: with three digits if they tell the places apart, but a count whole."""
    digits = 3 if len({f"{place:.3g}" for place in places}) == len(places) else 6
    return lambda value, _: plain(value if value == round(value) else float(f"{value:.{digits}g}"))


def set_log_ticks(axis, values=None):
    """Three labels or more, at values or at as few parts of a decade as suffice, and minor ticks between them. Labels are
    powers of ten if one of them has to be."""
    low, high = sorted(axis.get_view_interval())
    parts = next((parts for parts in LOG_PARTS if len(log_places(low, high, parts)) > 2), ())
    places = log_places(low, high, parts) or matplotlib.ticker.MaxNLocator(4).tick_values(low, high)
    step = math.ceil(len(places) / MOST_DECADES) if parts == (1,) else 1
    places = [place for place in places if step == 1 or round(math.log10(place)) % step == 0]
    is_power = parts == (1,) and (min(places) < 1e-3 or max(places) > 1e4)
    places = places if values is None or len(values) < 3 else values
    axis.set_major_locator(matplotlib.ticker.FixedLocator(places))
    axis.set_major_formatter(power_of_ten if is_power else short_number(places))
    axis.set_minor_locator(matplotlib.ticker.FixedLocator(log_places(low, high, range(1, 10) if step == 1 else (1,))))
    axis.set_minor_formatter(matplotlib.ticker.NullFormatter())


def few_values(columns, length_in, is_upright):
    """Returns the values of a few cells or samples if an axis of this length has room for all their numbers; else
    None."""
    values = distinct(np.concatenate([column.values for column in columns] or [[]]))
    if not 1 < values.size <= 8:
        return None
    at = np.log(values) if asks_for_log(columns) and values[0] > 0 else values
    needed_in = 0.18 if is_upright else max(text_width_in(plain(value)) for value in values) + 0.07
    return values if np.diff(at).min() / np.ptp(at) * length_in > needed_in else None


def sampled_at(panel):
    """Returns the x columns of the samples of a panel. Formulas are ignored. Empty if a curve has many samples."""
    shown = [curve for curve in panel.curves if not (curve.style in LINES and is_formula(curve.label))]
    few = all(is_sampled(curve) or curve.style in ("dots", "intervals", "bars", "map") for curve in shown)
    return [curve.x for curve in shown] if few else []


def set_end_ticks(axis, limits):
    """Gives both ends of a colour bar a tick with a value. A tick that is too near to an end is removed."""
    (low, high), ticks = limits, axis.get_major_locator().tick_values(*limits)
    span = high - low
    kept = [low, *(tick for tick in ticks if low + 0.09 * span < tick < high - 0.09 * span), high]
    digits = 2 - math.floor(math.log10(span))
    axis.set_ticks(kept, [plain(round(tick, digits) + 0.0) for tick in kept])


def set_ticks(axis, limits, columns, few=(), length_in=3.0):
    """Plain numbers without a common offset or factor; the names of an enum; no half of what is counted. few: columns
    whose values have ticks, if there is room. length_in: of the axis."""
    names = next((column.names for column in columns if column.names), None)
    if names:
        set_names(axis, names)
        return
    values = few_values(few, length_in, axis.axis_name == "y")
    if axis.get_scale() == "log":
        set_log_ticks(axis, values)
        return
    room = max(2, round(length_in / 0.45)) if axis.axis_name == "x" else 5
    whole = bool(columns) and all(column.is_count for column in columns)
    axis.set_major_locator(matplotlib.ticker.MaxNLocator(min(room, 7), steps=[1, 2, 2.5, 5, 10] if not whole else
                                                         [1, 2, 5, 10], integer=whole, min_n_ticks=3))
    if values is not None:
        axis.set_major_locator(matplotlib.ticker.FixedLocator(values))
    size = max(abs(limit) for limit in limits)
    if 1e-3 <= size < 1e6:
        formatter = matplotlib.ticker.ScalarFormatter(useOffset=False)
        formatter.set_scientific(False)
    else:
        formatter = matplotlib.ticker.FuncFormatter(plain)
    axis.set_major_formatter(formatter)


def title_words(title, letter):
    """Returns the title as it is drawn, with the letter of the panel. `A) at the start` becomes `A: at the start`,
    because the letter of a moment would look like that of a panel."""
    moment = re.match(r"([A-Z])\) ", title)
    shown = typeset(f"{moment[1]}: {title[moment.end():]}" if moment else capitalised(title))
    return f"({letter}) {shown}".strip() if letter else shown


def is_image(panel):
    """Such a panel is drawn without axes, as wide as it can be."""
    return any(curve.style == "image" for curve in panel.curves)


def without_axes(axes):
    axes.set_xticks([]), axes.set_yticks([])
    axes.spines[:].set_visible(False)
    axes.grid(False)


def set_scales(axes, panel):
    if asks_for_log([curve.x for curve in panel.curves]):
        axes.set_xscale("log")
    ys = [curve.y for curve in panel.curves]
    of_cells = any(curve.style in ("map", "squares") for curve in panel.curves)
    if any(y.is_log for y in ys) or (of_cells and asks_for_log(ys)) or asks_for_log_heights(panel):
        axes.set_yscale("log")


def add_colour_bar(axes, coloured, column, width_in):
    """The bar is attached to the panel, so it moves with it. coloured: the artist that has the colours. column: its
    values."""
    bar = axes.figure.colorbar(coloured, cax=axes.inset_axes([1 + 0.06 / width_in, 0, 0.1 / width_in, 1]))
    bar.outline.set_visible(False)
    bar.set_label(wrapped_label(axis_label("", [column]), LONGEST_BAR_LABEL_IN), labelpad=4)
    set_ticks(bar.ax.yaxis, coloured.get_clim(), [column])
    if not column.names:
        set_end_ticks(bar.ax.yaxis, coloured.get_clim())


def draw_panel(axes, panel, looks, width_in=3.0, bar=True, height_in=2.0):
    """Draws everything but the title, which add_words() writes. looks: of each curve, by curve_key. width_in,
    height_in: about the size of the panel. bar: whether a colour bar explains the colours of a map or a surface."""
    if is_surface(panel):
        draw_surface(axes, panel, add_colour_bar if bar else None)
        return
    set_scales(axes, panel)
    for curve, look in zip(panel.curves, looks_in_panel(panel, looks)):
        DRAW[curve.style](axes, curve, panel, look)
    if any(curve.x.names and curve.style == "dots" for curve in panel.curves):
        axes.margins(x=0.3)  # room for the names
    elif room_aside_in(panel):
        axes.margins(x=0.05 + room_aside_in(panel) / width_in)
    set_given(axes.set_xlim, panel.x_range)
    set_y_range(axes, panel)
    if is_image(panel):
        without_axes(axes)
        return
    xs, ys = [c.x for c in panel.curves], [c.y for c in panel.curves]
    of_map = [curve for curve in panel.curves if curve.style == "map"]
    if of_map and bar:
        coloured = next(cells for cells in axes.collections if cells.get_array() is not None)
        add_colour_bar(axes, coloured, of_map[0].z, width_in)
    set_ticks(axes.xaxis, axes.get_xlim(), xs, [curve.x for curve in of_map] or sampled_at(panel), width_in)
    set_ticks(axes.yaxis, axes.get_ylim(), ys, [curve.y for curve in of_map], height_in)
    axes.set_xlabel(wrapped_label(axis_label(panel.x_label, xs), width_in))
    axes.set_ylabel(wrapped_label(axis_label(panel.y_label, ys), height_in))


def add_words(axes, panel, title, width_in, title_in):
    """Writes the title, and wraps the label below the panel. title: of title_words(). width_in: of the panel."""
    axes.set_title(folded(title, title_in, TITLE), loc="left")
    if axes.get_xlabel() and not is_surface(panel):
        xs = [curve.x for curve in panel.curves]
        axes.set_xlabel(wrapped_label(axis_label(panel.x_label, xs), width_in))

"""Draws the curves of a panel, each in its style."""
import math

import matplotlib.collections
import matplotlib.patches
import matplotlib.path
import matplotlib.patheffects
import matplotlib.transforms
import numpy as np

from .cells import cell_ends, cell_size, colour_range, outlines
from .scene import rgb
from .style import DASHES, LINES, MARKERS, NOTHING_COLOUR, is_formula
from .typeset import typeset

NOTHING, NOT_FINITE = "no value", "no finite value"  # where a map or a bar chart has none
CELLS = ("squares", "map")  # the styles that draw cells
MANY = 3000  # plots with more samples are stored as pixels in vector formats
FEW = 20  # samples of a line that have a marker each
DOT_PT, RING_PT, CAP_PT, ARROW_PT, APART_PT = 3.8, 6, 4.5, 11, 5.5  # ARROW_PT: its length; APART_PT: between marks of clipped values
ARROW = matplotlib.path.Path([(0, 0), (0, 1), (-0.22, 0.7), (0, 1), (0.22, 0.7)], [1, 2, 1, 2, 2])  # 1: begins a line
HALO = [matplotlib.patheffects.withStroke(linewidth=2.6, foreground="white")]  # about a line over cells
LETTERS_IN = 0.15  # height of the letters above a panel


def has_cells(panel):
    return any(curve.style in CELLS for curve in panel.curves)


def is_finite(curve):
    """Which samples can be drawn."""
    columns = [column.values for column in (curve.x, curve.y, curve.z) if column]
    return np.isfinite(columns).all(axis=0)


def in_sight(curve, panel):
    """Which samples are finite and inside x_range."""
    low, high = panel.x_range
    return is_finite(curve) & ~(curve.x.values < low) & ~(curve.x.values > high)  # no comparison with NaN holds


# Each style draws one curve of the panel it is in. look: style.Look

def alone(curve):
    """The samples whose neighbours have no value: a line through one point would not be seen."""
    seen = np.pad(is_finite(curve), 1)
    return [int(i) for i in np.flatnonzero(seen[1:-1] & ~seen[:-2] & ~seen[2:])]


def is_sampled(curve):
    """Returns whether each sample of a line has a marker. A straight piece between two samples is no measurement."""
    few = np.count_nonzero(is_finite(curve)) <= FEW
    return few and curve.style in ("line", "dashed") and not is_formula(curve.label)


def draw_line(axes, curve, panel, look, **options):
    dots = alone(curve)
    if interval_series(curve, panel) or (is_sampled(curve) and not has_cells(panel)):
        options |= {"marker": MARKERS[look.marker], "markersize": 3}
    elif dots:
        options |= {"marker": "o", "markevery": dots}
    width = 1.1 if curve.x.values.size <= 2000 else 0.8  # a noisy trace stays a line
    if has_cells(panel):
        width, options = 1.3, options | {"path_effects": HALO}
    elif look.edged and "marker" not in options:
        options |= {"path_effects": HALO}
    line, = axes.plot(curve.x.values, curve.y.values, color=look.colour, linestyle=dashed(look), linewidth=width,
                      label=typeset(curve.label), zorder=layer(curve, panel, look), **options)
    line.dash = look.dash  # for its legend
    put_aside(axes, line, curve, panel)
    mark_clipped(axes, curve, panel, look)


def clipped(curve, panel):
    """Which samples have a mark because they are below the panel, and which because they are above it. An infinite value is
    beyond every panel. Of samples without a marker only the first of a stretch of infinite values has a mark."""
    (left, right), (first, last), x, y = sorted(panel.x_range), panel.y_range, curve.x.values, curve.y.values
    dots = curve.style == "dots" and np.count_nonzero(is_finite(curve)) <= 100
    none = np.zeros(x.size, dtype=bool)
    if curve.style not in (*LINES, "dots", "bars") or curve.style in LINES and is_formula(curve.label):
        return none, none
    shown = np.isfinite(x) & ~((x < left) | (x > right))
    if not (dots or is_sampled(curve) or curve.style == "bars"):
        shown &= np.isinf(y) & (y != np.append(math.nan, y[:-1]))
    low, high = (last, first) if first > last else (first, last)
    ends = shown & ((y < low) | (y == -math.inf)), shown & ((y > high) | (y == math.inf))
    return ends[::-1] if first > last else ends


def mark_clipped(axes, curve, panel, look, aside=0.0):
    """Marks samples beyond the panel at its edge, by a triangle that points out of it. Those of several curves at one
    place stand above each other. aside: of bars, in units of x."""
    stacked = [other for other in panel.curves if other.style != "bars"]
    for end, (marker, inwards, words) in enumerate((("v", 1, "below the axis"), ("^", -1, "above the axis"))):
        own = {"marker": marker, "markersize": DOT_PT, "markerfacecolor": "white", "linestyle": "none"}
        at = curve.x.values[clipped(curve, panel)[end]]
        for x in at:
            alike = [other for other in stacked if x in other.x.values[clipped(other, panel)[end]]]
            aside_in = inwards * next((i for i, other in enumerate(alike) if other is curve), 0) * APART_PT / 72
            axes.plot(x + aside, end, color=look.colour, clip_on=False, zorder=5, **own, transform=axes.get_xaxis_transform() +
                      matplotlib.transforms.ScaledTranslation(0, aside_in, axes.figure.dpi_scale_trans))
        if at.size:
            axes.plot([], [], color="#555555", label=words, **own)


def dashed(look):
    """Returns the line style that a look has in its panel."""
    if look.dash == 0:
        return DASHES[0]
    return look.phase * sum(DASHES[look.dash][1]), DASHES[look.dash][1]


def layer(curve, panel, look):
    """Returns the z-order. Curves are drawn in their order, but a dashed line above all solid lines, which would hide
    it."""
    above = ("line", "steps") if look.dash else ()
    at = [i for i, other in enumerate(panel.curves) if other is curve or other.style in above]
    return 2 + 0.01 * max(at) + (0.005 if look.dash else 0)


def interval_series(curve, panel):
    """Returns the index of the intervals of this curve among all intervals of the panel at the same x, and the number
    of these; None if the curve has no intervals. The intervals of a curve come directly before it in panel.curves."""
    at = [i for i, other in enumerate(panel.curves)
          if other.style == "intervals" and np.isin(other.x.values, curve.x.values).any()]
    i = next(i for i, other in enumerate(panel.curves) if other is curve)
    mine = [k for k, interval in enumerate(at) if interval in (i, i - 1)]
    return (mine[0], len(at)) if mine else None


def aside_in(panel):
    """Returns the distance of intervals that stand beside each other. Dots need more room than lines."""
    return (4.5 if any(curve.style == "dots" for curve in panel.curves) else 2.4) / 72


def room_aside_in(panel):
    """Returns the room that the outer intervals need left of the first x and right of the last one."""
    counts = [series[1] for curve in panel.curves if (series := interval_series(curve, panel))]
    return aside_in(panel) * max(counts, default=0) / 2 if max(counts, default=0) > 1 else 0.0


def put_aside(axes, line, curve, panel):
    """Intervals at one place stand beside each other. The limits of the axes are those of the data."""
    if series := interval_series(curve, panel):
        step_in = aside_in(panel) * (series[0] - (series[1] - 1) / 2)
        aside = matplotlib.transforms.ScaledTranslation(step_in, 0, axes.figure.dpi_scale_trans)
        line.set_transform(axes.transData + aside)


def draw_steps(axes, curve, panel, look):
    draw_line(axes, curve, panel, look, drawstyle="steps-post")


def draw_dots(axes, curve, panel, look):
    """The fewer dots are in sight, the larger they are. Few dots of a second series may lie on those of the first. Dots
    from the second series on are therefore open, and larger than those of the first. Dots of which no x is known stand on
    the right edge of the panel."""
    if curve.x.values.size and np.isnan(curve.x.values).all():
        low, high = sorted(panel.y_range)
        seen = curve.y.values[~((curve.y.values < low) | (curve.y.values > high))]
        axes.plot(np.ones(seen.size), seen, linestyle="none", marker=MARKERS[look.marker], color=look.colour,
                  markersize=DOT_PT, clip_on=False, label=typeset(curve.label), transform=axes.get_yaxis_transform())
        return
    count = np.count_nonzero(in_sight(curve, panel))
    size = DOT_PT if count <= 30 else 3 if count <= 100 else 1.8 if count <= 300 else 1.1 if count <= MANY else 0.7
    series = [other for other in panel.curves if other.style == "dots"].index(curve)
    options = {"markeredgewidth": 0}
    if series > 0 and count <= 100:
        size, options = RING_PT if count <= FEW else DOT_PT, {"markerfacecolor": "none", "markeredgewidth": 0.9}
    automatic = np.isnan(panel.x_range + panel.y_range).all()
    line, = axes.plot(curve.x.values, curve.y.values, linestyle="none", marker=MARKERS[look.marker] if count <= 100 else "o",
                      color=look.colour, markersize=size, label=typeset(curve.label), rasterized=count > MANY,
                      clip_on=not automatic or count > 100, zorder=layer(curve, panel, look), **options)
    put_aside(axes, line, curve, panel)
    mark_clipped(axes, curve, panel, look)


def draw_letters(axes, curve, _, __):
    """The names of z stand above the panel, each at a thin vertical line, so they cover no curve."""
    known = is_finite(curve)
    for x, name in zip(curve.x.values[known], curve.z.values[known]):
        axes.axvline(x, color="#555555", linewidth=0.6, zorder=1)
        axes.annotate(typeset(curve.z.names[name]), (x, 1), xycoords=("data", "axes fraction"), xytext=(0, 2),
                      textcoords="offset points", ha="center", va="bottom", fontweight="bold", annotation_clip=False)


def room_above_in(panel):
    """Returns the height of what stands directly above a panel, below its legend and title."""
    return LETTERS_IN if any(curve.style == "letters" for curve in panel.curves) else 0.0


def draw_circles(axes, curve, _, look):
    """Circles of a radius in data units; an empty line makes the legend entry."""
    axes.plot([], [], "o", color=look.colour, markersize=6, markerfacecolor="none", label=typeset(curve.label))
    centres = np.column_stack([curve.x.values, curve.y.values])
    centres = centres[np.isfinite(centres).all(axis=1)]
    circles = [matplotlib.patches.Circle(centre, curve.radius) for centre in centres]
    axes.add_collection(matplotlib.collections.PatchCollection(
        circles, facecolor="none", edgecolor=look.colour, linewidth=0.8))
    axes.autoscale_view()


def draw_bars(axes, curve, panel, look):
    """The bar charts of one panel stand side by side. A cross stands where there is no value, which is not 0."""
    charts = [other for other in panel.curves if other.style == "bars"]
    places = np.unique(curve.x.values[np.isfinite(curve.x.values)])
    spacing = np.diff(places).min() if places.size > 2 else np.ptp(places) / 2 if places.size == 2 else 1.0
    width = 0.8 * spacing / len(charts)
    offset = (charts.index(curve) - (len(charts) - 1) / 2) * width
    heights = np.where(np.isinf(curve.y.values), math.nan, curve.y.values)
    axes.bar(curve.x.values + offset, heights, width=0.94 * width, color=look.colour, label=typeset(curve.label))
    none = np.isnan(curve.y.values)
    if none.any():
        low, high = sorted(panel.y_range)
        foot = min(max(0.0, low), high)  # no comparison with NaN holds
        axes.plot(curve.x.values[none] + offset, np.full(none.sum(), foot), "x", color="black", clip_on=False, label=NOTHING)
    mark_clipped(axes, curve, panel, look, offset)


def draw_squares(axes, curve, panel, look):
    """Filled cells; an empty line makes the legend entry."""
    axes.plot([], [], "s", color=look.colour, markersize=6, markeredgewidth=0, label=typeset(curve.label))
    add_cells(axes, curve, panel, is_finite(curve), facecolor=look.colour)


def draw_map(axes, curve, panel, _):
    """Cells coloured by z; drawing.add_colour_bar says what the colours mean."""
    known = is_finite(curve)
    none = ~known & np.isfinite(curve.x.values) & np.isfinite(curve.y.values)
    if none.any():
        label = NOT_FINITE if np.isinf(curve.z.values).any() else NOTHING
        axes.plot([], [], "s", color=NOTHING_COLOUR, markersize=6, markeredgewidth=0, label=label)
        add_cells(axes, curve, panel, none, facecolor=NOTHING_COLOUR)
    cells = add_cells(axes, curve, panel, known, array=curve.z.values[known], cmap="viridis")
    cells.set_clim(colour_range(curve.z))


def draw_band(axes, curve, panel, look):
    """Several bands without a label would mix their colours, so each of them has an edge."""
    edged = sum(other.style == "band" and not other.label for other in panel.curves) > 1
    axes.fill_between(curve.x.values, curve.y.values, curve.z.values, color=look.colour, alpha=0.12 if edged else 0.22,
                      linewidth=0, label=typeset(curve.label))
    if edged:
        for ends in (curve.y.values, curve.z.values):
            axes.plot(curve.x.values, ends, color=look.colour, linewidth=0.5)


def draw_intervals(axes, curve, panel, look):
    """Draws a vertical line from y to z at each x, with a cap at an end that is not the value of the next curve. If an
    end is infinite or NaN, the line ends at that value, and an arrow points on from there."""
    x, low, high = curve.x.values, curve.y.values, curve.z.values
    own = {"color": look.colour, "linewidth": 0.9, "markeredgewidth": 0.9, "markerfacecolor": "none"}
    values, lines = next_values(curve, panel), []
    is_open = np.isfinite(low) != np.isfinite(high)
    known = np.where(np.isfinite(low), low, high)
    inner = np.where(np.isfinite(values), values, known)  # where an open interval has its arrow
    ends = [np.where(is_open, places, both) for places, both in ((known, low), (inner, high))]
    drawn = np.isfinite(ends).all(axis=0) & ~(is_open & (known == inner))
    bars = np.column_stack([*ends, np.full(x.size, math.nan)])[drawn].ravel()
    lines += axes.plot(np.repeat(x[drawn], 3), bars, **own)
    for y in ends:
        capped = drawn & (y != values)
        lines += axes.plot(x[capped], y[capped], "_", markersize=CAP_PT, **own)
    for end, path in ((low, ARROW), (high, matplotlib.path.Path(-ARROW.vertices, ARROW.codes))):
        arrows = is_open & np.isfinite(end)
        if arrows.any():
            lines += axes.plot(x[arrows], inner[arrows], linestyle="none", marker=path, markersize=2 * ARROW_PT,
                               clip_on=False, **own)
            axes.margins(y=0.12)  # room for arrows
    for line in lines:
        put_aside(axes, line, curve, panel)


def next_values(curve, panel):
    """Returns the values of the curve that intervals belong to."""
    i = next(i for i, other in enumerate(panel.curves) if other is curve)
    following = panel.curves[i + 1:i + 2]
    same = following and following[0].y.values.size == curve.y.values.size
    return following[0].y.values if same else np.full(curve.y.values.size, math.nan)


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


DRAW = {"line": draw_line, "dashed": draw_line, "steps": draw_steps, "dots": draw_dots,
        "circle": draw_circles, "bars": draw_bars, "squares": draw_squares, "map": draw_map, "band": draw_band,
        "intervals": draw_intervals, "image": draw_image, "letters": draw_letters}


def add_cells(axes, curve, panel, shown, **options):
    """Without a seam between neighbours, in vector formats as pixels. Automatic limits end where the cells end. shown:
    which of the samples."""
    drawn = outlines(curve, panel, shown)
    cells = matplotlib.collections.PolyCollection(drawn, linewidth=0, antialiased=False, rasterized=True, **options)
    if drawn.size:
        corners = drawn.reshape(-1, 2)
        for name, sticky, ends in zip("xy", (cells.sticky_edges.x, cells.sticky_edges.y), corners.T):
            sticky[:] = [ends.min(), ends.max()]
            if getattr(axes, f"get_{name}scale")() == "log":  # over many decades edges may be nearer than a margin's tolerance
                sticky.clear()
                axes.margins(**{name: 0})
        axes.update_datalim(corners)  # what a collection says of itself is wrong on a log axis
    axes.add_collection(cells, autolim=False)
    axes.autoscale_view()
    return cells


def reach(curve, panel):
    """The y values that a curve covers in sight."""
    seen = in_sight(curve, panel)
    y = curve.y.values[seen]
    if curve.style in ("band", "intervals"):
        return np.concatenate([y, curve.z.values[seen]])  # without arrows, which begin at the value of another curve
    if curve.style in CELLS:
        return np.concatenate([ends[seen] for ends in cell_ends(curve, panel)[1]])
    return y

"""The style of all pictures: sizes for print, and one colour for each meaning, also on the page of a scorecard.

Sizes are those of a journal: columns of 3.5 in, text of 8 pt. Every colour has a contrast of at least 3:1 to white. Two
colours are at least 15 apart in CIELAB, as normal, deutan and protan eyes see them; tests/system/plot_style_test
computes this. Curves with equal colours differ in dash or marker.
"""
import dataclasses
import re

COLUMN_IN, PAGE_IN = 3.5, 7.16  # widths of one column and of two with the gap between them
TEXT_PT, HEADING_PT = 8, 9
LETTER_IN, BOLD_IN = 0.064, 0.072  # mean width of a letter of the text, and of a title
PNG_DPI = 300
RC = {
    "font.family": "sans-serif", "font.sans-serif": ["DejaVu Sans"], "mathtext.fontset": "dejavusans",
    "font.size": TEXT_PT, "axes.titlesize": TEXT_PT, "axes.labelsize": TEXT_PT, "legend.fontsize": TEXT_PT,
    "xtick.labelsize": TEXT_PT, "ytick.labelsize": TEXT_PT, "figure.titlesize": HEADING_PT,
    "axes.titleweight": "bold", "axes.titlepad": 4, "axes.labelpad": 2,
    "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": "#555555", "axes.linewidth": 0.6,
    "xtick.major.size": 2.5, "ytick.major.size": 2.5, "xtick.major.width": 0.6, "ytick.major.width": 0.6,
    "axes.grid": True, "axes.axisbelow": True, "grid.color": "#e3e3e3", "grid.linewidth": 0.5,
    "legend.frameon": False, "legend.handlelength": 2.2, "legend.handletextpad": 0.5, "legend.columnspacing": 1.2,
    "legend.labelspacing": 0.25, "legend.borderpad": 0, "lines.markersize": 3.5,
    "pdf.fonttype": 42, "svg.fonttype": "none",  # embedded fonts; text that stays text
    "svg.hashsalt": "remote-touch",  # equal results are equal files
    "agg.path.chunksize": 20000,  # without it a long dense line can overflow the rasteriser
}

# Those of HIP to estimate are those of the viewer on a light ground: runners/presentation/view/page/src/colours.ts.
COLOURS = {"hip": "#c08800", "proxy": "#146bab", "truth": "#3691ba", "force": "#b34c00", "normal": "#00a67c",
           "points": "#81939f", "estimate": "#822055", "limit": "#000000", "fixture": "#452700", "measured": "#1b2a83",
           "region": "#8a3ffc"}
COMPONENTS = {"x": "#a81e3c", "y": "#4f9a2a", "z": "#4a55d8"}
SERIES = ("measured", "normal", "fixture", "region", "points", "proxy")  # for curves without a known meaning
NOTHING_COLOUR = "#d4d4d4"  # cells without a value

# The meaning of a curve, by its label: the first that matches. Without a label: by its quantity.
OF_LABEL = (
    (r"HIP\b|device\b", "hip"),
    (r"(proxy|tool|contact point)\b|r_c$", "proxy"),
    (r"force\b", "force"),
    (r"points\b", "points"),
    (r"normal$", "normal"),
    (r"true |truth|surface$|walls$|exact$", "truth"),
    (r"bound|limit|.*\bprinted\b|r_1 f_c|r_f \+ r_c$|\d+ \(\d|equal$|assigned\b", "limit"),
    (r".*refitted|with scatter|predicted|mean error of v_hat|its standard deviation|derived$|95 % confidence", "estimate"),
    (r"measured|observed|felt$|maximum of|mean$|half survive|ends of the", "measured"),
    (r"did not pop through", "points"), (r"yellow\b", "hip"),
    (r".*region", "fixture"),
)
OF_QUANTITY = ((r".*\bforce\b", "force"), (r".*\btorque\b", "fixture"), (r".*\b(proxy|tool|contact point)\b", "proxy"),
               (r".*\bHIP\b", "hip"), (r".+", "measured"))

DASHES = ("solid", (0, (5, 2.5)), (0, (1.2, 1.4)), (0, (6, 2, 1.2, 2)), (0, (6, 2, 1.2, 2, 1.2, 2)), (0, (9, 3)))
MARKERS = ("o", "s", "^", "D", "v", "P")
WITHOUT_COLOUR = ("map", "image", "surface", "letters", "band", "intervals")  # no colour of their own
LINES, DOTS = ("line", "dashed", "steps"), ("dots",)

# The renderers that are compared: colour, and numbers of dash and marker. Variants of a method share its colour.
METHODS = {
    "proxy": ("proxy", 0, 0), "proxy-density": ("proxy", 1, 1), "proxy-mean-of-4": ("proxy", 2, 2),
    "proxy-temporal-filter": ("proxy", 3, 3), "oracle-proxy": ("truth", 2, 4), "predecessor": ("measured", 0, 4),
    "god-object": ("force", 0, 3), "finger-proxy": ("fixture", 0, 5), "penalty": ("points", 0, 4),
    "metaballs-tuned": ("region", 0, 1), "metaballs-wyvill": ("region", 1, 2), "surfels-wendland": ("fixture", 1, 3),
    "tracked-sheet": ("estimate", 0, 0), "tracked-no-denoise": ("estimate", 1, 1), "look-ahead": ("measured", 0, 1),
    "continuous": ("normal", 0, 2), "voxels": ("fixture", 0, 0), "voxmap": ("points", 1, 5),
}
OTHER_NAMES = {"as printed": "voxels", "proxy of chapter 4": "proxy", "tracked sheet": "tracked-sheet",
               "tracked sheets": "tracked-sheet", "tracked": "tracked-sheet", "penalty method": "penalty"}


@dataclasses.dataclass(frozen=True)
class Look:
    colour: str
    dash: int = 0  # of DASHES
    marker: int = 0  # of MARKERS


def method_look(name):
    """The look of a renderer by its name, or None."""
    name = name.removeprefix("tool-")
    known = METHODS.get(OTHER_NAMES.get(name, name))
    return known and Look(COLOURS[known[0]], *known[1:])


def method_looks(names):
    """A look for each method of a list. Unknown names get combinations that no other method of the list has."""
    known = [method_look(name) for name in names]
    used, looks = {look for look in known if look}, []
    for look in known:
        free = (Look(COLOURS[key], dash, dash) for dash in range(len(DASHES)) for key in SERIES)
        look = look or next((other for other in free if other not in used), Look(COLOURS[SERIES[0]]))
        used.add(look)
        looks.append(look)
    return looks


def base(label):
    """What a curve is about: `look-ahead` for `look-ahead, derived` and for `measured, look-ahead`."""
    parts = [part for part in label.split(", ") if part not in ("derived", "measured", "")]
    return parts[0] if parts else label


def meaning(words, table):
    return next((name for pattern, name in table if re.match(pattern, words)), None)


def known_look(curve):
    """The look of a curve whose meaning is known, else None."""
    if not curve.label:
        name = meaning(curve.y.long_name, OF_QUANTITY)
    elif method_look(base(curve.label)):
        return method_look(base(curve.label))
    else:
        if component := re.fullmatch(r"(?:.*, )?([xyz])|roll \((x)\)|red valve", curve.label):
            return Look(COMPONENTS[component[1] or component[2] or "x"])
        name = meaning(base(curve.label), OF_LABEL)
    return Look(COLOURS[name]) if name else None


def curve_key(curve, i):
    """What has one look throughout a figure: a label, or else a quantity and its place in the panel."""
    return (curve.label or (curve.y.long_name, i)), kind(curve)


def kind(curve):
    """Curves of different kinds can be distinguished even if they have one colour."""
    return "line" if curve.style in LINES else "dots" if curve.style in DOTS else curve.style


def colour_of(curves, known, series):
    """A colour for each curve of a panel without one. series: colours by base, for the whole figure."""
    looks = []
    for i, curve in reversed(list(enumerate(curves))):  # an interval belongs to the curve that follows it
        look = known_look(curve)
        if curve.style in ("band", "intervals") and looks and (not look or not curve.label):
            look = Look(looks[0].colour)
        if not look:
            key = base(curve.label) if curve.label else curve_key(curve, i)
            look = Look(series.get(key, COLOURS[SERIES[0]]))
        looks.insert(0, known.get(curve_key(curve, i), look))
    return looks


def series_colours(panels):
    """Colours for curves without a known meaning: first those that no other curve of the figure has."""
    curves = [(i, curve) for panel in panels for i, curve in enumerate(panel.curves)]
    taken = {look.colour for _, curve in curves if (look := known_look(curve))}
    keys = dict.fromkeys(base(curve.label) if curve.label else curve_key(curve, i) for i, curve in curves
                         if not known_look(curve) and curve.style not in WITHOUT_COLOUR)
    free = [COLOURS[name] for name in SERIES if COLOURS[name] not in taken]
    order = free + [COLOURS[name] for name in SERIES if COLOURS[name] in taken]
    return {key: order[i % len(order)] for i, key in enumerate(keys)}


def distinct_look(look, curve, beside):
    """The look with the first dash or marker that no look of the same colour has. beside: looks of the same kind."""
    used = [other for other in beside if other.colour == look.colour]
    if curve.style in LINES:
        first = max(look.dash, int(curve.style == "dashed"))
        order = [first, *(dash for dash in range(len(DASHES)) if dash > first), *range(first)]
        dash = next((dash for dash in order if dash not in {other.dash for other in used}), first)
        return dataclasses.replace(look, dash=dash)
    order = [look.marker, *(marker for marker in range(len(MARKERS)) if marker != look.marker)]
    marker = next((marker for marker in order if marker not in {other.marker for other in used}), look.marker)
    return dataclasses.replace(look, marker=marker)


def looks(panels):
    """The look of every curve of a figure, by curve_key."""
    series, found = series_colours(panels), {}
    for panel in panels:
        for i, (curve, look) in enumerate(zip(panel.curves, colour_of(panel.curves, found, series))):
            key = curve_key(curve, i)
            if key not in found:
                beside = [found[other] for other in neighbours(panels, key) if other in found and other[1] == key[1]]
                found[key] = distinct_look(look, curve, beside)
    return found


def neighbours(panels, key):
    """Keys of the curves that share a panel with a curve."""
    keys = [[curve_key(curve, i) for i, curve in enumerate(panel.curves)] for panel in panels]
    return {other for group in keys if key in group for other in group if other != key}

"""The style of all pictures: sizes for print, and one colour for each meaning, also on the page of a scorecard.

Sizes are those of a journal: columns of 3.5 in, text of 8 pt. The colours, and which of them can meet, are a file that
the pages of results read too. Curves with equal colours differ in dash or marker.
"""
import dataclasses
import json
import pathlib
import re

COLUMN_IN, PAGE_IN = 3.5, 7.16  # widths of one column and of two with the gap between them
TEXT_PT, HEADING_PT = 8, 9
PNG_DPI = 300
RC = {
    "font.family": "sans-serif", "font.sans-serif": ["DejaVu Sans"], "mathtext.fontset": "dejavusans",
    "font.size": TEXT_PT, "figure.titlesize": HEADING_PT,
    **{f"{what}size": "medium" for what in ("axes.title", "axes.label", "legend.font", "xtick.label", "ytick.label")},
    "axes.titleweight": "bold", "axes.titlepad": 4, "axes.labelpad": 2,
    "axes.spines.top": False, "axes.spines.right": False, "axes.edgecolor": "#555555", "axes.linewidth": 0.6,
    "xtick.major.size": 2.5, "ytick.major.size": 2.5, "xtick.major.width": 0.6, "ytick.major.width": 0.6,
    "xtick.minor.size": 1.5, "ytick.minor.size": 1.5, "xtick.minor.width": 0.4, "ytick.minor.width": 0.4,
    "axes.grid": True, "axes.axisbelow": True, "grid.color": "#e3e3e3", "grid.linewidth": 0.5,
    "legend.frameon": False, "legend.handlelength": 2.75, "legend.handletextpad": 0.5, "legend.columnspacing": 1.2,
    "legend.labelspacing": 0.25, "legend.borderpad": 0, "lines.markersize": 3.5,
    "pdf.fonttype": 42, "svg.fonttype": "none",  # embedded fonts; text that stays text
    "svg.hashsalt": "remote-touch",  # equal results are equal files
    "agg.path.chunksize": 20000,  # without it a long dense line can overflow the rasteriser
}


def set_text(size_pt, font=None):
    """Call it before a module is imported that draws. font: a family, which the default one follows."""
    global TEXT_PT, HEADING_PT
    TEXT_PT, HEADING_PT = size_pt, size_pt + 1
    RC.update({"font.size": TEXT_PT, "figure.titlesize": HEADING_PT})
    RC["font.sans-serif"] = [*([font] if font else []), "DejaVu Sans"]


TABLE = json.loads(pathlib.Path(__file__).with_name("colours.json").read_text())  # a link leads there from the viewer
COLOURS = {name: pair["light"] for name, pair in TABLE["colours"].items() if "light" in pair}
ON_DARK = {pair["light"]: pair["dark"] for pair in TABLE["colours"].values() if len(pair) == 2}
SERIES = ("measured", "rose", "olive", "lavender", "points", "fixture")  # for curves without a known meaning
NOTHING_COLOUR = "#d4d4d4"  # cells without a value

# The meaning of a curve, by its label: the first that matches. Without a label: by its quantity.
OF_LABEL = (
    (r"HIP\b|device\b", "hip"),
    (r"(proxy|tool|contact point)\b|r_c$", "proxy"),
    (r"force\b", "force"),
    (r"points\b", "points"),
    (r"normal$", "normal"),
    (r"true |truth|surface$|walls$|exact$", "truth"),
    (r"bounds?\b|limit|.*\bprinted\b|r_1 f_c|r_f \+ r_c$|\d+ \(\d|equal$|assigned\b", "limit"),
    (r".*refitted|with scatter|predicted|mean error of v_hat|its standard deviation|derived$|95 % confidence", "estimate"),
    (r"measured|observed|felt$|maximum of|mean$|half survive|ends of the", "measured"),
    (r"did not pop through", "points"), (r"yellow\b", "hip"),
    (r".*region", "fixture"),
)
BOUND_DASH = 3  # index of the dash of a bound, which would look like a solid line of another dark colour
FORMULA = re.compile(r".*\b(derived|predicted|refitted|with scatter|law)\b")
OF_QUANTITY = ((r".*\bforce\b", "force"), (r".*\btorque\b", "fixture"), (r".*\b(proxy|tool|contact point)\b", "proxy"),
               (r".*\bHIP\b", "hip"), (r".+", "measured"))

# A handle of a legend, 2.75 em long, ends with a whole dash of the second pattern.
DASHES = ("solid", (0, (5, 2.5)), (0, (1.2, 1.4)), (0, (6, 2, 1.2, 2)), (0, (6, 2, 1.2, 2, 1.2, 2)), (0, (9, 3)))
MARKERS = ("o", "s", "^", "D", "v", "P")
WITHOUT_COLOUR = ("map", "image", "surface", "letters", "band", "intervals")  # no colour of their own
LINES, DOTS = ("line", "dashed", "steps"), ("dots",)

# The renderers that are compared: colour, and numbers of dash and marker. Variants of a method share its colour.
METHODS = {
    "proxy": ("proxy", 0, 0), "proxy-density": ("proxy", 1, 1), "proxy-mean-of-4": ("proxy", 2, 2),
    "proxy-temporal-filter": ("proxy", 3, 3), "oracle-proxy": ("truth", 2, 4), "predecessor": ("measured", 0, 4),
    "god-object": ("rose", 0, 3), "finger-proxy": ("fixture", 0, 5), "penalty": ("points", 0, 4),
    "metaballs-tuned": ("violet", 0, 1), "metaballs-wyvill": ("violet", 1, 2), "surfels-wendland": ("fixture", 1, 3),
    "mls-surface": ("rose", 3, 5), "inner-spheres": ("truth", 3, 4),
    "tracked-sheet": ("estimate", 0, 3), "tracked-no-denoise": ("estimate", 1, 1), "look-ahead": ("measured", 0, 1),
    "continuous": ("lavender", 0, 2), "voxels": ("fixture", 0, 0), "voxmap": ("points", 1, 5),
    "slave-none": ("truth", 0, 5), "slave-position-force": ("force", 0, 1), "slave-passivity": ("force", 2, 2),
    "slave-rendered": ("proxy", 0, 1), "slave-rendered-registered": ("proxy", 3, 2), "slave-tracked": ("estimate", 2, 4),
    "slave-region": ("violet", 0, 0), "slave-region-registered": ("violet", 3, 3), "slave-model-mediated": ("lavender", 2, 4),
}
OTHER_NAMES = {"as printed": "voxels", "proxy of chapter 4": "proxy", "tracked sheet": "tracked-sheet",
               "tracked sheets": "tracked-sheet", "tracked": "tracked-sheet", "penalty method": "penalty"}


@dataclasses.dataclass(frozen=True)
class Look:
    colour: str
    dash: int = 0  # of DASHES
    marker: int = 0  # of MARKERS
    phase: float = 0  # where in its dash a line begins, from 0 to 1
    edged: bool = False  # with a white edge, above a line of the same colour


def page_colour(colour):
    """A colour of a style sheet, which follows the ground of the page. colour: that on a light ground, or the user's."""
    return f"light-dark({colour}, {ON_DARK.get(colour, colour)})"


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


def parts_of(label):
    return [part for part in label.split(", ") if part not in ("derived", "measured", "")]


def base(label):
    """What a curve is about: `look-ahead` for `look-ahead, derived`, `measured, look-ahead` and `method = look-ahead: no run`."""
    return re.sub(r"^(renderer|method) = ", "", (parts_of(label) or [label])[0]).split(": ")[0]


def variant(label):
    """Returns the words that distinguish curves of one base: `1 mm` for `look-ahead, 1 mm`; may be empty."""
    return ", ".join(parts_of(label)[1:])


def meaning(words, table):
    return next((name for pattern, name in table if re.match(pattern, words)), None)


def is_formula(label):
    """Returns whether the label is that of a formula, whose samples are no measurements. A key that is no label is
    none."""
    if not isinstance(label, str) or FORMULA.match(label):
        return isinstance(label, str)
    return not method_look(base(label)) and meaning(base(label), OF_LABEL) in ("limit", "truth")


def known_look(curve):
    """The look of a curve whose meaning is known, else None."""
    label, name = curve.label, None
    if not label:
        name = meaning(curve.y.long_name, OF_QUANTITY)
    elif method_look(base(label)):
        return method_look(base(label))
    elif component := re.fullmatch(r"(?:.*, )?([xyz])|.*\broll\b.*|red valve", label):
        return Look(COLOURS[component[1] or "x"])
    elif label.startswith(("measured, ", "derived, ")):
        name = "measured" if label.startswith("m") else "estimate"
    else:
        name = meaning(base(label), OF_LABEL)
    return Look(COLOURS[name], BOUND_DASH if re.match(r"bounds?\b", label) else 0) if name else None


def curve_key(curve, i):
    """What has one look throughout a figure: a label, or else a quantity and its place in the panel."""
    return (curve.label or (curve.y.long_name, i)), kind(curve)


def kind(curve):
    """Curves of different kinds can be distinguished even if they have one colour."""
    return "line" if curve.style in LINES else "dots" if curve.style in DOTS else curve.style


def colour_of(curves, known, series):
    """Returns a look for each curve of a panel; dash and marker are not final. known: looks by curve_key. series: looks
    by base, for the whole figure."""
    found = []
    for i, curve in reversed(list(enumerate(curves))):  # an interval belongs to the curve that follows it
        look = known_look(curve)
        if curve.style in ("band", "intervals") and found and (not look or not curve.label):
            look = Look(found[0].colour)
        if not look:
            key = base(curve.label) if curve.label else curve_key(curve, i)
            look = series.get(key, Look(COLOURS[SERIES[0]]))
        found.insert(0, known.get(curve_key(curve, i), look))
    return found


def series_looks(panels):
    """Returns looks for curves without a known meaning. Colours that no other curve of the figure has come first."""
    curves = [(i, curve) for panel in panels for i, curve in enumerate(panel.curves)]
    taken = {look.colour for _, curve in curves if (look := known_look(curve))}
    keys = dict.fromkeys(base(curve.label) if curve.label else curve_key(curve, i) for i, curve in curves
                         if not known_look(curve) and curve.style not in WITHOUT_COLOUR)
    free = [COLOURS[name] for name in SERIES if COLOURS[name] not in taken]
    order = free + [COLOURS[name] for name in SERIES if COLOURS[name] in taken]
    return {key: Look(order[i % len(order)], marker=i % len(MARKERS)) for i, key in enumerate(keys)}


def first_free(order, used):
    """Returns the first value that is not used, or the first value if all are used."""
    order = list(order)
    return next((one for one in order if one not in used), order[0])


def in_turn(first, count):
    return [first, *range(first + 1, count), *range(first)]


def distinct_look(look, curve, beside):
    """Returns the look with the first dash that no line of its colour has, or the first marker that no dots of it have.
    beside: looks in the same panels, by curve_key. Curves of one variant, `look-ahead, 1 mm` and `voxels, 1 mm`, have
    one dash, and lines of one base one marker."""
    lines = {label: other for (label, which), other in beside.items() if which == "line"}
    if curve.style in LINES:
        first = max(look.dash, int(curve.style == "dashed"))
        alike = [other.dash for label, other in lines.items() if other.dash >= first and
                 isinstance(label, str) and variant(label) and variant(label) == variant(curve.label)]
        used = {other.dash for other in lines.values() if other.colour == look.colour}
        return dataclasses.replace(look, dash=first_free([*alike, *in_turn(first, len(DASHES))], used),
                                   marker=line_marker(look, curve, lines))
    used = {other.marker for (label, which), other in beside.items() if other.colour == look.colour and
            (which == kind(curve) or which == "line" and not is_formula(label))}
    return dataclasses.replace(look, marker=first_free(in_turn(look.marker, len(MARKERS)), used))


def line_marker(look, curve, lines):
    """Returns the marker of the method or of a line of the same base, else one that no other line has."""
    own = base(curve.label)
    same = [other.marker for label, other in lines.items() if isinstance(label, str) and base(label) == own]
    if same or method_look(own):
        return same[0] if same else look.marker
    return first_free(in_turn(look.marker, len(MARKERS)), {other.marker for other in lines.values()})


def looks(panels):
    """The look of every curve of a figure, by curve_key."""
    series, found = series_looks(panels), {}
    for panel in panels:
        for i, (curve, look) in enumerate(zip(panel.curves, colour_of(panel.curves, found, series))):
            key = curve_key(curve, i)
            if key not in found:
                beside = {other: found[other] for other in neighbours(panels, key) if other in found}
                found[key] = distinct_look(look, curve, beside)
    return found


def neighbours(panels, key):
    """Returns the keys of the curves that share a panel with a curve, in the order of the panels."""
    keys = [[curve_key(curve, i) for i, curve in enumerate(panel.curves)] for panel in panels]
    return dict.fromkeys(other for group in keys if key in group for other in group if other != key)


def looks_in_panel(panel, found):
    """Returns the looks of the curves of one panel. Lines of one dash begin at different phases, and a dashed line
    above a solid line of its colour has an edge, so lines that coincide can be distinguished. found: as looks() returns
    it."""
    own = [found.get(curve_key(curve, i)) for i, curve in enumerate(panel.curves)]
    lines = [(i, own[i]) for i, curve in enumerate(panel.curves) if own[i] and curve.style in LINES]
    solid = {look.colour for _, look in lines if not look.dash}
    for dash in range(1, len(DASHES)):
        group = [i for i, look in lines if look.dash == dash]
        for k, i in enumerate(group):
            own[i] = dataclasses.replace(own[i], phase=k / len(group), edged=own[i].colour in solid)
    return own

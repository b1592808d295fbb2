"""Panels of a sweep: measures over its axes, with 95 % intervals and the number of runs.

Over one axis: a line. Over two: a map, or a line for each of few names, such as renderers. Over more: slices, a panel
each, with a line for each value of an axis of few values, or a map."""
import dataclasses
import itertools
import json
import math
import re

import numpy as np

from .cells import colour_range
from .figure_file import Column, Curve, enum_names, text
from .plot_error import PlotError
from .results import AUTOMATIC, column, dataset, panel
from .states import DONE, read_states
from .typeset import SHOWN_UNITS, UNIT_OF_NAME, unit_words, without_json

MAX_PANELS, MAX_SLICES, ACROSS = 8, 12, 4
FEW = 5  # values of an axis that has a line for each
Z95 = 1.959964
EVENT = "1 when "  # the long_name of a measure of an event begins with this


def student_t(freedom):
    """The 97.5 % point, within 0.3 %."""
    if freedom <= 10:
        return (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228)[int(freedom) - 1]
    z = Z95
    return z + (z**3 + z) / (4 * freedom) + (5 * z**5 + 16 * z**3 + 3 * z) / (96 * freedom**2)


def exact_low(events, runs):
    """The low end of the exact interval of a fraction: there, so many events or more have a probability of 2.5 %."""
    def log_chance(k, p):
        return (math.lgamma(runs + 1) - math.lgamma(k + 1) - math.lgamma(runs - k + 1) + k * math.log(p)
                + (runs - k) * math.log1p(-p))
    low, high = 0.0, events / runs
    for _ in range(50 if events else 0):
        p = (low + high) / 2
        is_above = math.fsum(math.exp(log_chance(k, p)) for k in range(events, runs + 1)) > 0.025
        low, high = (low, p) if is_above else (p, high)
    return low


def exact_interval(events, runs):
    return exact_low(events, runs), 1 - exact_low(runs - events, runs)


def interval(values, is_event):
    """Mean and the ends of its 95 % interval; NaN where there are too few runs."""
    known = values[np.isfinite(values)]
    if not known.size:
        return math.nan, math.nan, math.nan
    if is_event:
        return known.mean(), *exact_interval(int(known.sum()), known.size)
    half = student_t(known.size - 1) * known.std(ddof=1) / math.sqrt(known.size) if known.size > 1 else math.nan
    return known.mean(), known.mean() - half, known.mean() + half


@dataclasses.dataclass
class Measure:
    name: str
    long_name: str
    units: str
    mean: np.ndarray  # over the axes
    low: np.ndarray
    high: np.ndarray
    replicates: int  # 0: of a sweep without
    note: str

    def column(self, values, limits=None):
        return Column(np.ravel(values), self.units, self.long_name, {}, limits=limits)

    def label(self):
        return with_shown_unit(self.name, self.units)


def runs_words(counts):
    low, high = counts.min(), counts.max()
    return f"{high} run{'s' * (high != 1)}" if low == high else f"{low} to {high} runs"


def unknown(values, is_done):
    """How many finished runs have no value of a measure, in words; nothing if all have one."""
    count = int(np.count_nonzero(is_done & ~np.isfinite(values)))
    return f", without {count} of {np.count_nonzero(is_done)} runs, whose value is unknown" if count else ""


def read_measure(file, name, axes, chosen, is_done):
    data = dataset(file, f"/sweep/{name}")
    made = np.where(is_done, data[()].astype(float), np.nan)
    values, long_name, names = made[chosen], text(data.attrs, "long_name"), enum_names(data)
    factor, units = SHOWN_UNITS.get(text(data.attrs, "units"), (1, text(data.attrs, "units")))
    replicates = values.shape[-1] if values.ndim > axes else 0
    of_cell = values.reshape(*values.shape[:axes], -1)
    is_event = long_name.startswith(EVENT) and not names
    mean, low, high = (np.empty(of_cell.shape[:-1]) for _ in range(3))
    for cell in np.ndindex(mean.shape):
        mean[cell], low[cell], high[cell] = interval(of_cell[cell], is_event and replicates > 0)
    note, runs = "", runs_words(np.isfinite(of_cell).sum(axis=-1))
    if replicates and is_event:
        long_name, note = f"share of runs in which {long_name.removeprefix(EVENT)}", f", {runs} each"
    elif replicates:
        note = f", mean of {runs}"
    note += unknown(values, is_done[chosen])
    scaled = (factor * each for each in (mean, low, high))
    return Measure(name, long_name, units, *scaled, replicates, note)


def with_shown_unit(name, units):
    """In words, with the unit that is shown. Names of parameters end with that in which they are stored."""
    name = UNIT_OF_NAME.sub("", name) if units not in ("", "1") else name
    name = name.replace("_", " ") if not re.fullmatch(r"[A-Za-z]_\w{1,3}", name) else name
    return f"{name} ({unit_words(units)})" if units not in ("", "1") else name


def log_axes(file, count):
    """Which axes the sweep declares to have equal ratios."""
    try:
        axes = json.loads(text(file.attrs, "config"))["axes"]
        return [axes[i].get("scale") == "log" for i in range(count)]
    except (ValueError, LookupError, TypeError, AttributeError):
        raise PlotError(f"{file.filename}: config is damaged: expected the axes of a sweep") from None


@dataclasses.dataclass
class Axis:
    name: str
    at: Column

    def label(self):
        return with_shown_unit(self.name, self.at.units)

    def value(self, i):
        """In words: `noise sigma = 2 mm`."""
        name = with_shown_unit(self.name, "1" if self.at.units in ("", "1") else self.at.units).split(" (")[0]
        unit = f" {unit_words(self.at.units)}" if self.at.units not in ("", "1") else ""
        return f"{name} = {self.words()[i]}{unit}"

    def words(self):
        """Of each value; with more digits if six do not tell all values apart."""
        six, twelve = ([self.at.names.get(value, f"{value:.{digits}g}") for value in self.at.values] for digits in (6, 12))
        return six if len(set(six)) == len(six) else twelve


def read_axes(file):
    names = text(file.attrs, "axes").split(",")
    axes = [Axis(name, column(dataset(file, f"/sweep/{name}"))) for name in names]
    for axis, is_log in zip(axes, log_axes(file, len(axes))):
        axis.at.is_log = is_log
        axis.at.names = {value: without_json(words) for value, words in axis.at.names.items()}
    return axes


def chosen_cells(axes, wanted):
    """An index for each axis, a number where --slice names a value. wanted: (name, value) in words."""
    index = [slice(None)] * len(axes)
    for name, value in wanted:
        i = next((i for i, axis in enumerate(axes) if axis.name == name), None)
        if i is None:
            raise PlotError(f"--slice {name}={value}: no such axis: expected one of {', '.join(a.name for a in axes)}")
        if not isinstance(index[i], slice):
            raise PlotError(f"--slice {name}={value}: the axis has a value already: expected one for each axis")
        index[i] = chosen_value(axes[i], value)
    return tuple(index)


def chosen_value(axis, value):
    """Index of the value that equals these words exactly, else of the only one that equals them at six digits."""
    known = axis.words()
    is_number = not axis.at.names
    found = [k for k, words in enumerate(known) if words == without_json(value) or is_number and equals(value, axis.at.values[k])]
    if not found and is_number:
        found = [k for k, each in enumerate(axis.at.values) if equals(value, float(f"{each:.6g}"), 1e-6)]
    if len(found) == 1:
        return found[0]
    what = "fits several values" if found else "no such value"
    expected = ("; " if any(", " in words for words in known) else ", ").join(known[k] for k in found or range(len(known)))
    unit = f" {axis.at.units}" if axis.at.units not in ("", "1") else ""
    raise PlotError(f"--slice {axis.name}={value}: {what}: expected one of {expected}{unit}")


def shown_axes(every, wanted):
    """The axes without a chosen value, and the index of the chosen cells."""
    chosen = chosen_cells(every, wanted)
    return [axis for axis, at in zip(every, chosen) if isinstance(at, slice)], chosen


def equals(words, value, tolerance=1e-12):
    """Whether the words are this number; the default tolerance is that of rounding by a change of units."""
    try:
        return math.isclose(float(words), value, rel_tol=tolerance)
    except ValueError:
        return False


def roles(axes):
    """Returns the index of the horizontal axis, the index of the axis of the lines or of the vertical axis of a map (None:
    there is one axis), the indices of the slice axes, and whether a map is drawn."""
    order = sorted(range(len(axes)), key=lambda i: (bool(axes[i].at.names), -axes[i].at.values.size, i))
    if len(axes) == 1:
        return 0, None, [], False
    if len(axes) == 2 and not (axes[order[1]].at.names and axes[order[1]].at.values.size <= FEW):
        return 0, 1, [], True
    across, others = order[0], order[1:]
    few = [i for i in others if axes[i].at.values.size <= FEW]
    second = max(few, key=lambda i: axes[i].at.values.size) if few else others[0]
    return across, second, [i for i in range(len(axes)) if i not in (across, second)], not few


def sliced(values, index, across, second):
    """Of an array over all axes the part over two, across first."""
    part = values[index]
    return part.T if second is not None and second < across else part


def line_curves(axis, measure, low_mean_high, label=""):
    low, mean, high = (measure.column(values) for values in low_mean_high)
    style = "dots" if axis.at.names else "line"
    curves = [Curve(axis.at, mean, style, label, 0, None)]
    if measure.replicates and np.isfinite(low.values).any():
        bars = axis.at.names or axis.at.values.size <= 12
        curves.insert(0, Curve(axis.at, low, "intervals" if bars else "band", "", 0, high))
    return curves


def map_curve(x, y, measure, values, limits):
    places = np.meshgrid(x.at.values, y.at.values, indexing="ij")
    columns = [dataclasses.replace(axis.at, values=np.ravel(place)) for axis, place in zip((x, y), places)]
    z = measure.column(values, limits)
    z.long_name += measure.note
    return Curve(*columns, "map", "", 0, z)


def slice_panel(axes, measure, part, place):
    """part: roles and the index of a slice."""
    (across, second, _, is_map), index, title = part
    low, mean, high = (sliced(values, index, across, second) for values in (measure.low, measure.mean, measure.high))
    x = axes[across]
    if is_map:
        return panel(title, x.label(), axes[second].label(), [map_curve(x, axes[second], measure, mean,
                                                                     place and colour_range(measure.column(measure.mean)))],
                     place)
    if second is None:
        return panel(title, x.label(), measure.label(), line_curves(x, measure, (low, mean, high)), place)
    curves = [curve for k in range(axes[second].at.values.size)
              for curve in line_curves(x, measure, (low[:, k], mean[:, k], high[:, k]), axes[second].value(k))]
    made = panel(title, x.label(), measure.label(), curves, place)
    return dataclasses.replace(made, y_range=common_range(measure))


def common_range(measure):
    """The same range for all slices, so that they can be compared."""
    known = np.stack([measure.low, measure.mean, measure.high])
    known = known[np.isfinite(known)]
    if not known.size or np.ptp(known) == 0:
        return AUTOMATIC
    margin = 0.05 * np.ptp(known)
    return [known.min() - margin, known.max() + margin]


def slices(axes, part):
    """The index and the words of each slice."""
    _, _, others, _ = part
    for at in itertools.product(*(range(axes[i].at.values.size) for i in others)):
        index = [slice(None)] * len(axes)
        for i, k in zip(others, at):
            index[i] = k
        yield part, tuple(index), ", ".join(axes[i].value(k) for i, k in zip(others, at))


def title_of(measure, part, slice_words):
    """What is measured, and in how many runs; of a map the bar says it."""
    if part[3]:
        name = with_shown_unit(measure.name, "1")
        return f"{name}, {slice_words}" if slice_words else name
    note = measure.note + (", 95 % intervals" if measure.replicates > 1 else "")
    return f"{slice_words}{note}" if slice_words else f"{measure.long_name}{note}"


def sweep_panels(file, wanted=()):
    """wanted: pairs of an axis and a value, in words."""
    axes, chosen = shown_axes(read_axes(file), wanted)
    if not axes:
        raise PlotError(f"{file.filename}: --slice for all axes leaves one cell: expected at least one axis without --slice")
    is_done = read_states(file) == DONE
    part = roles(axes)
    shown = list(slices(axes, part))[:MAX_SLICES]
    across = min(len(shown), ACROSS)
    panels, row = [], 0
    for name in text(file.attrs, "measures").split(",")[:max(1, MAX_PANELS // math.ceil(len(shown) / ACROSS))]:
        measure = read_measure(file, name, len(axes), chosen, is_done)
        for k, one in enumerate(shown):
            place = (row + k // across, k % across) if len(shown) > 1 else None
            made = slice_panel(axes, measure, one, place)
            panels.append(dataclasses.replace(made, title=title_of(measure, part, one[2])))
        row += math.ceil(len(shown) / across)
    return panels


def notes(file, chosen, is_done):
    """How many finished runs of the chosen cells have each kind of note, in words; results of earlier versions have none."""
    if "/sweep/notes" not in file:
        return []
    bits, kinds = np.ravel(dataset(file, "/sweep/notes")[()][chosen])[is_done], text(file.attrs, "note_kinds").split(",")
    counts = [(kind, int(np.count_nonzero(bits >> bit & 1))) for bit, kind in enumerate(kinds)]
    return [f"{count} of {bits.size} runs: {kind}" for kind, count in counts if count]


def left_out(file, wanted=()):
    """What of a sweep the picture does not show, in words."""
    words = [f"only {name} = {value}" for name, value in wanted]
    axes, chosen = shown_axes(read_axes(file), wanted)
    count = math.prod(axes[i].at.values.size for i in roles(axes)[2]) if axes else 1
    if count > MAX_SLICES:
        words.append(f"the first {MAX_SLICES} of {count} slices (--slice AXIS=VALUE chooses)")
    measures = len(text(file.attrs, "measures").split(","))
    shown = max(1, MAX_PANELS // math.ceil(min(count, MAX_SLICES) / ACROSS))
    if measures > shown:
        words.append(f"the first {shown} of {measures} measures")
    state = dataset(file, "/sweep/state")
    names, of_chosen = enum_names(state), np.ravel(read_states(file)[chosen])
    states = [names.get(value) for value in of_chosen]
    planned = len(states) - states.count("not_sampled")
    for what, count in (("failed", states.count("failed")),
                        ("are not done", states.count("pending") + states.count("elsewhere"))):
        if count:
            words.append(f"without {count} of {planned} runs, which {what}")
    words += notes(file, chosen, of_chosen == DONE)
    return "".join(f"; {each}" for each in words)

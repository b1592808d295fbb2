"""Panels of a trace or a sweep, which are no figures yet: position and force over time, measures over the axes. Lengths
are in mm."""
import dataclasses
import json
import math
import warnings

import h5py
import numpy as np

from plotting.figure_file import SCHEMAS, Column, Curve, Figure, Panel, enum_names, open_file, read_figure, text
from plotting.plot_error import PlotError

MAX_PANELS = 8
DONE = 2  # state of a run of a sweep
AUTOMATIC = [math.nan, math.nan]
SHOWN_UNITS = {"m": (1000, "mm")}  # factor, and the unit that is shown


def column(data, values=None):
    """One column of a dataset as it is shown, texts as the numbers of their names."""
    values = data[()] if values is None else values
    if h5py.check_string_dtype(data.dtype):
        words = [word.decode("utf-8", "replace").rstrip("\0") for word in np.ravel(values)]
        return Column(np.arange(len(words), dtype=float), "1", text(data.attrs, "long_name"), dict(enumerate(words)))
    stored = text(data.attrs, "units")
    factor, units = SHOWN_UNITS.get(stored, (1, stored))
    return Column(factor * np.ravel(values).astype(float), units, text(data.attrs, "long_name"), enum_names(data))


def with_units(name, of):
    return f"{name} / {of.units}" if of.units not in ("", "1") else name


def axis_label(name, of):
    """The name of a parameter ends with its unit, which may not be the one that is shown."""
    return with_units(name.removesuffix("_m") if of.units == "mm" else name, of)


def panel(title, x_label, y_label, curves):
    return Panel(title, x_label, y_label, False, AUTOMATIC, AUTOMATIC, None, curves, None)


def dataset(file, path):
    if path not in file or not isinstance(file[path], h5py.Dataset):
        raise PlotError(f"{file.filename}: {path} is not there")
    return file[path]


def trace_panels(file):
    """Each component of the positions, then of the force."""
    time = column(dataset(file, "/trace/time"))
    along = {name: dataset(file, f"/trace/{name}") for name in ("hip_position", "proxy_position", "force")}

    def curve(name, k, style, label):
        return Curve(time, column(along[name], along[name][:, k]), style, label, 0, None)

    panels = []
    for k, axis in enumerate("xyz"):
        curves = [curve("hip_position", k, "dashed", "HIP"), curve("proxy_position", k, "line", "proxy")]
        panels.append(panel(f"Position, {axis}", with_units("time", time), with_units(axis, curves[0].y), curves))
    force = [curve("force", k, "line", f"force, {axis}") for k, axis in enumerate("xyz")]
    return [*panels, panel("Force", with_units("time", time), with_units("force", force[0].y), force)]


def over_replicates(data, axes):
    """The mean of the runs that were made; NaN where there are none."""
    values = data[()].astype(float)
    if values.ndim == axes:
        return values
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)  # of nothing
        return np.nanmean(values, axis=axes)


def log_axes(file, count):
    """Which axes the sweep declares to have equal ratios."""
    try:
        axes = json.loads(text(file.attrs, "config"))["axes"]
        return [axes[i].get("scale") == "log" for i in range(count)]
    except (ValueError, LookupError, TypeError, AttributeError):
        raise PlotError(f"{file.filename}: config is damaged: expected the axes of a sweep") from None


def grid(file, axes):
    """Of each axis the value at every cell."""
    columns = [column(axis) for axis in axes]
    places = np.meshgrid(*[each.values for each in columns], indexing="ij")
    return [dataclasses.replace(each, values=np.ravel(place), is_log=is_log)
            for each, place, is_log in zip(columns, places, log_axes(file, len(axes)))]


def unknown(measure, is_done):
    """How many finished runs have no value of a measure, in words; nothing if all have one."""
    count = int(np.count_nonzero(is_done & ~np.isfinite(measure[()])))
    return f", without {count} of {np.count_nonzero(is_done)} runs, whose value is unknown" if count else ""


def sweep_panels(file):
    """A line for each measure over one axis, dots where that has words, a map over two."""
    axes = [dataset(file, f"/sweep/{name}") for name in text(file.attrs, "axes").split(",")]
    names = text(file.attrs, "measures").split(",")[:MAX_PANELS]
    if len(axes) > 2:
        raise PlotError(f"{file.filename}: a sweep over {len(axes)} axes: expected one or two, to be drawn")
    at = grid(file, axes)
    labels = [axis_label(axis.name.rsplit("/")[-1], place) for axis, place in zip(axes, at)]
    is_done = dataset(file, "/sweep/state")[()] == DONE
    panels = []
    for name in names:
        measure = dataset(file, f"/sweep/{name}")
        values = column(measure, over_replicates(measure, len(axes)))
        mean = f", mean of up to {measure.shape[-1]} runs" if measure.ndim > len(axes) else ""
        mean += unknown(measure, is_done)
        values.long_name += mean
        if len(axes) == 1:
            style = "dots" if at[0].names else "line"
            panels.append(panel("", labels[0], with_units(name + mean, values), [Curve(at[0], values, style, "", 0, None)]))
        else:
            panels.append(panel(name, labels[0], labels[1], [Curve(at[0], at[1], "map", "", 0, values)]))
    return panels


def notes(file, is_done):
    """How many of the finished runs have each kind of note, in words; results of earlier versions have none."""
    if "/sweep/notes" not in file:
        return []
    bits, kinds = np.ravel(dataset(file, "/sweep/notes")[()])[is_done], text(file.attrs, "note_kinds").split(",")
    counts = [(kind, int(np.count_nonzero(bits >> bit & 1))) for bit, kind in enumerate(kinds)]
    return [f"{count} of {bits.size} runs: {kind}" for kind, count in counts if count]


def left_out(file):
    """What of a sweep the picture does not show, in words."""
    words = []
    measures = len(text(file.attrs, "measures").split(","))
    if measures > MAX_PANELS:
        words.append(f"the first {MAX_PANELS} of {measures} measures")
    state = dataset(file, "/sweep/state")
    names = enum_names(state)
    states = [names.get(value) for value in np.ravel(state[()])]
    planned = len(states) - states.count("not_sampled")
    for what, count in (("failed", states.count("failed")),
                        ("are not done", states.count("pending") + states.count("elsewhere"))):
        if count:
            words.append(f"without {count} of {planned} runs, which {what}")
    words += notes(file, np.ravel(state[()]) == DONE)
    return "".join(f"; {each}" for each in words)


VERSIONS = [schema.split("/")[1] for schema in SCHEMAS]
TRACES = [f"remote-touch-trace/{version}" for version in VERSIONS]
SWEEPS = [f"remote-touch-sweep/{version}" for version in VERSIONS]


def read_drawable(path):
    """A figure, or a trace or a sweep as one."""
    with open_file(path) as file:
        schema = text(file.attrs, "schema")
        if schema in TRACES + SWEEPS:
            panels = sweep_panels(file) if schema in SWEEPS else trace_panels(file)
            heading = (text(file.attrs, "command") or path.name) + (left_out(file) if schema in SWEEPS else "")
            return Figure(path.stem, {"heading": heading}, panels)
    if schema not in SCHEMAS:
        raise PlotError(f"{path}: schema {schema!r}: expected a figure, a trace or a sweep of this program")
    return read_figure(path)

"""Panels of a trace or a sweep, which are no figures yet: position and force over time, measures over the axes."""
import math
import warnings

import h5py
import numpy as np

from plotting.figure_file import SCHEMA, Column, Curve, Figure, Panel, open_file, read_figure, text
from plotting.plot_error import PlotError

MAX_PANELS = 8
AUTOMATIC = [math.nan, math.nan]


def column(data, values=None):
    """One column of a dataset, texts as the numbers of their names."""
    values = data[()] if values is None else values
    if h5py.check_string_dtype(data.dtype):
        words = [word.decode("utf-8", "replace").rstrip("\0") for word in np.ravel(values)]
        return Column(np.arange(len(words), dtype=float), "1", text(data.attrs, "long_name"), dict(enumerate(words)))
    return Column(np.ravel(values).astype(float), text(data.attrs, "units"), text(data.attrs, "long_name"), {})


def with_units(name, of):
    return f"{name} / {of.units}" if of.units not in ("", "1") else name


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


def sweep_panels(file):
    """A line for each measure over one axis, a map over two."""
    axes = [dataset(file, f"/sweep/{name}") for name in text(file.attrs, "axes").split(",")]
    names = text(file.attrs, "measures").split(",")[:MAX_PANELS]
    if len(axes) > 2:
        raise PlotError(f"{file.filename}: a sweep over {len(axes)} axes: expected one or two, to be drawn")
    places = np.meshgrid(*[column(axis).values for axis in axes], indexing="ij")
    panels = []
    for name in names:
        measure = dataset(file, f"/sweep/{name}")
        values = column(measure, over_replicates(measure, len(axes)))
        at = [Column(np.ravel(place), column(axis).units, column(axis).long_name, column(axis).names)
              for place, axis in zip(places, axes)]
        labels = [with_units(axis.name.rsplit("/")[-1], place) for axis, place in zip(axes, at)]
        if len(axes) == 1:
            panels.append(panel("", labels[0], with_units(name, values), [Curve(at[0], values, "line", "", 0, None)]))
        else:
            panels.append(panel(name, labels[0], labels[1], [Curve(at[0], at[1], "map", "", 0, values)]))
    return panels


VERSION = SCHEMA.split("/")[1]
PANELS = {f"remote-touch-trace/{VERSION}": trace_panels, f"remote-touch-sweep/{VERSION}": sweep_panels}


def read_drawable(path):
    """A figure, or a trace or a sweep as one."""
    with open_file(path) as file:
        schema = text(file.attrs, "schema")
        if schema in PANELS:
            return Figure(path.stem, {"heading": text(file.attrs, "command") or path.name}, PANELS[schema](file))
    if schema != SCHEMA:
        raise PlotError(f"{path}: schema {schema!r}: expected a figure, a trace or a sweep of this program")
    return read_figure(path)

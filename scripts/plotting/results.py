"""Columns of results as they are shown, with lengths in mm, and the panels of a trace."""
import math

import h5py
import numpy as np

from .figure_file import Column, Curve, Panel, enum_names, text
from .plot_error import PlotError
from .typeset import SHOWN_UNITS, with_unit

AUTOMATIC = [math.nan, math.nan]


def column(data, values=None):
    """One column of a dataset as it is shown, texts as the numbers of their names."""
    values = data[()] if values is None else values
    if h5py.check_string_dtype(data.dtype):
        words = [word.decode("utf-8", "replace").rstrip("\0") for word in np.ravel(values)]
        return Column(np.arange(len(words), dtype=float), "1", text(data.attrs, "long_name"), dict(enumerate(words)))
    stored = text(data.attrs, "units")
    factor, units = SHOWN_UNITS.get(stored, (1, stored))
    return Column(factor * np.ravel(values).astype(float), units, text(data.attrs, "long_name"), enum_names(data))


def panel(title, x_label, y_label, curves, place=None):
    return Panel(title, x_label, y_label, False, AUTOMATIC, AUTOMATIC, place, curves, None)


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
        panels.append(panel(f"Position, {axis}", "time (s)", with_unit(axis, curves[0].y.units), curves))
    force = [curve("force", k, "line", f"force, {axis}") for k, axis in enumerate("xyz")]
    return [*panels, panel("Force", "time (s)", with_unit("force", force[0].y.units), force)]

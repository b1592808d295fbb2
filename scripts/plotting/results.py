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
    """The positions and the force of a trace; of a slave also its clearance, and magnitudes instead of components of the
    forces."""
    names = {"HIP": "hip_position", "proxy": "proxy_position", "slave": "slave_position"}
    time, along = column(dataset(file, "/trace/time")), {}
    for label, name in names.items():
        if label != "slave" or f"/trace/{name}" in file:
            along[label] = dataset(file, f"/trace/{name}")
    of = dataset(file, "/trace/force")

    def curve(values, label, data=of):
        return Curve(time, column(data, values), "dashed" if label == "HIP" else "line", label, 0, None)

    panels = []
    for k, axis in enumerate("xyz"):
        curves = [curve(data[:, k], label, data) for label, data in along.items()]
        panels.append(panel(f"Position, {axis}", "time (s)", with_unit(axis, curves[0].y.units), curves))
    if "slave" not in along:
        return [*panels, panel("Force", "time (s)", "force (N)", [curve(of[:, k], f"force, {axis}") for k, axis in enumerate("xyz")])]
    moved = [max((np.ptp(each.y.values) for each in one.curves if np.isfinite(each.y.values).any()), default=0) for one in panels]
    panels = [one for one, path in zip(panels, moved) if path >= 0.1 * max(moved)]  # a slave moves along few axes
    if "/trace/slave_clearance" in file:
        clearance = curve(None, "", dataset(file, "/trace/slave_clearance"))
        panels.append(panel("Clearance of the slave, negative in contact", "time (s)", "clearance (mm)", [clearance]))
    forces = {"force on the hand": "device_force", "on the slave": "slave_force"}
    curves = [curve(np.linalg.norm(file[f"/trace/{name}"][()], axis=1), label) for label, name in forces.items()
              if f"/trace/{name}" in file]
    return [*panels, panel("Magnitude of the forces", "time (s)", "force (N)", curves)]

"""xarray data sets of columns. No column is copied: the arrays are those in which the program computed."""
import warnings

import numpy as np
import xarray as xr

from remote_touch._core import InputError

_PARTS = {3: ("xyz", [*"xyz"]), 4: ("wxyz", [*"wxyz"])}  # as in the files


def _attributes(units, long_name, value_names):
    attributes = {"units": units, "long_name": long_name}
    if value_names:
        attributes["flag_values"] = np.arange(len(value_names), dtype=np.int32)
        attributes["flag_meanings"] = " ".join(name.replace(" ", "_") for name in value_names)
    return attributes


def _rows(columns, dimension):
    """Variables over the rows, and the coordinates that their other dimensions have."""
    variables, coordinates = {}, {}
    for name, units, long_name, values, value_names in columns:
        values = np.asarray(values, dtype=object) if isinstance(values, list) else values
        dimensions = (dimension,)
        if values.ndim == 2:
            other, labels = _PARTS.get(values.shape[1], (f"part_{values.shape[1]}", None))
            dimensions = (dimension, other)
            if labels:
                coordinates[other] = labels
        variables[name] = (dimensions, values, _attributes(units, long_name, value_names))
    return variables, coordinates


def of_trace(result):
    """A trace over time, with the measures of the run if they are known."""
    variables, coordinates = _rows([*result["columns"], *result.get("timing", [])], "time")
    coordinates["time"] = variables.pop("time")
    for name, units, long_name, values, _ in result.get("measures", []):
        variables[name] = ((), values[0], _attributes(units, long_name, []))
    attributes = {name: value for name, value in result["attributes"] if name != "default"}
    return xr.Dataset(variables, coordinates, attributes)


def _axes(result):
    """The coordinates of the axes by name, in their order."""
    coordinates = {}
    for name, units, long_name, values, value_names in result["axes"]:
        if value_names:
            values, units = np.array(value_names)[values], "1"
        coordinates[name] = (name, values, _attributes(units, long_name, []))
    return coordinates


def of_tally(result):
    """Counts and statistics of the measures over the axes."""
    coordinates = _axes(result)
    variables = {name: ([*coordinates], values, _attributes(units, long_name, value_names))
                 for name, units, long_name, values, value_names in result["columns"]}
    return xr.Dataset(variables, coordinates, dict(result["attributes"]))


def of_sweep(result):
    """Measures over the axes and the replicates; of a sweep that keeps a tally, see of_tally()."""
    if result["kind"] == "tally":
        return of_tally(result)
    coordinates = _axes(result)
    dimensions = [*coordinates, "replicate"]
    coordinates["replicate"] = ("replicate", np.arange(result["replicates"]),
                                _attributes("1", "number of the repeated run", []))
    variables = {name: (dimensions, values, _attributes(units, long_name, value_names))
                 for name, units, long_name, values, value_names in result["measures"]}
    if "notes" in variables:  # as CF says of numbers that are sets of flags
        kinds = dict(result["attributes"])["note_kinds"].split(",")
        variables["notes"][2].update(flag_masks=np.array([1 << bit for bit in range(len(kinds))], dtype=np.uint64),
                                     flag_meanings=" ".join(kind.replace(" ", "_") for kind in kinds))
    if any(result["error"]):
        shape = variables["state"][1].shape
        variables["error"] = (dimensions, np.array(result["error"], dtype=object).reshape(shape),
                              _attributes("1", "why the run failed", []))
    return xr.Dataset(variables, coordinates, dict(result["attributes"]))


def run_in(sweep, cell, replicate):
    """The cell, by the values of its axes, and the number of the replicate, of a place in a data set of a sweep."""
    places = [*sweep[next(iter(sweep.data_vars))].dims] if isinstance(sweep, xr.Dataset) and sweep.data_vars else []
    axes = [name for name in places if name != "replicate"]
    if not isinstance(cell, dict):
        given = [*cell] if hasattr(cell, "__iter__") and not isinstance(cell, str) else [cell]
        if len(given) != len(axes) or not all(name in sweep.coords for name in axes):
            raise InputError(f"cell = {cell!r}: expected the place on {', '.join(axes) or 'no axis'}, or a dict of the values of all axes")
        cell = {name: _at(sweep[name], place, f"cell: {name}") for name, place in zip(axes, given)}
    chosen = {name: value.item() for name, value in sweep.coords.items() if value.ndim == 0 and name != "replicate"}
    if "replicate" in sweep.coords:
        numbers = np.atleast_1d(sweep["replicate"].values)
        replicate = _at(numbers, replicate, "replicate")
    return {**chosen, **cell}, replicate


def _at(values, place, name):
    from remote_touch.calls import _integer
    return values[_integer(name, place, 0, len(values) - 1)].item()


def warned(sweep, subject):
    """The same, after a warning if some of its runs failed."""
    if "failed" in sweep.data_vars and (failed := int(sweep["failed"].sum())):
        warnings.warn(f"{subject}: {failed} of {int(sweep['runs'].sum())} runs failed", stacklevel=3)
    if "error" in sweep:
        failed = [text for text in sweep["error"].values.ravel() if text]
        warnings.warn(f"{subject}: {len(failed)} of {sweep['error'].size} runs failed, the first: {failed[0]}",
                      stacklevel=3)
    return sweep


def of_figure(result):
    """The tables of a figure by name, each with the attributes of the figure."""
    tables = {}
    for column in result["columns"]:
        table, name = column[0].split("/", 1)
        tables.setdefault(table, []).append((name, *column[1:]))
    attributes = {name: value for name, value in result["attributes"] if name != "default"}
    data_sets = {}
    for table, columns in tables.items():
        variables, coordinates = _rows(columns, "row")
        data_sets[table] = xr.Dataset(variables, coordinates, attributes)
    return data_sets


def columns_of(trace):
    """The columns and attributes of a trace that of_trace() made, for a comparison."""
    if not isinstance(trace, xr.Dataset) or "columns" not in trace.attrs:
        raise InputError(f"{type(trace).__name__}: expected files, or data sets of traces")
    columns = []
    for name in trace.attrs["columns"].split(","):
        if name not in trace.variables:
            continue
        variable = trace[name]
        columns.append((name, variable.attrs.get("units", "1"), variable.attrs.get("long_name", ""),
                        variable.values, variable.attrs.get("flag_meanings", "").split()))
    return [columns, [(name, value) for name, value in trace.attrs.items() if isinstance(value, str)]]


def parts_of_sweep(sweep):
    """The axes, measures, states, replicates and notes of a sweep that of_sweep() made, for an analysis."""
    if isinstance(sweep, xr.Dataset) and "runs" in sweep and "failed" in sweep:
        raise InputError("Dataset: of a tally: expected its file")
    dimensions = [*sweep["state"].dims] if isinstance(sweep, xr.Dataset) and "state" in sweep else []
    if len(dimensions) < 2 or dimensions[-1] != "replicate":
        raise InputError(f"{type(sweep).__name__}: expected a file, or what rt.sweep returned")
    axes = []
    for name in dimensions[:-1]:
        values, names = sweep[name].values, []
        if values.dtype.kind in "UO":
            names, values = [str(value) for value in values], np.arange(values.size, dtype=np.int32)
        axes.append((name, sweep[name].attrs.get("units", "1"), sweep[name].attrs.get("long_name", ""), values, names))
    measures = [(name, variable.attrs.get("units", "1"), variable.attrs.get("long_name", ""),
                 np.ascontiguousarray(variable.transpose(*dimensions).values).ravel(), [])
                for name, variable in sweep.data_vars.items()
                if variable.dtype == np.float64 and {*variable.dims} == {*dimensions}]
    notes = sweep["notes"].transpose(*dimensions).values.ravel().tolist() if "notes" in sweep else []
    return axes, measures, sweep["state"].values.ravel().tolist(), sweep.sizes["replicate"], notes

"""Reads what can be drawn: a figure, or a trace or a sweep as one."""
import json

from .figure_file import SCHEMA, Figure, open_file, read_figure, text
from .plot_error import PlotError
from .results import trace_panels
from .sweeps import left_out, sweep_panels
from .typeset import capitalised, without_json

TRACE, SWEEP = "remote-touch-trace/3", "remote-touch-sweep/3"


def title_of(file, path):
    """That of the experiment or sweep, else the command that made the file."""
    try:
        title = json.loads(text(file.attrs, "config")).get("title")
    except (ValueError, AttributeError, RecursionError):
        title = None
    has_title = isinstance(title, str) and title.strip()
    return without_json(capitalised(title)) if has_title else text(file.attrs, "command") or path.name


def read_drawable(path, wanted=()):
    """A figure, or a trace or a sweep as one. wanted: slices of a sweep, as pairs of an axis and a value."""
    with open_file(path) as file:
        schema = text(file.attrs, "schema")
        if wanted and schema != SWEEP:
            raise PlotError(f"{path}: --slice is for sweeps, this is {schema!r}")
        if schema in (TRACE, SWEEP):
            panels = sweep_panels(file, wanted) if schema == SWEEP else trace_panels(file)
            heading = title_of(file, path) + (left_out(file, wanted) if schema == SWEEP else "")
            return Figure(path.stem, {name: text(file.attrs, name) for name in file.attrs} | {"heading": heading}, panels)
    if schema.startswith("remote-touch-tally/"):
        raise PlotError(f"{path}: is a tally: expected a figure, which `remote-touch analyse {path} -o FILE.h5` makes of it")
    if schema != SCHEMA:
        raise PlotError(f"{path}: schema {schema!r}: expected a figure, a trace or a sweep of this program")
    return read_figure(path)

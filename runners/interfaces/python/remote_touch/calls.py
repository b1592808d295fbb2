"""What the commands of remote-touch do, as functions."""
from __future__ import annotations

import json
import operator
import os
from builtins import list as _list  # list is a function of this file, below
from typing import TYPE_CHECKING

from remote_touch import _core
from remote_touch._core import InputError
from remote_touch.classes import Renderer, identify, name_of

if TYPE_CHECKING:  # what only types need: xarray takes most of a second
    from collections.abc import Callable, Iterable, Mapping
    from concurrent.futures import Executor
    from typing import Any, Literal, Union

    import xarray
    _Path = Union[str, os.PathLike[str]]
    _Progress = Union[None, bool, Callable[[float], object]]



def run(experiment: _Path | dict[str, Any], *, seed: int | None = None, set: Mapping[str, Any] | None = None,
        output: _Path | None = None, force: bool = False, timing: bool = False, progress: _Progress = None) -> xarray.Dataset:
    """Runs an experiment; returns its trace as an xarray.Dataset over time.

    experiment: a name, a path of a JSON file, or a dict. set: settings by path, {"scenario.noise_sigma_m": 0.003};
    a registered class stands for its name. seed: set["seed"]. output: also writes the file that the command
    `remote-touch run` writes, over an existing result, or with force over anything. timing: also the time of each tick.
    progress: True for a line on standard error, or a function that takes the fraction that is done.

    Measures that summarise the run, such as max_force, are variables without dimension. Attributes are those of the
    file: config, command, recipe, version, digest and so on.
    """
    from remote_touch import dataset
    identify()
    subject, text = _subject(experiment)
    result = _core.run(subject, text, _overrides(set, seed), _path(output), bool(force), bool(timing),
                       _report(progress, subject))
    return dataset.of_trace(result)


def sweep(sweep: _Path | dict[str, Any], *, set: Mapping[str, Any] | None = None, threads: int | None = None,
          output: _Path | None = None, progress: _Progress = None, executor: Executor | None = None,
          chunk: int | None = None) -> xarray.Dataset:
    """Does all runs of a sweep; returns the measures as an xarray.Dataset over its axes and replicate.

    sweep: a name, a path of a JSON file, or a dict. set: settings of the sweep or of its experiment, by path. threads:
    of all processors if None; the result does not depend on it. output: a file that goes on where an interrupted call
    stopped. Failed runs are NaN, with their reason in the variable error, and a warning. A sweep that keeps a tally needs an
    output; its variables count the runs of each cell, and have the mean, standard_deviation, least and greatest of each measure.

    executor: a concurrent.futures.Executor, whose workers do the runs, one thread each, and this process the file `output`.
    chunk: runs that a worker does in one call; None: as many as take about a second. The attributes checked_runs and
    checked_by_another_worker count the runs that were made twice. Raises concurrent.futures.BrokenExecutor if the executor
    does no more work, and RuntimeError if a run made twice differs; the same call continues.
    """
    from remote_touch import dataset
    identify()
    subject, text = _subject(sweep)
    if executor is not None:
        return dataset.warned(_sweep_by(executor, chunk, subject, text, set, threads, output, progress), os.fsdecode(subject))
    if chunk is not None:
        raise InputError(f"chunk = {chunk!r}: expected an executor, too")
    result = _core.sweep(subject, text, _overrides(set), _threads(threads), _path(output), _report(progress, subject))
    return dataset.warned(dataset.of_sweep(result), os.fsdecode(subject))


def _sweep_by(executor, chunk, subject, text, set, threads, output, progress):
    import concurrent.futures
    if not isinstance(executor, concurrent.futures.Executor):
        raise InputError(f"executor = {executor!r}: expected a concurrent.futures.Executor, such as client.get_executor() of Dask")
    if threads is not None or output is None:
        raise InputError("executor: expected no threads, since each worker uses one, and an output, which keeps the runs when a "
                         "worker is lost")
    from remote_touch import chunks, dataset
    chunk = None if chunk is None else _integer("chunk", chunk, 1, 10**7)
    engine = chunks.Engine(executor, chunk, os.fspath(output), _report(progress, subject))
    sweep = dataset.of_sweep(_core.sweep_in_chunks(subject, text, _overrides(set), _path(output), engine.do_round))
    sweep.attrs.update(checked_runs=engine.checked, checked_by_another_worker=engine.checked_by_another)
    return sweep


def replay(sweep: _Path | xarray.Dataset, *, cell: Iterable[int] | Mapping[str, Any] | str | int, replicate: int = 0,
           output: _Path | None = None, force: bool = False, progress: _Progress = None) -> xarray.Dataset:
    """Repeats one run of a sweep as a full trace. sweep: a file, or what sweep() returned.

    cell: the place on each axis from 0, as a tuple, or the value of each axis, as a dict. replicate: its place. In a data set
    of which parts were selected, places are those in the selection, of the axes that it still has. output: as of run().
    """
    from remote_touch import dataset
    identify()
    file, attributes = "", []
    if isinstance(sweep, (str, os.PathLike)):
        file = _native(sweep)
    elif "config" in getattr(sweep, "attrs", {}):
        attributes = [(name, value) for name, value in sweep.attrs.items() if isinstance(value, str)]
        cell, replicate = dataset.run_in(sweep, cell, replicate)
    else:
        raise InputError(f"{type(sweep).__name__}: expected a file, or what rt.sweep returned")
    result = _core.replay(file, attributes, _cell(cell), _integer("replicate", replicate, 0, 2**31 - 1), _path(output),
                          bool(force), _report(progress, "replay"))
    return dataset.of_trace(_warned(result, file))


def analyse(sweep: _Path | xarray.Dataset, *, limit: str | None = None, along: str | None = None, above: float = 0.5,
            level: float = 0.5, mean: str | Iterable[str] = (), by: str | Iterable[str] = (),
            difference: str | Iterable[str] = (), between: str | None = None,
            direction: Literal["rises", "falls"] | None = None) -> dict[str, xarray.Dataset]:
    """Answers questions about a sweep; returns tables as a dict of Datasets: limits, mean_MEASURE, difference_MEASURE, and
    limit_difference and limit_ratio.

    sweep: a file, or what sweep() returned. limit: the measure of an event, which happens above the value `above`: where
    along the axis `along` does it become more probable than `level`? mean: measures whose means are wanted, by the axes
    `by` (all if empty). difference: measures whose differences between the first and each other value of the axis
    `between` are wanted; with `limit` and `between`, also the differences and ratios of the limits. direction: "rises" if
    the event becomes more probable along the axis, "falls" if less; None: as the runs show it. Without a question: the limit
    of the first measure of an event, and all means. The intervals are of 95 %.
    """
    from remote_touch import dataset
    file, parts, config = b"", (), "{}"
    if isinstance(sweep, (str, os.PathLike)):
        file = _native(sweep)
    else:
        parts, config = dataset.parts_of_sweep(sweep), str(sweep.attrs.get("config", "{}"))
    result = _core.analyse(file, parts, config, _name(limit), _name(along), _number("above", above), _number("level", level),
                           _names(mean), _names(by), _names(difference), _name(between), _name(direction))
    return dataset.of_figure(_warned(result, file))


def open(path: _Path) -> Any:
    """Reads a result: a trace, a sweep or a tally as a Dataset; a figure or a scorecard as a dict of Datasets, its tables.

    A folder of a scorecard stands for the file scorecard.h5 in it. Warns if some runs are known to be wrong, or are left out because
    their checksum is wrong.
    """
    from remote_touch import dataset
    file = _native(path)
    if os.path.isdir(file):
        file = os.path.join(file, b"scorecard.h5")
    result = _warned(_core.open(file), file)
    made = {"trace": dataset.of_trace, "sweep": dataset.of_sweep, "tally": dataset.of_tally, "figure": dataset.of_figure}
    return made[result["kind"]](result)


def _warned(result, file):
    """Returns the result, after a warning if some runs in the file are known to be wrong or are left out."""
    if result.get("warning"):
        import warnings
        warnings.warn(f"{os.fsdecode(file) or 'the data set'}: {result['warning']}", stacklevel=3)
    return result


class Comparison:
    """The comparison of two results. str() is what `remote-touch compare` prints.

    outcome: "same"; "regressed": a measure got worse; "changed": different, and no measure is shown to be worse;
    "not comparable": also where there are too few runs to decide.
    """

    outcome: Literal["same", "regressed", "not comparable", "changed"]

    def __init__(self, outcome: int, text: str, report: dict[str, Any]) -> None:
        self.outcome = {0: "same", 1: "regressed", 2: "not comparable", 4: "changed"}[outcome]
        self.text, self.report = text, report

    @property
    def same(self) -> bool:
        """Whether all values are within their tolerances."""
        return self.outcome == "same"

    @property
    def differences(self) -> _list[str]:
        """The names of columns or measures of which a value is outside."""
        parts = self.report.get("columns") or self.report.get("sweep", {}).get("measures") or []
        return [part["name"] for part in parts if part.get("outside") or part.get("problem")]

    @property
    def judgements(self) -> dict[str, str]:
        """{"popped_through": "better", ...}: equal, within_margin, better, worse, changed or undecided, of every measure
        of sweeps, and of traces that differ."""
        measures = self.report.get("measures") or self.report.get("sweep", {}).get("measures") or []
        return {measure["name"]: measure["judgement"] for measure in measures}

    def __str__(self):
        return self.text

    def __repr__(self):
        return f"<Comparison: {self.outcome}>"


def compare(baseline: _Path | xarray.Dataset, candidate: _Path | xarray.Dataset, *,
            tolerance: Mapping[str, float | tuple[float, float]] | None = None, paired: bool = False) -> Comparison:
    """Compares two results: files, or Datasets of traces. tolerance: {"force": 1e-9} or {"force": (1e-9, 1e-6)},
    absolute and relative; "*" is every column. All else must be equal bit for bit."""
    tolerances = {_native(name): _tolerance(name, value) for name, value in _items("tolerance", tolerance)}
    if isinstance(baseline, (str, os.PathLike)) and isinstance(candidate, (str, os.PathLike)):
        return _comparison(_core.compare_files(_native(baseline), _native(candidate), tolerances, bool(paired)))
    from remote_touch import dataset
    sides = []
    for side in (baseline, candidate):
        sides += dataset.columns_of(open(side) if isinstance(side, (str, os.PathLike)) else side)
    return _comparison(_core.compare_columns(*sides, tolerances))


def describe(name: str) -> str:
    """All that has the name, as text: parameters of a renderer, the configuration of an experiment, and so on."""
    return _core.describe(_native(name))


def list() -> dict[str, dict[str, str]]:
    """Names and summaries by kind: rt.list()["renderers"]["proxy"]."""
    return _core.list()


def scorecard(methods: Iterable[_Path | type[Renderer]] = (), *, scenes: Iterable[_Path] = (), seeds: int = 10, output: _Path,
              threads: int | None = None, progress: _Progress = None) -> dict[str, xarray.Dataset]:
    """Compares methods on many scenes; returns the tables of the scorecard as a dict of Datasets.

    methods: names, JSON files, dicts {"title", "renderer"} by name, or registered renderer classes; empty: all. scenes:
    names or JSON files; empty: all that fit. output: a folder, which goes on where an interrupted call stopped. The
    page of it: scripts/plot FOLDER.
    """
    import tempfile
    import warnings
    identify()
    folder = _native(output)
    with tempfile.TemporaryDirectory() as files:
        names = [_method(method, files) for method in methods]
        failed, first = _core.scorecard(names, [_native(scene) for scene in scenes], _integer("seeds", seeds, 1, 10**6), _threads(threads), folder,
                                        _report(progress, "scorecard"))
    if failed:
        warnings.warn(f"{os.fspath(output)}: {failed} runs failed, the first: {first}", stacklevel=2)
    return open(output)


def _method(method, folder):
    if isinstance(method, (str, os.PathLike)):
        return _native(method)
    if not (isinstance(method, type) and issubclass(method, Renderer)):
        raise InputError(f"method {method!r}: expected a name, a JSON file or a registered class of a renderer")
    name = name_of(method)
    file = os.path.join(folder, name + ".json")
    with _open_text(file) as out:
        json.dump({"title": f"{method.__name__}, in Python", "renderer": {"name": name}}, out)
    return file


def _open_text(file):
    import io
    return io.open(file, "w", encoding="utf-8")


def _name(name):
    return b"" if name is None else _native(name)


def _names(names):
    """A name stands for a list of it."""
    return [_native(name) for name in ([names] if isinstance(names, str) else names)]


def _number(name, value):
    try:
        return float(value)
    except (TypeError, ValueError):
        raise InputError(f"{name} = {value!r}: expected a number") from None


def _native(text):
    """A text or path as bytes: a file may have a name that is no UTF-8."""
    if not isinstance(text, (str, os.PathLike)):
        raise InputError(f"{text!r}: expected a text or a path")
    try:
        return os.fsencode(text)
    except UnicodeEncodeError:
        raise InputError(f"{text!r}: expected text that can be written as UTF-8") from None


def _subject(given):
    """The name of what is run, and its JSON text if it is a dict."""
    if isinstance(given, dict):
        return b"configuration", _json(given)
    if isinstance(given, (str, os.PathLike)):
        return _native(given), None
    raise InputError(f"{given!r}: expected a name, a path or a dict")


def _plain(value):
    """What JSON does not know: numbers and arrays of NumPy, classes."""
    if isinstance(value, type):
        return name_of(value)
    if hasattr(value, "tolist"):
        return value.tolist()
    raise InputError(f"{value!r}: expected a number, a text, a list or a dict")


def _json(value, subject=""):
    try:
        return json.dumps(value, default=_plain, allow_nan=False)
    except InputError:
        raise
    except (TypeError, ValueError, RecursionError) as error:  # of a key, NaN, a circle
        raise InputError(f"{subject}{type(value).__name__}: {error}: expected finite numbers, texts, lists or dicts "
                         "with texts as keys") from None


def _overrides(given, seed=None):
    """As --set takes them."""
    pairs = [*_items("set", given)]
    if seed is not None:
        pairs.append(("seed", seed))
    return [_native(f"{path}={_setting(value, path)}") for path, value in pairs]


def _text(value, path):
    value = name_of(value) if isinstance(value, type) else value
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    return _json(value, f"{path} = ")


def _setting(value, path):
    """A text stays a text, also one that reads as another value of JSON, such as "1"."""
    text = _text(value, path)
    if isinstance(value, str):
        try:
            json.loads(text)
        except ValueError:
            return text
        return _json(value)
    return text


def _path(output):
    return b"" if output is None else _native(output)


def _cell(cell):
    if isinstance(cell, dict):
        return _native(",".join(f"{name}={_text(value, name)}" for name, value in cell.items()))
    if isinstance(cell, str):
        return cell.encode("utf-8", "replace")
    places = cell if hasattr(cell, "__iter__") else (cell,)
    return ",".join(str(_integer("cell", place, 0, 2**31 - 1)) for place in places)


def _items(name, given):
    """Of a dict, or none of None."""
    if given is not None and not hasattr(given, "items"):
        raise InputError(f"{name} = {given!r}: expected a dict")
    return given.items() if given is not None else ()


def _integer(name, value, low, high):
    try:
        number = operator.index(value)
    except TypeError:
        raise InputError(f"{name} = {value!r}: expected an integer") from None
    if not low <= number <= high:
        raise InputError(f"{name} = {number}: expected {low} to {high}")
    return number


def _threads(threads):
    return 0 if threads is None else _integer("threads", threads, 1, 4096)


def _tolerance(name, value):
    pair = tuple(value) if isinstance(value, (tuple, _list)) else (value, 0.0)
    if len(pair) != 2 or not all(isinstance(part, (int, float)) and 0 <= part < float("inf") for part in pair):
        raise InputError(f"tolerance {name} = {value}: expected a number of 0 or more, or two: absolute and relative")
    return float(pair[0]), float(pair[1])


def _comparison(result):
    outcome, text, report = result
    return Comparison(outcome, text, json.loads(report))


def _report(progress, subject):
    """None, or a function of the fraction."""
    if progress is None or progress is False:
        return None
    if callable(progress):
        return progress
    import sys
    name = subject if isinstance(subject, str) else os.fsdecode(subject)

    def line(fraction):
        end = "\n" if fraction >= 1 else ""
        sys.stderr.write(f"\r{name}: {100 * fraction:3.0f} %{end}")
        sys.stderr.flush()
    return line

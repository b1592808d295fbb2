"""Studies: runs of the program, tables of numbers, claims about them, and pictures.

    import sys
    from remote_touch.studies import line, main, study

    @study("soft-wall", "how deep the proxy sinks, over the stiffness", title="A soft wall",
           caption="Depth of the HIP over the stiffness. Simulated.")
    def soft_wall(s):
        runs = s.grid({"stiffness": [200, 400, 800]}, lambda c: ("fig4.11", {"renderer.stiffness_N_per_m": c.stiffness}),
                      {"force": lambda run: run.norm("force").max()})
        s.table("forces", "largest force", stiffness=(runs.stiffness, "N/m", "stiffness"), force=(runs.force, "N", "largest force"))
        s.panel("Largest force", "stiffness (N/m)", "force (N)", [line("forces", "stiffness", "force")])
        s.claims("a soft wall: ").at_most("the force is limited: largest force", runs.force.max(), 20, "N")

    if __name__ == "__main__":
        sys.exit(main())

Such a file, called with -o FOLDER, writes FOLDER/figsoft-wall.h5, the claims in FOLDER/claims.json, and pictures with a page,
FOLDER/index.html: the same files as `remote-touch figure` and scripts/plot. The page "Write a study" leads through it.
"""
from __future__ import annotations

import argparse
import collections
import concurrent.futures
import contextlib
import dataclasses
import itertools
import json
import math
import os
import pathlib
import re
import shlex
import sys
import tempfile
import traceback

import numpy as np

from remote_touch import _core
from remote_touch._core import InputError, MissingInput
from remote_touch.calls import _integer, _overrides, _subject

STUDIES = {}  # name -> Entry, of all files that were imported


@dataclasses.dataclass(frozen=True)
class Entry:
    """A study as it was declared with @study."""
    name: str
    summary: str
    make: object
    defaults: dict
    quick_coarse: int  # value of coarse for a quick study
    file: str
    takes_settings: bool = False


def study(name, summary, *, title="", caption="", source="the dissertation", quick_coarse=1,
          takes_settings=False):
    """Declares the function below as a study. It receives a Study, and calls its methods.

    name: a word for files and commands. summary: one line for lists. title, caption, source: of the figure; the function may
    set them as s.title and so on. source: where the values come from that claims compare with. quick_coarse: a quick study uses
    every nth value of the axes of Study.map(); this is n. takes_settings: it reads s.overrides, the settings of the caller.
    """
    if not re.fullmatch(r"[a-z0-9][a-z0-9.-]*", name) or name in _core.list()["figures"]:
        raise InputError(f"study {name!r}: expected small letters, digits, - and ., and no name of a figure of the program")

    def declare(make):
        file = make.__globals__.get("__file__", "")
        known = STUDIES.get(name)
        if known and (known.file, known.make.__name__) != (file, make.__name__):
            raise InputError(f"study {name}: declared twice, in {known.file} and in {file}")
        STUDIES[name] = Entry(name, summary, make, {"title": title, "caption": " ".join(caption.split()), "source": source},
                              quick_coarse, file, takes_settings)
        return make
    return declare


class Run:
    """The trace of a run: run.force is the array of the column force, one row for each tick.

    config: the resolved configuration as a dict; config_text: as the program writes it. measures: {"max_force": 1.2}. units,
    value_names: of each column.
    """

    def __init__(self, config, columns, measures, notes):
        self.config, self.config_text = json.loads(config), config
        self.columns = {name: values for name, _, _, values, _ in columns}
        self.units = {name: units for name, units, _, _, _ in columns}
        self.value_names = {name: names for name, _, _, _, names in columns if names}
        self.measures = {name: float(values[0]) for name, _, _, values, _ in measures}
        self.notes = notes  # a bit for each kind

    def __getattr__(self, name):
        try:
            return self.__dict__["columns"][name]
        except KeyError:
            raise AttributeError(f"the trace has no column {name!r}: it has {', '.join(self.__dict__.get('columns', ()))}") from None

    def __len__(self):
        return len(self.columns["time"])

    def norm(self, name):
        """The length of a vector in each tick."""
        return np.linalg.norm(getattr(self, name), axis=1)

    def is_(self, name, value_name):
        """Whether a column of names, such as state, has this value, in each tick."""
        names = self.value_names.get(name, [])
        if value_name not in names:
            raise AttributeError(f"{name} is never {value_name!r}: it is {', '.join(names) or 'a column of numbers'}")
        return self.columns[name] == names.index(value_name)

    def frame_updates(self):
        """The ticks in which the renderer has another frame than in the tick before."""
        return np.flatnonzero(np.diff(self.columns["frame_index"])) + 1


class Rows(dict):
    """Columns of equal length: rows.delay and rows["delay"] are arrays."""

    def __getattr__(self, name):
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"no column {name!r}: there is {', '.join(self)}") from None

    def __len__(self):
        return len(next(iter(self.values()))) if self.keys() else 0

    def where(self, **values):
        """The rows in which these columns have these values, to rounding: rows.where(delay=0.1). There must be one."""
        chosen = np.ones(len(self), dtype=bool)
        for name, value in values.items():
            column = getattr(self, name)
            chosen &= np.isclose(column, value, rtol=1e-9, atol=0) if column.dtype.kind == "f" else column == value
        if not chosen.any():
            raise InputError(f"no row has {', '.join(f'{name} = {value}' for name, value in values.items())}")
        return Rows({name: column[chosen] for name, column in self.items()})


def product(axes):
    """All combinations of the values of the axes, as objects with a member for each axis; the last axis runs fastest."""
    cell = collections.namedtuple("Cell", axes)
    return [cell(*values) for values in itertools.product(*axes.values())]


@dataclasses.dataclass(frozen=True)
class Curve:
    """A curve of a panel: the name of a table, and of its columns. z: of colours, heights, or the other end of an interval."""
    table: str
    x: str
    y: str
    style: str
    label: str = ""
    z: str = ""
    radius: float = 0.0


def curve(style):
    """The function that makes curves of a style: curve("band")("table", "x", "y", "label", z="z")."""
    def make(table, x, y, label="", z="", radius=0.0):
        return Curve(table, x, y, style, label, z, radius)
    return make


# steps: each value lasts until the next. bars: from 0. circle: of this radius, in units of the axes. squares: filled cells of a
# map. intervals: bars from y to z, in the colour of the next curve; an infinite end is an arrow. band: the area between y and z.
# color_map: cells coloured by z. image: pixels of the colour z = 0xRRGGBB. surface: heights z over (x, y), alone in its panel.
# letters: a line at x with the name of the value of z above. Dots whose x is NaN throughout stand on the right edge; few samples
# beyond y_range are marked at the end of the axis.
line, dots, dashed, steps, bars, circle, squares, intervals, band, color_map, image, surface, letters = map(curve, (
    "line", "dots", "dashed", "steps", "bars", "circle", "squares", "intervals", "band", "map", "image", "surface", "letters"))


class Claims:
    """Adds claims to a study. A text is a sentence, a colon and what was measured; NaN fails.

    paper: the value of the source as text.
    """

    def __init__(self, study, opening, of_map, set_up):
        self._study, self._opening, self._of_map, self._set_up = study, opening, of_map, set_up

    def at_most(self, text, measured, limit, unit="1", paper="-"):
        self._add("at most", text, measured, limit, limit, unit, paper)

    def at_least(self, text, measured, limit, unit="1", paper="-"):
        self._add("at least", text, measured, limit, limit, unit, paper)

    def between(self, text, measured, low, high, unit="1", paper="-"):
        self._add("between", text, measured, low, high, unit, paper)

    def agrees(self, text, measured, expected, standard_error, limit=3.3, paper="-"):
        """At most so many standard errors apart: chance alone exceeds 3.3 once in a thousand comparisons."""
        apart = abs(measured - expected) / standard_error if standard_error > 0 else math.nan
        self._add("at most", text, apart, limit, limit, "standard errors", paper)

    def differs(self, text, measured, low, high, unit="1", paper="-"):
        """The source has another value; low to high is the known range here."""
        self._add("differs", text, measured, low, high, unit, paper)

    def _add(self, kind, text, measured, low, high, unit, paper):
        made = _core.claim(kind, self._study.name, self._opening + text, paper, float(measured), float(low), float(high), unit)
        made.source, made.of_map, made.set_up = self._study.source, self._of_map, self._set_up
        self._study.all_claims.append(made)


class Study:
    """What a study function receives: it makes runs, and collects tables, panels and claims.

    coarse: map() uses every coarse-th value of the axes. executor: any concurrent.futures.Executor makes the runs; None:
    threads of this process. The numbers depend on neither. overrides: the settings "path=value" of the caller.
    """

    def __init__(self, entry, coarse=1, executor=None, overrides=()):
        self.name, self.coarse, self.executor = entry.name, coarse, executor
        self.overrides = [*overrides]
        self.title, self.caption, self.source = (entry.defaults[name] for name in ("title", "caption", "source"))
        self.folder = pathlib.Path(entry.file).parent  # with the experiments and sweeps of the study
        self.tables, self.panels, self.all_claims = [], [], []
        self.runs_of_maps = self.made_runs_of_maps = 0
        self._core, self._configs = _core.StudyRuns(), []

    # --- runs ---

    def run(self, experiment, set=None):
        """The Run of an experiment: a name, a path or a dict, and settings by path, as of remote_touch.run()."""
        return self.runs([(experiment, set)])[0]

    def runs(self, jobs):
        """The Runs of several experiments (experiment, settings), side by side, in their order."""
        made = self._side_by_side(jobs, lambda run, i: run)
        self._configs += [run.config_text for run in made]
        return made

    def measure(self, jobs, of):
        """of(run) for each of many runs; no run is kept. Of their configurations the file has the first."""
        made = self._side_by_side(jobs, lambda run, i: (run.config_text, of(run)))
        self._configs += [config for config, _ in made[:1]]
        return [value for _, value in made]

    def grid(self, axes, task, columns):
        """Rows with the axes and columns of a grid of runs; the last axis runs fastest.

        axes: {"delay": [0, 0.1]}. task(cell): the (experiment, settings) of a cell, which has a member for each axis.
        columns: {"force": function of a run, or of a run and its cell}. Of the configurations the file has the first.
        """
        if {*axes} & {*columns}:
            raise InputError(f"study {self.name}: {min({*axes} & {*columns})} is an axis and a column")
        cells = product(axes)
        functions = [_of_run_and_cell(function) for function in columns.values()]
        made = self._side_by_side([task(cell) for cell in cells],
                                  lambda run, i: (run.config_text, [function(run, cells[i]) for function in functions]))
        self._configs += [config for config, _ in made[:1]]
        rows = Rows({name: np.array([getattr(cell, name) for cell in cells]) for name in axes})
        rows.update({name: np.array([values[i] for _, values in made]) for i, name in enumerate(columns)})
        return rows

    def _side_by_side(self, jobs, of):
        """of(run, number of the job) for each job, in their order."""
        calls = [_call(self.folder, *(job if isinstance(job, tuple) else (job, None))) for job in jobs]
        if self.executor is None:
            with concurrent.futures.ThreadPoolExecutor(_processors()) as threads:
                return [*threads.map(lambda i: of(Run(*self._core.run(*calls[i])), i), range(len(calls)))]
        for call in calls:
            self._core.uses(*call)
        made = []
        for i, result in enumerate(self.executor.map(_run_elsewhere, calls)):
            run = Run(*result)
            self._core.add_notes(run.notes)
            made.append(of(run, i))
        return made

    def sweep(self, sweep, set=None):
        """All runs of a sweep, as the Dataset of remote_touch.sweep(). Raises InputError if a run failed."""
        config, _, _ = self._core.uses_sweep(*_call(self.folder, sweep, set), 1)
        return self._swept(config)

    def map(self, sweep, set=None):
        """A sweep of thousands of runs, of which a coarse study uses a part of the values of each axis."""
        config, made, planned = self._core.uses_sweep(*_call(self.folder, sweep, set), self.coarse)
        self.runs_of_maps += planned
        self.made_runs_of_maps += made
        return self._swept(config)

    def _swept(self, config):
        from remote_touch import dataset
        self._configs.append(config)
        if self.executor is None:
            return dataset.of_sweep(self._core.sweep(config))
        import remote_touch
        with tempfile.TemporaryDirectory() as folder:
            made = remote_touch.sweep(json.loads(config), output=os.path.join(folder, "sweep.h5"), executor=self.executor).load()
        if "error" in made:
            raise InputError(f"{self.name}: a run of a sweep failed")
        for bits in made.notes.values.ravel().tolist():
            self._core.add_notes(bits)
        return made

    def uses(self, experiment, set=None):
        """The resolved configuration of an experiment as a dict; the file of the study records it."""
        config = self._core.uses(*_call(self.folder, experiment, set))
        self._configs.append(config)
        return json.loads(config)

    # --- the figure ---

    def table(self, name, title, columns=None, /, **named):
        """Adds a table. Each column is name=(values, units, long_name); texts may be values. Returns its Rows."""
        if not re.fullmatch(r"[\w.-]+", name) or name in (table[0] for table in self.tables):
            raise InputError(f"study {self.name}: table {name!r}: expected another word for each table")
        rows, listed = Rows(), []
        for column, (values, units, long_name, *names) in {**(columns or {}), **named}.items():
            values = np.ma.filled(np.asanyarray(values), np.nan) if np.ma.isMaskedArray(values) else np.asarray(values)
            if hasattr(Rows, column):
                raise InputError(f"study {self.name}: table {name}: {column}: expected another name of a column")
            if values.ndim != 1 or values.dtype.kind not in "UObiuf" or \
                    values.dtype.kind == "O" and not all(isinstance(value, str) for value in values):
                raise InputError(f"study {self.name}: table {name}: {column}: expected a list of numbers or texts")
            rows[column] = values
            if values.dtype.kind in "UO":
                listed.append((column, units, long_name, [str(value) for value in values], []))
            elif values.dtype in (np.int32, np.uint64):
                listed.append((column, units, long_name, values, names[0] if names else []))
            else:
                listed.append((column, units, long_name, values.astype(float), []))
        if len({len(values) for values in rows.values()}) > 1:
            lengths = ", ".join(f"{column} {len(values)}" for column, values in rows.items())
            raise InputError(f"study {self.name}: table {name}: its columns differ in length: {lengths}")
        self.tables.append((name, title, listed))
        return rows

    def panel(self, title, x_label, y_label, curves, *, at=None, x_range=None, y_range=None, equal_aspect=False, scene=None):
        """Adds a panel of curves. at: (row, column); None: below the panel before.

        scene: a picture in space, drawn instead: a dict with eye, target and up (three numbers each), width_m, height_per_width and
        parts, a list of dicts with kind (points, segments or solid), table, and what ScenePart of result_file.h lists.
        """
        if at is not None and not (len(at) == 2 and min(at) >= 0):
            raise InputError(f"study {self.name}: panel {title!r}: at = {at}: expected (row, column), 0 or more")
        self.panels.append({"title": title, "x_label": x_label, "y_label": y_label, "at": at, "x_range": x_range,
                            "y_range": y_range, "equal_aspect": equal_aspect, "scene": scene,
                            "curves": [dataclasses.asdict(each) for each in curves]})

    def place_in_rows(self, columns):
        """Places the panels in rows of so many columns."""
        for i, panel in enumerate(self.panels):
            panel["at"] = (i // columns, i % columns)

    def claims(self, opening="", *, of_map=False, set_up=False):
        """Adds claims whose texts begin with the opening. of_map: about a whole map, so a part of it leaves them open.
        set_up: checks of the set-up only."""
        return Claims(self, opening, of_map, set_up)

    # --- the files ---

    def write(self, folder, command):
        """Writes figNAME.h5, and the claims into claims.json of the folder."""
        if self.made_runs_of_maps < self.runs_of_maps:
            self.caption += _core.coarse_text(self.made_runs_of_maps, self.runs_of_maps, self.coarse)
            for claim in self.all_claims:
                if claim.of_map:
                    claim.leave_open()
        self._require_columns()
        folder, entry = pathlib.Path(folder), STUDIES.get(self.name)
        origin = self._core.origin("[" + ", ".join(self._configs) + "]", command)
        _core.write_figure(str(folder / f"fig{self.name}.h5"), self.name, self.title, self.caption, self.tables,
                           json.dumps(self.panels, default=float),
                           [*origin, ("summary", entry.summary), ("study", f"{os.path.basename(entry.file)}: sha256 {_sha256(entry.file)}")])
        for suffix in ("png", "svg", "pdf"):  # of an earlier call
            (folder / f"fig{self.name}.{suffix}").unlink(missing_ok=True)
        _write_claims(folder, self.name, self.all_claims)
        return self._core.note_lines()

    def _require_columns(self):
        """Every curve has its table and columns of numbers."""
        tables = {name: {column: values for column, _, _, values, _ in columns} for name, _, columns in self.tables}
        for panel in self.panels:
            for each in panel["curves"]:
                for column in (each["x"], each["y"], *filter(None, [each["z"]])):
                    if isinstance(tables.get(each["table"], {}).get(column, []), list):
                        raise InputError(f"study {self.name}: panel {panel['title']!r}: a curve asks for {each['table']}/{column}: "
                                         "expected a column of numbers of one of its tables")
            for part in (panel["scene"] or {}).get("parts", ()):
                if part["table"] not in tables:
                    raise InputError(f"study {self.name}: panel {panel['title']!r}: a scene asks for table {part['table']!r}")


def _sha256(file):
    import hashlib
    return hashlib.sha256(pathlib.Path(file).read_bytes()).hexdigest() if os.path.isfile(file) else "unknown"


def _of_run_and_cell(function):
    """A column may be a function of the run alone."""
    import inspect
    needed = [each for each in inspect.signature(function).parameters.values() if each.default is each.empty]
    return function if len(needed) > 1 else lambda run, cell: function(run)


def _processors():
    return len(os.sched_getaffinity(0))


def _call(folder, subject, set):
    """The arguments of a run in C++. The name of a file beside the study stands for the file."""
    if isinstance(subject, str) and (folder / f"{subject}.json").exists():
        subject = folder / f"{subject}.json"
    return (*_subject(subject), _overrides(set))


def _run_elsewhere(call):
    """A run in a worker of an executor."""
    return _core.StudyRuns().run(*call)


def _write_claims(folder, name, claims):
    order = [*_core.list()["figures"], *sorted(STUDIES)]
    _core.replace_claims(str(folder / "claims.json"), order, name, claims)


def make(name, folder, *, coarse=1, quick=False, executor=None, set=(), command=None):
    """Makes a declared study; writes its files into the folder. Returns its Study, with all_claims.

    A study whose recording is missing is written as not run, unless settings named it. command: recorded in the file.
    """
    _chosen([name])
    if isinstance(set, str) or hasattr(set, "items"):
        raise InputError(f"set = {set!r}: expected a list of texts, PATH=VALUE")
    entry = STUDIES[name]
    if set and not entry.takes_settings:
        raise InputError(f"study {name} --set {set[0]}: this study takes no settings")
    coarse = max(_integer("coarse", coarse, 1, 10), entry.quick_coarse if quick else 1)
    _require_folder(pathlib.Path(folder), name)
    made = Study(entry, coarse, executor, set)
    try:
        entry.make(made)
    except MissingInput as missing:
        if made.overrides:
            raise  # what is missing is of the user
        made = Study(entry, coarse)
        made.title, made.caption = "Not run", f"Not run: {missing}"
        made.all_claims = [_core.claim_not_run(name, entry.summary, str(missing))]
    made.notes = made.write(folder, command or _command(entry, coarse, made.overrides))
    return made


def _require_folder(folder, name):
    """Refuses to replace what is no result, before any run."""
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder}: is no folder")
    folder.mkdir(parents=True, exist_ok=True)
    _core.require_result(str(folder / f"fig{name}.h5"))
    claims = folder / "claims.json"
    if claims.exists() and claims.stat().st_size > 0:
        try:
            known = json.loads(claims.read_text())
        except ValueError:
            known = None
        if not (isinstance(known, list) and all(isinstance(claim, dict) and "figure" in claim for claim in known)):
            raise InputError(f"{claims}: is no list of claims of this program: expected another folder")


def _command(entry, coarse, overrides):
    """The command of a study of the project, or the call of a file of a user."""
    is_own = pathlib.Path(entry.file).parent.parent.parts[-2:] == ("data", "studies")
    words = ["scripts/studies" if is_own else f"python3 {shlex.quote(os.path.basename(entry.file))}", shlex.quote(entry.name)]
    words += [f"--coarse {coarse}"] * (coarse > 1) + [f"--set {shlex.quote(each)}" for each in overrides]
    return " ".join(words)


def _options(arguments):
    parser = argparse.ArgumentParser(description="Makes studies: figure files, claims, pictures and a page.")
    parser.add_argument("names", nargs="*", metavar="NAME", help="names of studies (default: all of the files)")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("out/studies"), help="a folder (default: out/studies)")
    parser.add_argument("--list", action="store_true", help="print the names and end")
    parser.add_argument("--quick", action="store_true", help="use a part of the values of each axis of maps that take minutes")
    parser.add_argument("--coarse", type=int, default=1, metavar="N", help="use every Nth value of each axis of maps, 1 to 10")
    parser.add_argument("--set", action="append", default=[], metavar="PATH=VALUE", help="a setting, for studies that take settings")
    parser.add_argument("--processes", type=int, metavar="N", help="make the runs in N processes (default: in threads)")
    parser.add_argument("--format", choices=("png", "svg", "pdf"), default="png", help="of the pictures (default: png)")
    parser.add_argument("--no-pictures", action="store_true", help="write no pictures and no page")
    return parser.parse_args(arguments)


def _chosen(names):
    for name in names:
        if name not in STUDIES:
            raise InputError(f"study {name}: unknown: expected one of {', '.join(sorted(STUDIES))}")
    return names or sorted(STUDIES)


def _make_all(options):
    """Whether every claim held."""
    failed = False
    with _executor(options.processes) as executor:
        for name in _chosen(options.names):
            made = make(name, options.output, coarse=options.coarse, quick=options.quick, executor=executor, set=options.set)
            print(f"study {name} -> {options.output / f'fig{name}.h5'}", flush=True)
            for claim in made.all_claims:
                print(claim)
                failed |= claim.verdict == "fail"
            for note in made.notes:
                print(f"  note: {note}", flush=True)
    return not failed


@contextlib.contextmanager
def _executor(processes):
    """So many worker processes, which Ctrl-C ends; None: threads."""
    if processes is None:
        yield None
        return
    import multiprocessing
    with concurrent.futures.ProcessPoolExecutor(_integer("processes", processes, 1, 4096), initializer=_leave_interruption,
                                                mp_context=multiprocessing.get_context("spawn")) as workers:
        try:
            yield workers
        except KeyboardInterrupt:
            for worker in multiprocessing.active_children():
                worker.kill()
            raise


def _leave_interruption():
    """Ctrl-C reaches the workers, too; the process that gives them work ends them."""
    import signal
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _draw(folder, format):
    from remote_touch.plotting.folder import plot
    from remote_touch.plotting.plot_error import PlotError
    try:
        plot(folder, folder, format)
    except PlotError as error:
        raise InputError(str(error)) from None


def main(arguments=None):
    """The command line of a file of studies. Exit: 0 made, 1 a claim failed, 2 bad input, 3 interrupted."""
    options = _options(arguments)
    try:
        if options.list:
            print(*(f"{name:24} {STUDIES[name].summary}" for name in sorted(STUDIES)), sep="\n")
            return 0
        held = _make_all(options)
        if not options.no_pictures:
            _draw(options.output, options.format)
    except (InputError, OSError) as error:
        print(f"studies: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("studies: interrupted; what was finished is kept", file=sys.stderr)
        return 3
    except Exception:  # of the code of a study: 1 would say that a claim failed
        traceback.print_exc()
        return 2
    return 0 if held else 1


def _run_files(arguments):
    """Imports the files before "--", then does what main() does with the arguments after it."""
    end = arguments.index("--") if "--" in arguments else len(arguments)
    try:
        for file in map(os.path.abspath, arguments[:end]):
            _import_file(file)
    except (InputError, OSError) as error:
        print(f"studies: {error}", file=sys.stderr)
        return 2
    except Exception:  # of the code of a study: 1 would say that a claim failed
        traceback.print_exc()
        return 2
    return main(arguments[end + 1:])


def _import_file(file):
    import importlib.util
    sys.path.insert(0, os.path.dirname(file))  # a study may import what lies beside it
    spec = importlib.util.spec_from_file_location("study_" + pathlib.Path(file).stem, file)
    if spec is None:
        raise InputError(f"{file}: expected a file of Python, before --")
    module = sys.modules[spec.name] = importlib.util.module_from_spec(spec)  # a dataclass looks for its module there
    spec.loader.exec_module(module)


if __name__ == "__main__":
    from remote_touch import studies  # the module that the files import, which is not the one that runs as a program
    sys.exit(studies._run_files(sys.argv[1:]))

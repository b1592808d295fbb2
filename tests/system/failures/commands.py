"""The commands that write files, each as small as it can be: what it is called with, in a folder that holds its inputs
and an earlier result."""
import dataclasses
import json
import os
import re
import shutil
import struct
import subprocess
import tempfile

import h5py

KINDS = ("allocation", "open", "write", "flush", "rename", "truncate", "remove", "close")
# What a recording is told to lack where the machine was too busy for the loop in its short time: it is whole all the same.
EMPTY = re.compile(rb"has no (ticks|frames): expected a session with some")
LIFT = {"scenario": {"name": "moving-lift"}, "renderer": {"name": "proxy"},
        "trajectory": {"name": "press", "press_at_s": 0, "depth_m": 0.03}, "duration_s": 0.005}

SWEEP = {"title": "three lifts", "experiment": "lift.json",
         "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.015, "count": 3}],
         "replicates": 1, "measures": ["popped_through", "max_penetration"]}
REFINED = {**SWEEP, "title": "two rounds", "replicates": 1,
           "refine": {"budget": 12, "levels": 1, "max_replicates": 2}}


class Tools:
    """The program, the library that fails its calls, and a folder for the trials."""

    def __init__(self, program, library, folder):
        self.program = os.path.realpath(program)
        self.library = os.path.realpath(library)
        self.folder = folder

    def environment(self, folder, counts=None, wish=None, process=None, sites=None, trace=None):
        own = {name: value for name, value in os.environ.items()
               if not name.startswith(("REMOTE_TOUCH_", "SLURM_", "OMPI_", "FAIL_ONCE"))}
        own.update({"LC_ALL": "C", "OMP_NUM_THREADS": "1", "TMPDIR": os.path.join(folder, "tmp"),
                    "REMOTE_TOUCH_CACHE": os.path.join(folder, "cache")})
        given = {"LD_PRELOAD": self.library, "FAIL_ONCE_BELOW": folder, "FAIL_ONCE_COUNTS": counts,
                 "FAIL_ONCE": wish, "FAIL_ONCE_PROCESS": process and str(process), "FAIL_ONCE_SITES": sites,
                 "FAIL_ONCE_TRACE": trace}
        if counts:
            own.update({name: value for name, value in given.items() if value})
        return own

    def call(self, folder, arguments, timeout_s=600, **failing):
        """What it answers, in the folder. None: it did not end in time."""
        try:
            return subprocess.run([self.program, "-q", *arguments], cwd=folder, capture_output=True,
                                  env=self.environment(folder, **failing), timeout=timeout_s)
        except subprocess.TimeoutExpired:
            return None

    def serve(self, place, arguments, counts, trace=None):
        """A program that waits for requests to run these arguments, see fail_once.cpp."""
        environment = {**self.environment(place, counts=counts, trace=trace), "FAIL_ONCE_SERVER": "1"}
        return subprocess.Popen([self.program, "-q", *arguments], cwd=place, env=environment, text=True, bufsize=1,
                                stdin=subprocess.PIPE, stdout=subprocess.PIPE)

    def must(self, folder, arguments):
        done = self.call(folder, arguments)
        if done is None or done.returncode != 0 or done.stderr:
            raise SystemExit(f"remote-touch {' '.join(arguments)}: {done and done.stderr.decode()}")
        return done.stdout.decode()


@dataclasses.dataclass
class Command:
    name: str
    arguments: list
    prepare: object          # prepare(tools, folder)
    result: str              # the file that it writes
    in_progress: bool = False  # an unfinished result is kept and gone on with
    same_bytes: bool = True  # each time
    processes: tuple = (1,)  # whose allocations fail: 1 is the program, 2 the first that it starts


def write_json(folder, name, content):
    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
        json.dump(content, file)


def read(path):
    with open(path, "rb") as file:
        return file.read()


def prepare_run(tools, folder):
    write_json(folder, "lift.json", LIFT)
    tools.must(folder, ["run", "lift.json", "--set", "seed=9", "-o", "out.h5"])


def prepare_sweep(_, folder):
    write_json(folder, "lift.json", LIFT)
    write_json(folder, "sweep.json", SWEEP)


def prepare_refined(_, folder):
    write_json(folder, "lift.json", LIFT)
    write_json(folder, "sweep.json", REFINED)


def done_runs(path):
    """The results of the runs that are finished in a sweep's file, by their number."""
    if not os.path.exists(path):
        return {}
    with h5py.File(path, "r") as file:
        sweep = file["sweep"]
        states = sweep["state"][...].ravel()
        values = [sweep[name][...].ravel() for name in SWEEP["measures"]]
        return {int(run): [struct.pack("d", each[run]) for each in values] for run in (states == 2).nonzero()[0]}


def prepare_continued(tools, folder):
    """A sweep that found no room after its first run."""
    prepare_sweep(tools, folder)
    counts = os.path.join(folder, "counts")
    for call in range(1, 100):
        with open(counts, "wb") as file:
            file.write(bytes(4096))
        tools.call(folder, sweep_arguments(), counts=counts, wish=f"write:{call}:ENOSPC")
        if len(done_runs(os.path.join(folder, "out.h5"))) == 1:
            os.remove(counts)
            return
        if os.path.exists(os.path.join(folder, "out.h5")):
            os.remove(os.path.join(folder, "out.h5"))
    raise SystemExit("no sweep with one finished run")


def sweep_arguments():
    return ["sweep", "sweep.json", "--threads", "1", "-o", "out.h5"]


def prepare_merge(tools, folder):
    prepare_sweep(tools, folder)
    for shard in ("1", "2"):
        tools.must(folder, ["sweep", "sweep.json", "--shard", f"{shard}/2", "-o", f"{shard}.h5"])
    shutil.copy(os.path.join(folder, "1.h5"), os.path.join(folder, "out.h5"))


def bless_arguments(seed):
    return ["baseline", "bless", "lift", "--folder", "stored", "--one-compiler", "--reason", "because",
            "--run", "lift.json", "--set", f"seed={seed}"]


def prepare_bless(tools, folder):
    os.makedirs(os.path.join(folder, "stored"))
    write_json(os.path.join(folder, "stored"), "lift.json", LIFT)
    tools.must(folder, bless_arguments(3))


def prepare_record(tools, folder):
    tools.must(folder, record_arguments())


UNFINISHED = "out.h5.unfinished"


def is_kept(tools, folder):
    """What is wrong with the unfinished recording in the folder; empty: nothing, or there is none. The next recording is
    refused and leaves it, it becomes a recording that runs, and then it is removed."""
    path = os.path.join(folder, UNFINISHED)
    if not os.path.exists(path):
        return ""
    kept = read(path)
    refused = tools.call(folder, record_arguments())
    if refused is None or refused.returncode != 2 or UNFINISHED.encode() not in refused.stderr or read(path) != kept:
        return f"the next recording: {refused and (refused.returncode, refused.stderr[:300])}"
    told = tools.call(folder, ["inspect", UNFINISHED])
    counts = re.search(rb"unfinished, (\d+) ticks and (\d+) frames", told.stdout if told else b"")
    if not counts:
        return f"inspect: {told and (told.returncode, told.stderr[:300])}"
    ticks, frames = (int(count) for count in counts.groups())
    if ticks + frames > 0:
        recovered, again = (os.path.join("tmp", name) for name in ("recovered.h5", "again.h5"))
        for arguments in (["recover", UNFINISHED, "-o", recovered], ["run", recovered, "-o", again]):
            done = tools.call(folder, arguments)
            if done is None or done.returncode != 0 and not EMPTY.search(done.stderr):
                return f"{arguments[0]}: {done and (done.returncode, done.stderr[:300])}"
        for name in (recovered, again):
            if os.path.exists(os.path.join(folder, name)):
                os.remove(os.path.join(folder, name))
    if read(path) != kept:
        return f"{UNFINISHED} was changed"
    os.remove(path)
    return ""


def prepare_export(tools, folder):
    """Over an earlier export of another run."""
    prepare_run(tools, folder)
    tools.must(folder, ["export", "out.h5", "x.csv"])
    tools.must(folder, ["export", "out.h5", "x.mcap"])
    tools.must(folder, ["run", "lift.json", "-o", "out.h5"])


def record_arguments():
    return ["live", "fig4.16", "--duration", "0.05", "--record", "out.h5"]


COMMANDS = [
    Command("run", ["run", "lift.json", "-o", "out.h5"], prepare_run, "out.h5"),
    Command("sweep", sweep_arguments(), prepare_sweep, "out.h5", in_progress=True),
    Command("sweep continued", sweep_arguments(), prepare_continued, "out.h5", in_progress=True),
    Command("sweep refined", sweep_arguments(), prepare_refined, "out.h5", in_progress=True),
    Command("merge", ["merge", "1.h5", "2.h5", "-o", "out.h5"], prepare_merge, "out.h5"),
    Command("bless", bless_arguments(4), prepare_bless, "stored/lift.h5", processes=(1, 2)),
    Command("export csv", ["export", "out.h5", "x.csv"], prepare_export, "x.csv"),
    Command("export mcap", ["export", "out.h5", "x.mcap"], prepare_export, "x.mcap"),
    Command("record", record_arguments(), prepare_record, "out.h5", same_bytes=False),
]


def state_of(folder):
    """Every file below the folder with its bytes, and every folder."""
    state = {}
    for place, folders, files in os.walk(folder):
        below = os.path.relpath(place, folder)
        for name in folders:
            state[os.path.normpath(os.path.join(below, name)) + "/"] = b""
        for name in files:
            state[os.path.normpath(os.path.join(below, name))] = read(os.path.join(place, name))
    return state


def restore(folder, state):
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    for name in sorted(state):
        path = os.path.join(folder, name)
        if name.endswith("/"):
            os.makedirs(path, exist_ok=True)
        else:
            with open(path, "wb") as file:
                file.write(state[name])


class Scene:
    """A command with the files before it, and after it undisturbed."""

    def __init__(self, command, tools):
        self.command, self.tools = command, tools
        folder = tempfile.mkdtemp(dir=tools.folder)
        for name in ("tmp", "cache"):
            os.makedirs(os.path.join(folder, name))
        command.prepare(tools, folder)
        self.before = state_of(folder)
        tools.must(folder, command.arguments)
        self.after = state_of(folder)
        shutil.rmtree(folder)

"""Builds a benchmark, runs it, and keeps the least times of its repetitions."""
import json
import os
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "release"
# Two threads that could work side by side have used this part of their processors, or another program had some of it.
LEAST_SHARE = 0.9


class BenchmarkError(Exception):
    """The benchmarks could not be built, run, read or written."""


def build(target):
    configure = ["cmake", "--preset", "release", "-DBUILD_TESTING=ON", "-DREMOTE_TOUCH_BENCHMARKS=ON"]
    make = ["cmake", "--build", "--preset", "release", "--target", target]
    for command in (configure, make):
        done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
        if done.returncode != 0:
            raise BenchmarkError(f"{done.stdout}\n{' '.join(command)} failed")


class Times:
    """Least time in ns, least counters of time and last other counters of each benchmark, and the names of those whose answers are wrong."""

    def __init__(self):
        self.ns, self.wall_ns, self.counters, self.wrong = {}, {}, {}, []

    def run(self, target, repetitions, min_time_s):
        build(target)
        environment = dict(os.environ)
        environment.setdefault("REMOTE_TOUCH_DATA", str(ROOT.parent / "shared" / "data"))
        # Interleaved, so that a slow spell of the machine does not meet one benchmark alone.
        done = subprocess.run(
            [BUILD / "tests" / target, f"--benchmark_repetitions={repetitions}",
             f"--benchmark_min_time={min_time_s}", "--benchmark_enable_random_interleaving=true",
             "--benchmark_format=json"],
            cwd=ROOT, env=environment, stdout=subprocess.PIPE, text=True, stderr=subprocess.DEVNULL, check=False)
        if done.returncode not in (0, 1):
            raise BenchmarkError(f"{target} ended with {done.returncode}")
        entries = json.loads(done.stdout)["benchmarks"]
        for entry in sorted(entries, key=lambda entry: entry.get("family_index", 0)):
            self.add(entry)

    def add(self, entry):
        name = entry["run_name"]
        if entry.get("error_occurred"):
            self.wrong.append(f"{name}: {entry['error_message']}")
        elif entry["run_type"] == "iteration":
            scale = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}[entry["time_unit"]]
            self.ns[name] = min(self.ns.get(name, float("inf")), entry["cpu_time"] * scale)
            self.wall_ns[name] = min(self.wall_ns.get(name, float("inf")), entry["real_time"] * scale)
            self.counters[name] = entry | {key: min(entry[key], self.counters.get(name, entry)[key]) for key in entry
                                           if key.endswith("_ns") or key.startswith("s_per_")}


class MapTimes:
    """The times of the map of figure 4.13 in the same form: map/STEPS/THREADS/LEVEL and lift/NOISE/LEVEL, the CPU time
    of all threads; lines: as the benchmark printed them."""

    def __init__(self):
        self.ns, self.wall_ns, self.counters, self.wrong, self.lines = {}, {}, {}, [], []

    def run(self, repetitions):
        build("map_benchmark")
        done = subprocess.run([BUILD / "tests" / "map_benchmark", str(repetitions)], stdout=subprocess.PIPE, text=True,
                              check=False)
        if done.returncode not in (0, 1):
            raise BenchmarkError(f"map_benchmark ended with {done.returncode}")
        for line in done.stdout.splitlines():
            self.add(json.loads(line))

    def add(self, line):
        self.lines.append(line)
        if "check" in line and not line["right"]:
            self.wrong.append(line["check"])
        if "lift" in line:
            self.ns[f"lift/{line['lift']}/{line['isa']}"] = 1e9 * line["lift_cpu_s"]
        if "time" not in line:
            return
        name = f"{line['time']}/{line['steps']}/{line['threads']}/{line['isa']}"
        self.ns[name] = 1e9 * line["map_cpu_s"]
        self.counters[name] = line
        if line["map_cpu_s"] >= LEAST_SHARE * line["threads"] * line["map_s"]:
            self.wall_ns[name] = 1e9 * line["map_s"]  # else the threads waited for other programs

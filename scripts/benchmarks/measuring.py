"""Builds a benchmark, runs it, and keeps the least times of its repetitions."""
import json
import pathlib
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = ROOT / "build" / "release"
# A thread that had its processor to itself has used at least this part of it.
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
    """The least CPU and wall-clock times and counters of time of each benchmark, ns; wrong: those whose answers are wrong."""

    def __init__(self):
        self.least, self.wrong = {}, []

    def run(self, target, repetitions, min_time_s):
        build(target)
        # Interleaved, so that a slow spell of the machine does not meet one benchmark alone.
        done = subprocess.run(
            [BUILD / "tests" / target, f"--benchmark_repetitions={repetitions}",
             f"--benchmark_min_time={min_time_s}", "--benchmark_enable_random_interleaving=true",
             "--benchmark_format=json"],
            cwd=ROOT, stdout=subprocess.PIPE, text=True, stderr=subprocess.DEVNULL, check=False)
        if done.returncode not in (0, 1):
            raise BenchmarkError(f"{target} ended with {done.returncode}")
        for entry in json.loads(done.stdout)["benchmarks"]:
            self.add(entry)

    def add(self, entry):
        name = entry["run_name"]
        if entry.get("error_occurred"):
            self.wrong.append(f"{name}: {entry['error_message']}")
        elif entry["run_type"] == "iteration":
            scale = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}[entry["time_unit"]]
            times = {"cpu": entry["cpu_time"] * scale, "wall": entry["real_time"] * scale}
            times |= {key: value for key, value in entry.items() if key.endswith("_ns")}
            before = self.least.get(name, times)
            self.least[name] = {key: min(value, before[key]) for key, value in times.items()}

    def get(self, name, source):
        """None if it was not measured. Wall-clock time only if no other program had the processor of the first thread."""
        least = self.least.get(name, {})
        if source == "wall" and least and least["cpu"] < LEAST_SHARE * least["wall"]:
            return None
        return least.get(source)

"""Runs the tests that reach a mutation, until one fails."""
import contextlib
import dataclasses
import json
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import time

STAGES = ("unit", "program", "bits")  # in this order; "bits": the stored results
SLOW_FIGURE_S = 8  # figures that take this long or longer are not tried
# A mistake may ask for all memory, write without end, or loop when this script is killed.
LIMITS = ("setpriv", "--pdeathsig", "KILL", "--", "prlimit", f"--as={8 << 30}", f"--fsize={1 << 30}", "--core=0", "--")


@dataclasses.dataclass
class Test:
    name: str
    command: list
    stage: str
    seconds: float = 0.0
    reached: frozenset = frozenset()


def unit_tests(build, programs=()):
    """Those of the programs with these names, or of all: for no names, or the target unit_tests."""
    listed = subprocess.run(["ctest", "--show-only=json-v1"], cwd=build, capture_output=True, text=True, check=True)
    for test in json.loads(listed.stdout)["tests"]:
        labels = [p["value"] for p in test.get("properties", []) if p["name"] == "LABELS"]
        if labels == [["unit"]]:
            program, chosen = (*test.get("command", [""]), "")[:2]  # what is not built has none
            if programs and not {"unit_tests", pathlib.Path(program).name} & set(programs):
                continue
            if not program.endswith("_tests"):
                yield Test(test["name"], [program, chosen], "unit")
            for name in names_in(program, chosen) if program.endswith("_tests") else ():
                yield Test(f"{test['name']}.{name}", [program, f"--gtest_filter={name}"], "unit")


def names_in(program, chosen):
    """The names of the tests that a program of GoogleTest has."""
    text = subprocess.run([program, chosen, "--gtest_list_tests"], capture_output=True, text=True, check=True).stdout
    suite = ""
    for line in text.splitlines():
        name = line.split("#")[0].rstrip()
        if name.startswith("  "):
            yield suite + name.strip()
        elif name.endswith("."):
            suite = name


def listed(program, section):
    text = subprocess.run([program, "list"], capture_output=True, text=True, check=True).stdout
    lines = iter(text.splitlines())
    for line in lines:
        if line == section:
            break
    for line in lines:
        if not line.startswith("  "):
            return
        yield line.split()[0]


def seconds_of(program, figure):
    text = subprocess.run([program, "describe", figure], capture_output=True, text=True, check=True).stdout
    return float(re.search(r"; about (\S+) s on one fast core", text)[1])


def program_tests(root, build):
    """Figures with their claims, the metamorphic checks, the command line where it judges results; the stored results."""
    program = str(build / "remote-touch")
    for name in [name for name in listed(program, "figures") if seconds_of(program, name) < SLOW_FIGURE_S]:
        yield Test(f"figure {name}", [program, "-q", "figure", name, "-o", "figures"], "program")
    yield Test("reference", [str(root / "scripts/reference"), "--check", program], "program")
    for renderer in ("proxy", "tracked-sheet"):
        yield Test(f"verify {renderer}", [program, "verify", renderer], "program")
    for subject in ("compare", "results", "live", "scorecard", "sweep"):
        yield Test(f"command_line_{subject}", [str(root / "tests/system/command_line" / subject), program], "program")
    yield from stored_results(root, build)


def stored_results(root, build):
    program = str(build / "remote-touch")
    manifest = json.loads((root / "data/baselines/manifest.json").read_text())
    for name in [baseline["name"] for baseline in manifest["baselines"]]:
        yield Test(f"baseline {name}", [program, "-q", "baseline", "check", "--folder", str(root / "data/baselines"), name],
                   "bits")


class Machine:
    """Runs commands of one build, each in an empty folder with limits."""

    def __init__(self, root, build, scratch):
        self.root, self.build, self.scratch = root, build, scratch
        shutil.rmtree(scratch, ignore_errors=True)  # of a run that was killed
        scratch.mkdir(parents=True)

    def cache(self, mutation):
        return self.scratch / f"cache-{mutation}"

    def forget(self, mutation):
        shutil.rmtree(self.cache(mutation), ignore_errors=True)

    @contextlib.contextmanager
    def started(self, command, mutation=None, reached=None, output=subprocess.DEVNULL):
        """The process of the command; what is left of it and its folder are gone at the end."""
        folder = pathlib.Path(tempfile.mkdtemp(dir=self.scratch))
        # Tools that were made without the mistake would hide it.
        env = os.environ | {"TMPDIR": str(folder), "OMP_NUM_THREADS": "1", "REMOTE_TOUCH_CACHE": str(self.cache(mutation))}
        env.setdefault("REMOTE_TOUCH_DATA", str(self.root.parent / "shared" / "data"))
        for name, value in (("REMOTE_TOUCH_MUTATION", mutation), ("REMOTE_TOUCH_MUTATION_REACHED", reached)):
            env.pop(name, None)
            if value is not None:
                env[name] = str(value)
        process = subprocess.Popen([*LIMITS, *command], cwd=folder, env=env, stdin=subprocess.DEVNULL, stdout=output,
                                   stderr=subprocess.DEVNULL, process_group=0)
        try:
            yield process
        finally:
            try:
                os.killpg(process.pid, 9)
            except ProcessLookupError:
                pass
            process.wait()
            shutil.rmtree(folder, ignore_errors=True)

    def run(self, command, seconds, mutation=None, reached=None):
        """True when the command ends with 0 in time."""
        with self.started(command, mutation, reached) as process:
            try:
                return process.wait(seconds) == 0
            except subprocess.TimeoutExpired:
                return False

    def observe(self, test):
        """Runs the test without a mutation: it has to pass. Notes its time and which mutations it reaches."""
        with tempfile.NamedTemporaryFile(dir=self.scratch) as file:
            begin = time.monotonic()
            passed = self.run(test.command, 600, reached=file.name)
            test.seconds = time.monotonic() - begin
            data = pathlib.Path(file.name).read_bytes()
        test.reached = frozenset(number for number, byte in enumerate(data) if byte)
        return passed


def room_of(test):
    return test.name.split(".")[0] if test.stage == "unit" else ""


def batches(tests, mutation_file):
    """The tests of one program in one process; the programs of the mutation's own room first, then the quickest."""
    programs = {}
    for test in tests:
        key = test.command[0] if test.stage == "unit" else test.name
        programs.setdefault(key, []).append(test)
    def place(group):
        own = group[0].stage == "unit" and mutation_file.startswith(room_of(group[0]) + "/")
        return (not own, sum(test.seconds for test in group))
    for group in sorted(programs.values(), key=place):
        seconds = 10 + 5 * sum(test.seconds for test in group)
        if group[0].stage == "unit":
            names = ":".join(test.command[1].split("=", 1)[1] for test in group)
            program = group[0].command[0]
            yield [program, f"--gtest_filter={names}", "--gtest_fail_fast"], seconds, program.split("/")[-1]
        else:
            yield group[0].command, seconds, group[0].name


def try_mutation(machine, number, file, tests, stage):
    """The name of what finds it in this stage, or ""."""
    of_stage = [test for test in tests if test.stage == stage and number in test.reached]
    try:
        for command, seconds, name in batches(of_stage, file):
            if not machine.run(command, seconds, mutation=number):
                return name
    finally:
        machine.forget(number)
    return ""

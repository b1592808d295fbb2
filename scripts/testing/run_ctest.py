#!/usr/bin/python3
"""Runs tests by ctest and sums them up for a reader of the last lines.

Usage: run_ctest.py BUILD_FOLDER [--jobs N] [--stop-after N] [CTEST_OPTION...]

Prints what ctest prints, without the lines of GoogleTest about tests that passed. After --stop-after failures (default
10) the run ends. Then follow: the slowest tests, the first failure once more with its output, skips that
tests/allowed_skips does not list, and one line with the counts.
A skip that is not listed counts as a failure. Of a program of GoogleTest each of its tests counts.
Exit: 0 all passed, 1 not.
"""
import argparse
import hashlib
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
RESULT = re.compile(r"^ *\d+/\d+ Test +#\d+: (\S+) \.*( *Passed|[A-Za-z ]*\*\*\*\S+(?: \S+)?) +(\d+\.\d+) sec")
NEXT_TEST = re.compile(r"^ *(Start +\d+: |\d+/\d+ Test +#\d+: |\d+% tests passed)")
SKIPPED_PART = re.compile(r"^skipped ([^:]+): ", re.MULTILINE)
BEGUN = re.compile(r"^\[ RUN      \] ")
ENDED_WELL = re.compile(r"^\[       OK \] ")
ENDS = {verdict: re.compile(r"\[" + word + r"\] (\S+?),?(?: .*)? \(\d+ ms")
        for verdict, word in (("passed", "       OK "), ("failed", "  FAILED  "), ("skipped", "  SKIPPED "))}
OUTPUT = re.compile(r"^\d+/\d+ Testing: (.*)$", re.MULTILINE)
LONGEST_OUTPUT = 120  # lines of the first failure that are printed once more
SLOWEST = 30
HUNG_AFTER_S = "7200"  # ends a test that would never end; none takes so long on the slowest machine


class Watch:
    """What the lines of ctest say: results, and the output of the first test that failed."""

    def __init__(self, names):
        """names: of the tests that ctest runs. A test may run ctest itself and print results of others."""
        self.seconds, self.passed, self.failed, self.skipped = {}, [], [], []
        self.first_failure, self.in_first_failure = [], False
        self.names = names

    def read(self, line):
        if NEXT_TEST.match(line):
            self.in_first_failure = False
        result = RESULT.match(line)
        if result and result.group(1) in self.names:
            self.take(result.group(1), result.group(2).strip(), float(result.group(3)))
        if self.in_first_failure:
            self.first_failure.append(line.rstrip("\n"))

    def take(self, name, verdict, seconds):
        self.seconds[name] = seconds
        if verdict == "Passed":
            self.passed.append(name)
        elif verdict.startswith("***Skipped"):
            self.skipped.append(name)
        else:
            self.in_first_failure = not self.failed
            self.failed.append(name)


def without_passed(lines):
    """Leaves out the pairs of lines in which GoogleTest reports that a test begins and passes."""
    begun = ""
    for line in lines:
        if begun and not ENDED_WELL.match(line):
            yield begun
        if not BEGUN.match(line) and not (begun and ENDED_WELL.match(line)):
            yield line
        begun = line if BEGUN.match(line) else ""
    if begun:
        yield begun


def run(command, stop_after):
    """Runs ctest and ends it early after so many failures. Returns what was seen."""
    listed = subprocess.run([*command, "--show-only=json-v1"], stdout=subprocess.PIPE, text=True, cwd=ROOT,
                            check=True).stdout
    watch, ended_early = Watch({test["name"] for test in json.loads(listed)["tests"]}), False
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                          cwd=ROOT, start_new_session=True) as ctest:
        for line in without_passed(ctest.stdout):
            print(line, end="", flush=True)
            watch.read(line)
            if not ended_early and len(watch.failed) >= stop_after and not watch.in_first_failure:
                ended_early = True
                print(f"test: {len(watch.failed)} tests failed: the run ends here", flush=True)
                os.killpg(ctest.pid, signal.SIGTERM)
    return watch, ctest.returncode


def allowed_skips():
    """The regular expressions of tests/allowed_skips that hold on this machine."""
    data = os.environ.get("REMOTE_TOUCH_DATA") or ROOT.parent / "shared" / "data"
    holds = {"always": True, "user": os.geteuid() != 0, "no-recordings": not os.path.isdir(data)}
    lines = (ROOT / "tests" / "allowed_skips").read_text().splitlines()
    found = (re.match(r"(\S+) +(.+?)   +", line) for line in lines if line and not line.startswith("#"))
    return [re.compile(each.group(2)) for each in found if holds[each.group(1)]]


def outputs(build):
    """{test: what it printed} of the run that has just ended."""
    log = build / "Testing" / "Temporary" / "LastTest.log"
    parts = OUTPUT.split(log.read_text(errors="replace")) if log.exists() else [""]
    return {name: text.partition("\nOutput:\n")[2] for name, text in zip(parts[1::2], parts[2::2])}


class Counts:
    """How many tests passed, failed and were skipped; names of the skipped ones, also of skipped parts of a test."""

    def __init__(self, watch, texts):
        self.passed, self.failed, self.skips, parts = 0, 0, list(watch.skipped), []
        for name in watch.passed + watch.failed:
            found = {verdict: end.findall(texts.get(name, "")) for verdict, end in ENDS.items()}
            within = [f"{name}.{each}" for each in found["skipped"]]
            self.skips += within
            parts += SKIPPED_PART.findall(texts.get(name, ""))
            good = name in watch.passed
            self.passed += len(found["passed"]) or int(good and not within)
            self.failed += 0 if good else len(found["failed"]) or 1
        self.skipped = len(self.skips)
        allowed = allowed_skips()
        self.unlisted = sorted({name for name in self.skips + parts if not any(each.fullmatch(name) for each in allowed)})


def report(watch, code, build, seconds):
    """Prints the sums. Returns whether all is well."""
    print(f"\nThe slowest {min(SLOWEST, len(watch.seconds))}:")
    for name in sorted(watch.seconds, key=watch.seconds.get, reverse=True)[:SLOWEST]:
        print(f"{watch.seconds[name]:8.1f} s  {name}")
    counts = Counts(watch, outputs(build))
    if watch.failed:
        print("\nThe first failure once more:")
        print("\n".join(watch.first_failure[:LONGEST_OUTPUT]))
        print("test: FAILED: " + ", ".join(watch.failed))
    if counts.unlisted:
        print("test: FAILED: skipped, and not listed in tests/allowed_skips: " + ", ".join(counts.unlisted))
    if code != 0 and not watch.failed:
        print(f"test: FAILED: ctest ended with {code}")
    if not watch.passed:
        print("test: FAILED: no test passed")
    print(f"The tests took {seconds:.0f} s.")
    print(f"{counts.passed} passed, {counts.failed} failed, {counts.skipped} skipped", flush=True)
    return not watch.failed and not counts.unlisted and code == 0 and bool(watch.passed)


def cache_of(build):
    """A folder for the tools that tests make, one for each state of the sources that make them: a mistake in these
    sources would else be hidden by tools that were made without it."""
    digest = hashlib.sha256()
    for folder in ("core/dissertation/tool_motion", "core/mesh", "runners/experiment/mesh_files",
                   "runners/experiment/settings"):
        for file in sorted((ROOT / folder).rglob("*.[hc]*")):
            digest.update(file.read_bytes())
    here = build / "tools" / digest.hexdigest()[:16]
    for old in build.glob("tools/*"):
        if old != here:
            shutil.rmtree(old, ignore_errors=True)
    return str(here)


def folder_in_memory():
    """Where tests write their files, if memory has room for them and programs may be there: a disk waits whenever a file is
    replaced, and thousands are. None: the usual place. What a disk may do to a result is tested by system/failures."""
    place, least = "/dev/shm", 4 * 2**30
    if "TMPDIR" in os.environ or not os.access(place, os.W_OK):
        return None
    state = os.statvfs(place)
    return None if state.f_flag & os.ST_NOEXEC or state.f_bavail * state.f_frsize < least else place


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--jobs", default="3")  # some tests only wait: for a browser, a daemon or a timeout
    parser.add_argument("--stop-after", type=int, default=10)
    arguments, options = parser.parse_known_args()
    build = arguments.build.resolve()
    os.environ.setdefault("REMOTE_TOUCH_CACHE", cache_of(build))
    start = time.monotonic()
    with tempfile.TemporaryDirectory(prefix="tests.", dir=folder_in_memory()) as os.environ["TMPDIR"]:
        watch, code = run(["ctest", "--test-dir", str(build), "--output-on-failure", "--timeout", HUNG_AFTER_S,
                           "-j", arguments.jobs, *options], arguments.stop_after)
    sys.exit(0 if report(watch, code, build, time.monotonic() - start) else 1)


os.environ.setdefault("OMP_WAIT_POLICY", "passive")  # two tests have more threads than two cores can run
main()

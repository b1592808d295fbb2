#!/usr/bin/python3
"""Runs tests by ctest and sums them up for a reader of the last lines.

Usage: run_ctest.py BUILD_FOLDER [--jobs N] [--stop-after N] [CTEST_OPTION...]

Prints what ctest prints. After --stop-after failures (default 10) the run ends. Then follow: the slowest tests, the first
failure once more with its output, skips that tests/allowed_skips does not list, and one line with the counts.
A skip that is not listed counts as a failure. Exit: 0 all passed, 1 not.
"""
import argparse
import os
import pathlib
import re
import signal
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
RESULT = re.compile(r"^ *\d+/\d+ Test +#\d+: (\S+) \.*( *Passed|\*\*\*\S+(?: \S+)?) +(\d+\.\d+) sec")
NEXT_TEST = re.compile(r"^ *(Start +\d+: |\d+/\d+ Test +#\d+: |\d+% tests passed)")
SKIPPED_PART = re.compile(r"^skipped ([^:]+): ")
LONGEST_OUTPUT = 120  # lines of the first failure that are printed once more
SLOWEST = 30
HUNG_AFTER_S = "7200"  # ends a test that would never end; none takes so long on the slowest machine


class Watch:
    """What the lines of ctest say: results, and the output of the first test that failed."""

    def __init__(self):
        self.seconds, self.passed, self.failed, self.skipped = {}, [], [], []
        self.first_failure, self.in_first_failure = [], False

    def read(self, line):
        if NEXT_TEST.match(line):
            self.in_first_failure = False
        result = RESULT.match(line)
        if result:
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


def run(command, stop_after):
    """Runs ctest and ends it early after so many failures. Returns what was seen."""
    watch, ended_early = Watch(), False
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace",
                          cwd=ROOT, start_new_session=True) as ctest:
        for line in ctest.stdout:
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


def unlisted_skips(watch, build):
    """Skipped tests, and skipped parts of tests that passed, that no line of the list allows."""
    log = build / "Testing" / "Temporary" / "LastTest.log"
    parts = [SKIPPED_PART.match(line) for line in log.read_text(errors="replace").splitlines()] if log.exists() else []
    names = watch.skipped + [part.group(1) for part in parts if part]
    allowed = allowed_skips()
    return sorted({name for name in names if not any(each.fullmatch(name) for each in allowed)})


def report(watch, code, build, seconds):
    """Prints the sums. Returns whether all is well."""
    print(f"\nThe slowest {min(SLOWEST, len(watch.seconds))}:")
    for name in sorted(watch.seconds, key=watch.seconds.get, reverse=True)[:SLOWEST]:
        print(f"{watch.seconds[name]:8.1f} s  {name}")
    unlisted = unlisted_skips(watch, build)
    if watch.failed:
        print("\nThe first failure once more:")
        print("\n".join(watch.first_failure[:LONGEST_OUTPUT]))
        print("test: FAILED: " + ", ".join(watch.failed))
    if unlisted:
        print("test: FAILED: skipped, and not listed in tests/allowed_skips: " + ", ".join(unlisted))
    if code != 0 and not watch.failed:
        print(f"test: FAILED: ctest ended with {code}")
    if not watch.passed:
        print("test: FAILED: no test passed")
    print(f"The tests took {seconds:.0f} s.")
    print(f"{len(watch.passed)} passed, {len(watch.failed)} failed, {len(watch.skipped)} skipped", flush=True)
    return not watch.failed and not unlisted and code == 0 and bool(watch.passed)


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--jobs", default="2")
    parser.add_argument("--stop-after", type=int, default=10)
    arguments, options = parser.parse_known_args()
    build = arguments.build.resolve()
    start = time.monotonic()
    watch, code = run(["ctest", "--test-dir", str(build), "--output-on-failure", "--timeout", HUNG_AFTER_S,
                       "-j", arguments.jobs, *options], arguments.stop_after)
    sys.exit(0 if report(watch, code, build, time.monotonic() - start) else 1)


os.environ.setdefault("OMP_WAIT_POLICY", "passive")  # two tests have more threads than two cores can run
main()

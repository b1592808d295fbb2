#!/usr/bin/python3
"""Runs the tests with the label `evidence` one by one, and remembers which of them passed with which sources.

Usage: evidence.py BUILD_FOLDER [--list] [NAME...]

A test that passed with the sources as they are now is not run again; so a run that was ended goes on where it was.
NAME: only these, also where they passed before. --list: prints which are open, and runs nothing.
Exit: 0 all have passed with these sources, 1 not, 2 bad usage.
"""
import argparse
import hashlib
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]


def recordings():
    """The digest of the list of recordings, or whether there are any: a test that passed without them did not see them.
    The tests take them from this folder, whatever REMOTE_TOUCH_DATA says."""
    data = ROOT.parent / "shared" / "data"
    listed = data / "MANIFEST.sha256"
    return hashlib.sha256(listed.read_bytes()).hexdigest() if listed.is_file() else str(data.is_dir())


def digest_of_sources():
    """Of all files that git lists, tracked or new, but for pages, and of the recordings."""
    names = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True,
                           capture_output=True, text=True).stdout.split("\0")
    digest = hashlib.sha256(recordings().encode())
    for name in sorted(filter(None, names)):
        file = ROOT / name
        if file.suffix != ".md" and file.is_file():
            digest.update(f"{name}\n{hashlib.sha256(file.read_bytes()).hexdigest()}\n".encode())
    return digest.hexdigest()


def names_of_tests(build):
    text = subprocess.run(["ctest", "--test-dir", str(build), "-L", "^evidence$", "--show-only=json-v1"], check=True,
                          capture_output=True, text=True).stdout
    return [test["name"] for test in json.loads(text)["tests"]]


class Record:
    """A file in the build folder: for each test the sources with which it passed, and how long it took."""

    def __init__(self, build):
        self.file = build / "evidence.json"
        self.sources = digest_of_sources()
        self.passed = json.loads(self.file.read_text()) if self.file.exists() else {}

    def has(self, name):
        return self.passed.get(name, {}).get("sources") == self.sources

    def add(self, name, seconds):
        self.passed[name] = {"sources": self.sources, "seconds": round(seconds)}
        partial = self.file.with_suffix(".new")
        partial.write_text(json.dumps(self.passed, indent=1))
        partial.replace(self.file)


def run(name, build, record):
    start = time.monotonic()
    print(f"\n== {name}", flush=True)
    code = subprocess.run([ROOT / "scripts" / "testing" / "run_ctest.py", build, "-R", f"^{name}$"], check=False).returncode
    if code == 0 and digest_of_sources() == record.sources:
        record.add(name, time.monotonic() - start)
    return code == 0


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("names", nargs="*")
    parser.add_argument("--list", action="store_true")
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    tests, record = names_of_tests(build), Record(build)
    if not tests:
        parser.error(f"no test with the label evidence in {build}")
    unknown = [name for name in arguments.names if name not in tests]
    if unknown:
        parser.error(f"no test with the label evidence: {', '.join(unknown)}; there are: {', '.join(tests)}")
    failed = []
    if not arguments.list:
        for name in arguments.names or [name for name in tests if not record.has(name)]:
            if not run(name, build, record):
                failed.append(name)
    print()
    for name in tests:
        word = "passed" if record.has(name) else "FAILED" if name in failed else "open"
        print(f"{word:8}{name}" + (f"  {record.passed[name]['seconds']} s" if word == "passed" else ""))
    sys.exit(0 if all(record.has(name) for name in tests) else 1)


os.environ.setdefault("OMP_WAIT_POLICY", "passive")
os.environ.setdefault("TMPDIR", tempfile.gettempdir())  # on a disk: these tests fill it, and some ask what it does to a result
main()

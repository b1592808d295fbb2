"""Which of the unit tests notice each mistake, and which are never the only one to notice any."""
import collections
import csv
import os
import pathlib
import select
import subprocess
import time

LONGEST, SLACK_S = 5, 10  # a test may take this many times what it needs without a mistake, and these seconds
PATIENCE = 12  # tests of one program that may crash or hang before the rest are given up
COLUMNS = ("mutation", "place", "rule", "original", "mutated", "reached", "noticed")


def by_folder(mutations, order):
    """The keys of order, one of each folder in turn, so that the first N are spread over all folders alike."""
    folders = {}
    for key in order:
        folders.setdefault(str(pathlib.Path(mutations[key].file).parent), []).append(key)
    place = {key: (number, folder) for folder, keys in folders.items() for number, key in enumerate(keys)}
    return sorted(order, key=place.get)


class Watch:
    """Follows what a program of GoogleTest prints: which test runs, and which have ended."""

    def __init__(self, names):
        self.names, self.running, self.ended, self.failed = names, None, set(), set()
        self.since, self.rest = time.monotonic(), b""

    def read(self, data):
        *lines, self.rest = (self.rest + data).split(b"\n")
        for line in lines:
            self.read_line(line.decode(errors="replace"))

    def read_line(self, line):
        state, _, text = line.partition("] ")
        name = text.split(" ")[0].rstrip(",")
        if name not in self.names:
            return
        if state == "[ RUN      ":
            self.running, self.since = name, time.monotonic()
        elif state in ("[       OK ", "[  FAILED  ", "[  SKIPPED "):
            self.running = None
            self.ended.add(name)
            if state == "[  FAILED  ":
                self.failed.add(name)


def watched(machine, program, tests, number):
    """One process with some tests ({name: test}): the watch, when the process has ended or its test took too long."""
    watch = Watch(tests)
    with machine.started([program, f"--gtest_filter={':'.join(tests)}"], number, output=subprocess.PIPE) as process:
        while True:
            seconds = tests[watch.running].seconds if watch.running else 0
            left = watch.since + SLACK_S + LONGEST * seconds - time.monotonic()
            if left <= 0 or not select.select([process.stdout], [], [], left)[0]:
                break
            data = os.read(process.stdout.fileno(), 65536)
            if not data:
                break
            watch.read(data)
        process.stdout.close()
    return watch


def noticed_in(machine, program, tests, number):
    """Names of the tests ({name in the program: test}) of one program that fail, crash or hang when the mistake acts."""
    left, noticed = dict(tests), set()
    for _ in range(PATIENCE):
        if not left:
            break
        watch = watched(machine, program, left, number)
        broken = {watch.running} if watch.running else set()
        noticed |= watch.failed | broken
        if not watch.ended and not broken:  # it ends before its first test
            return noticed | set(left)
        left = {name: test for name, test in left.items() if name not in watch.ended | broken}
    return noticed


def noticed(machine, number, tests):
    """Names of the unit tests that notice the mistake."""
    programs = {}
    for test in tests:
        if test.stage == "unit" and number in test.reached:
            name = test.command[1].partition("=")[2] if test.command[1:] else ""
            programs.setdefault(test.command[0], {})[name] = test
    found = set()
    for program, named in programs.items():
        if "" in named:  # no program of GoogleTest
            test = named.pop("")
            if not machine.run(test.command, SLACK_S + LONGEST * test.seconds, mutation=number):
                found.add(test.name)
        found |= {named[name].name for name in noticed_in(machine, program, named, number)}
    machine.forget(number)
    return found


def row(key, mutation, reached, found):
    """What the file keeps of one mistake."""
    return dict(zip(COLUMNS, (key, f"{mutation.file}:{mutation.line}", mutation.rule, mutation.original, mutation.mutated,
                              reached, " ".join(sorted(found)))))


class Matrix:
    """The file of rows, one mistake each; it grows by a row at a time, so that a stopped run goes on where it ended."""

    def __init__(self, path):
        self.path = path
        self.rows = list(csv.DictReader(path.open(newline=""))) if path.exists() else []
        self.known = {row["mutation"] for row in self.rows}

    def add(self, entry):
        with self.path.open("a", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            if not self.rows:
                writer.writeheader()
            writer.writerow(entry)
        self.rows.append(entry)


def lines(rows, names):
    """What the matrix says of the tests with these names, as text."""
    sets = [set(row["noticed"].split()) & set(names) for row in rows]
    seen = [found for found in sets if found]
    counts = collections.Counter(name for found in seen for name in found)
    alone = collections.Counter(next(iter(found)) for found in seen if len(found) == 1)
    yield f"{len(seen)} of {len(rows)} mistakes are noticed by a unit test; {sum(alone.values())} by one test alone"
    yield f"of {len(names)} tests {len(counts)} notice a mistake, {len(alone)} are once the only one"
    for name in sorted(names):
        yield f"  {counts[name]:4d} {alone[name]:4d}  {name}"

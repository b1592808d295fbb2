"""Which tests notice each mistake, which are never the only one to notice any, and how two suites of tests compare."""
import collections
import csv
import json
import os
import pathlib
import select
import subprocess
import threading
import time

from mutation import report, trials
from mutation.mutation import MutationError

LONGEST, SLACK_S = 5, 10  # a test may take this many times what it needs without a mistake, and these seconds
CRASHES = 12  # processes of one program that may crash or hang before the rest of its tests are given up
HANGS = 6  # processes of all programs that may hang before the rest of all tests are given up
PROGRAMS = 3  # programs that notice a mistake before the others are given up: none of its tests can be the only one
SORTS = ("equivalent", "harmless", "gap")
COLUMNS = ("mutation", "sort", "why", "found", "place", "rule", "original", "mutated")


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
        self.hung = False
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
                watch.hung = True
                break
            data = os.read(process.stdout.fileno(), 65536)
            if not data:
                break
            watch.read(data)
        process.stdout.close()
    return watch


class Trial:
    """The unit tests that reach one mistake: the names of those that notice it, and of those that were given up."""

    def __init__(self, machine, number, file, tests):
        self.machine, self.number, self.hangs = machine, number, 0
        self.noticed, self.untried, noticing = set(), set(), 0
        programs = {}
        for test in tests:
            key = (not file.startswith(f"{trials.room_of(test)}/"), test.command[0])
            programs.setdefault(key, {})[test.command[1].partition("=")[2]] = test
        for (_, program), named in sorted(programs.items(), key=lambda item: item[0]):  # that of its own room first
            if noticing == PROGRAMS:
                self.untried |= {test.name for test in named.values()}
                continue
            before = len(self.noticed)
            if "" in named:  # no program of GoogleTest
                self.try_whole(named.pop(""))
            self.try_program(program, named)
            noticing += len(self.noticed) > before

    def try_whole(self, test):
        if not self.machine.run(test.command, SLACK_S + LONGEST * test.seconds, mutation=self.number):
            self.noticed.add(test.name)

    def try_program(self, program, left):
        """Starts a program again without the tests that ended, until each of them ({name in it: test}) has failed, passed,
        crashed or hung."""
        for _ in range(CRASHES):
            if not left or self.hangs >= HANGS:
                break
            watch = watched(self.machine, program, left, self.number)
            self.hangs += watch.hung
            broken = {watch.running} if watch.running else set()
            if not watch.ended and not broken:  # it ends before its first test
                broken = set(left)
            self.noticed |= {left[name].name for name in watch.failed | broken}
            left = {name: test for name, test in left.items() if name not in watch.ended | broken}
        self.untried |= {test.name for test in left.values()}


def row(machine, number, mutation, tests):
    """What the file keeps of one mistake. Tests of the whole program are tried only if no unit test notices it."""
    reaching = [test for test in tests if number in test.reached]
    units = [test for test in reaching if test.stage == "unit"]
    trial = Trial(machine, number, mutation.file, units)
    found, noticed = "unit", sorted(trial.noticed)
    for stage in () if noticed else ("program", "bits"):
        if by := trials.try_mutation(machine, number, mutation.file, tests, stage):
            found, noticed = stage, [by]
            break
    if not noticed:
        found = "survived" if reaching else "unreached"
    machine.forget(number)
    return {"place": f"{mutation.file}:{mutation.line}", "rule": mutation.rule, "original": mutation.original,
            "mutated": mutation.mutated, "found": found, "reached": len(units), "untried": len(trial.untried),
            "noticed": noticed}


def packed(numbers):
    """[3, 4, 5, 9] as "3-5 9"."""
    spans = []
    for number in sorted(numbers):
        if spans and spans[-1][1] == number - 1:
            spans[-1][1] = number
        else:
            spans.append([number, number])
    return " ".join(str(first) if first == last else f"{first}-{last}" for first, last in spans)


def unpacked(text):
    spans = [[int(number) for number in span.split("-")] for span in text.split()]
    return [number for span in spans for number in range(span[0], span[-1] + 1)]


class Matrix:
    """The file of what notices each mistake ({key: row}) for one suite: the digest of its sources and tests. It is written
    anew after each mistake, so that a stopped run goes on where it ended; with another suite it begins again."""

    def __init__(self, path, suite="", seeds=(), tests=(), programs=()):
        self.path, self.lock, self.programs = path, threading.Lock(), sorted(programs)
        try:
            stored = json.loads(path.read_text()) if path.exists() else {"suite": ""}
        except ValueError as error:
            raise MutationError(f"{path} is no file that --kills wrote: {error}") from error
        self.suite, self.seeds, self.tests, self.rows = suite or stored["suite"], set(seeds), sorted(tests), {}
        if self.suite == stored["suite"] != "":
            self.seeds |= set(stored["seeds"])
            self.programs = stored["programs"]
            self.tests = sorted({*tests, *stored["tests"]})
            self.rows = stored["mistakes"]
            for entry in self.rows.values():
                if entry["found"] == "unit":
                    entry["noticed"] = [stored["tests"][number] for number in unpacked(entry["noticed"])]

    def add(self, key, entry):
        with self.lock:
            self.rows[key] = entry
            self.write()

    def write(self):
        """One line for each test and each mistake, in an order of their own: versions of the file can be compared."""
        numbers = {name: number for number, name in enumerate(self.tests)}

        def text(entry):
            if entry["found"] != "unit":
                return json.dumps(entry)
            return json.dumps(entry | {"noticed": packed(numbers[name] for name in entry["noticed"])})
        rows = sorted(self.rows.items(), key=lambda item: (place_of(item[1]), item[0]))
        body = ",\n".join(f"{json.dumps(key)}: {text(entry)}" for key, entry in rows)
        tests = ",\n".join(json.dumps(name) for name in self.tests)
        self.path.parent.mkdir(parents=True, exist_ok=True)
        partial = self.path.with_suffix(".new")
        partial.write_text(f'{{"suite": {json.dumps(self.suite)},\n"seeds": {sorted(self.seeds)},\n'
                           f'"programs": {json.dumps(self.programs)},\n"tests": [\n{tests}],\n'
                           f'"mistakes": {{\n{body}}}}}\n')
        partial.replace(self.path)


def place_of(entry):
    file, _, line = entry["place"].rpartition(":")
    return file, int(line or 0)


def read_sorted(path):
    """{key: row} of a file of survivors."""
    if not path.exists():
        return {}
    rows = {row["mutation"]: row for row in csv.DictReader(path.open(newline=""))}
    for key, entry in rows.items():
        if entry["sort"] not in ("", *SORTS) or (entry["sort"] and not entry["why"]):
            raise MutationError(f"{path}: {key} needs a sort ({', '.join(SORTS)}) and a reason")
    return rows


def write_survivors(path, rows, known):
    """Lists what no test notices, for a person to sort; what is sorted stays until a test notices it. Returns
    the keys that are not sorted."""
    left = {key: dict.fromkeys(COLUMNS, "") | {name: entry[name] for name in COLUMNS if name in entry} | {"mutation": key}
            for key, entry in rows.items() if entry["found"] in ("survived", "unreached")}
    listed = {key: entry | {name: known.get(key, {}).get(name, "") for name in ("sort", "why")}
              for key, entry in left.items()}
    listed |= {key: entry for key, entry in known.items() if entry["sort"] and key not in rows}
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(sorted(listed.values(), key=lambda entry: (place_of(entry), entry["mutation"])))
    return [key for key in left if not listed[key]["sort"]]


def lines(matrix, known):
    """What one matrix says of its mistakes and tests, as text."""
    stages = collections.Counter(entry["found"] for entry in matrix.rows.values())
    yield f"{len(matrix.rows)} mistakes, tried with {' '.join(matrix.programs) or 'all tests'}: " + \
          ", ".join(f"{count} {stage}" for stage, count in sorted(stages.items()))
    sorts = collections.Counter(known.get(key, {}).get("sort") or "not sorted" for key, entry in matrix.rows.items()
                                if entry["found"] in ("survived", "unreached"))
    yield "no test notices: " + (", ".join(f"{count} {name}" for name, count in sorted(sorts.items())) or "none")
    seen = [entry["noticed"] for entry in matrix.rows.values() if entry["found"] == "unit"]
    counts = collections.Counter(name for found in seen for name in found)
    alone = collections.Counter(found[0] for found in seen if len(found) == 1)
    yield f"{len(matrix.tests)} unit tests: {len(counts)} notice a mistake, {len(alone)} are once the only one"
    for name in matrix.tests:
        yield f"  {counts[name]:4d} {alone[name]:4d}  {name}"


def comparison(one, other, known):
    """Which share of the mistakes that both tried each of two suites finds, and which mistakes only one of them finds."""
    keys = [key for key in one.rows if key in other.rows and known.get(key, {}).get("sort") != "equivalent"]
    yield f"{len(keys)} mistakes were tried with both and are not sorted as equivalent"
    for title, stages in (("by unit tests", ("unit",)), ("by all tests", ("unit", "program", "bits"))):
        first, second = [{key for key in keys if matrix.rows[key]["found"] in stages} for matrix in (one, other)]
        yield f"found {title}: {report.fraction(len(first), len(keys))}; {report.fraction(len(second), len(keys))}"
        only, only_other = sorted(first - second), sorted(second - first)
        yield f"  only the first {len(only)}, only the second {len(only_other)}: p = " \
              f"{report.mcnemar(len(only), len(only_other)):.3g} (McNemar, exact)"
        for name, found in (("first", only), ("second", only_other)):
            for key in found:
                entry = one.rows[key]
                yield f"  only the {name}: {key}  {entry['place']} {entry['original']}  ->  {entry['mutated'] or '(left out)'}"

"""The tables of pages that show stored measurements, between marks that name the table:

<!-- benchmarks proxy: written by scripts/benchmark --page -->
<!-- end of benchmarks proxy -->

A table has a column for each machine that has some of its quantities. Numbers that do not meet their aim are bold, and are
listed below the table.
"""
import dataclasses
import difflib
import re

from benchmarks.aims import LEVELS
from benchmarks.measuring import ROOT, BenchmarkError
from benchmarks.quantities import QUANTITIES, TABLES
from benchmarks.quantity import TIMES
from benchmarks.stored import MEASURED, load, renew_aims

PAGES = ["tests/benchmarks/README.md"]
MACHINES = "machines"
NAMES_OF_LEVELS = {"x86-64-v4": "AVX-512", "x86-64-v3": "AVX2", "x86-64": "SSE2"}
NONE = "-"


def begin_of(table):
    return f"<!-- benchmarks {table}: written by scripts/benchmark --page -->\n"


def end_of(table):
    return f"<!-- end of benchmarks {table} -->\n"


# --- texts ---

def bundle(texts):
    """AVX-512 (AVX2, SSE2); texts: {level: text or None}, "" for a quantity without levels."""
    if "" in texts:
        return texts[""] or NONE
    first, *others = (texts.get(level) for level in reversed(LEVELS))
    while others and others[-1] is None:
        others.pop()
    shown = first or NONE
    return f"{shown} ({', '.join(each or NONE for each in others)})" if others else shown if first else NONE


def aim_text(aim, levels):
    if aim is None:
        return ""
    bounds = {level: f"{aim.at(level):g}" for level in levels if aim.at(level) is not None}
    one = next(iter(bounds.values())) if len(set(bounds.values())) == 1 else bundle(bounds)
    return f"{'at least' if aim.at_least else 'at most'} {one}"


def heading(stored):
    return stored["title"] if stored["origin"] == MEASURED else f"{stored['title']}, earlier"


# --- tables of quantities ---

@dataclasses.dataclass(frozen=True)
class Row:
    """A quantity's value, or its ratio; met: the key that says whether its aim is met."""
    quantity: object
    text: str
    unit: str
    aim: object
    field: str
    met: str

    def of(self, stored):
        """{level: (number, whether the aim is met)} of a machine."""
        entries = stored["parts"].get(self.quantity.part, {"quantities": {}})["quantities"]
        found = {level: entries.get(self.quantity.key_at(level), {}) for level in self.quantity.levels()}
        return {level: (entry[self.field], entry.get(self.met)) for level, entry in found.items() if self.field in entry}

    def line(self, machines):
        cells = []
        for stored in machines:
            texts = {level: f"**{value:g}**" if met is False else f"{value:g}"
                     for level, (value, met) in self.of(stored).items()}
            cells.append(bundle(texts))
        return f"| {self.text} | {self.unit} | {aim_text(self.aim, self.quantity.levels())} | {' | '.join(cells)} |"

    def missed(self, stored):
        """The numbers that do not meet the aim, or ""."""
        unit = "" if self.unit == TIMES else f" {self.unit}"
        numbers = [f"{value:g}{unit}{f' with {NAMES_OF_LEVELS[level]}' if level else ''}"
                   for level, (value, met) in reversed(self.of(stored).items()) if met is False]
        if not numbers:
            return ""
        what = self.text if self.field == "value" else f"{self.quantity.text}; {self.text}"
        return f"{what}: {', '.join(numbers)}; aim: {aim_text(self.aim, self.quantity.levels())}"


def rows_of(table):
    for quantity in (each for each in QUANTITIES if each.table == table):
        yield Row(quantity, quantity.text, quantity.unit, quantity.aim, "value", "met")
        if quantity.ratio:
            yield Row(quantity, quantity.compared_with, TIMES, quantity.ratio_aim, "ratio", "ratio_met")


def table_lines(stored, table):
    rows = list(rows_of(table))
    machines = [each for each in stored.values() if any(row.of(each) for row in rows)]
    if not machines:
        return ["Nothing of this table is stored."]
    rows = [row for row in rows if any(row.of(each) for each in machines)]
    return [f"| what | unit | aim | {' | '.join(heading(each) for each in machines)} |", "|---" * (3 + len(machines)) + "|",
            *[row.line(machines) for row in rows], "", *verdict_lines(machines, rows)]


def verdict_lines(machines, rows):
    """The aims that are not met, for each machine."""
    if all(met is None for row in rows for each in machines for _, met in row.of(each).values()):
        return ["These numbers have no aims."]
    lines = []
    for each in machines:
        missed = [text for text in (row.missed(each) for row in rows) if text]
        if missed:
            lines += [f"**Not met**, {heading(each)}:", "", *[f"- {text}" for text in missed], ""]
    return lines[:-1] or ["Every number of this table that has an aim meets it."]


# --- table of machines ---

def named_levels(instruction_sets):
    """SSE2, AVX2, AVX-512 for the flags of /proc/cpuinfo; other texts as they are."""
    flags = (instruction_sets or NONE).split()
    names = [name for name, flag in (("SSE2", "sse2"), ("AVX2", "avx2"), ("AVX-512", "avx512vl")) if flag in flags]
    return ", ".join(names) or instruction_sets or NONE


def measured_lines(stored):
    """One line for the parts of a machine that have the same date, commit and compiler."""
    groups = {}
    for part, content in stored["parts"].items():
        key = tuple(content[each] or NONE for each in ("date", "commit", "compiler"))
        groups.setdefault(key, []).append((part, content["load"]))
    for (date, commit, compiler), parts in groups.items():
        loads = [each for _, load in parts for each in load or ()]
        load = f"{min(loads):g} to {max(loads):g}" if loads else NONE
        yield f"| {heading(stored)} | {', '.join(part.replace('_', ' ') for part, _ in parts)} | {date} | {commit} | {compiler} | {load} |"


def machines_lines(stored):
    lines = ["| column | processor | instruction sets | cores | caches | numbers |", "|---|---|---|---|---|---|"]
    for each in stored.values():
        machine = each["machine"]
        lines.append(f"| {heading(each)} | {machine['processor']} | {named_levels(machine['instruction_sets'])} | "
                     f"{machine['cores'] or NONE} | {machine['caches'] or NONE} | {each['origin']} |")
    lines += ["", "| column | parts | date | commit | compiler | load |", "|---|---|---|---|---|---|"]
    return lines + [line for each in stored.values() for line in measured_lines(each)]


# --- pages ---

def with_tables(text, stored):
    """The page with all its marked tables made anew. Raises a BenchmarkError for a mark that has no end or no table."""
    for table in re.findall(r"^<!-- benchmarks (\S+): written", text, re.MULTILINE):
        if table not in (MACHINES, *TABLES):
            raise BenchmarkError(f"no such table: {table}; expected one of {', '.join((MACHINES, *TABLES))}")
        before, begin, rest = text.partition(begin_of(table))
        old, end, after = rest.partition(end_of(table))
        if not begin or not end or "<!--" in old or begin in after:
            raise BenchmarkError(f"table {table}: expected {begin_of(table).strip()} and {end_of(table).strip()}")
        lines = machines_lines(stored) if table == MACHINES else table_lines(stored, table)
        text = before + begin + "\n".join(lines) + "\n" + end + after
    return text


def update(root=ROOT, check_only=False):
    """Writes the tables of all pages and the aims of stored files, or only compares; returns the differences as lines."""
    folder = root / "data" / "benchmarks"
    if not check_only:
        renew_aims(folder)
    stored, differences, shown = load(folder), [], set()
    for name in PAGES:
        path = root / name
        text = path.read_text(encoding="utf-8")
        new = with_tables(text, stored)
        shown |= {table for table in (MACHINES, *TABLES) if begin_of(table) in new}
        differences += difflib.unified_diff(text.splitlines(True), new.splitlines(True), name, "the stored numbers")
        if not check_only and new != text:
            path.write_text(new, encoding="utf-8")
    if missing := set(TABLES) - shown:
        raise BenchmarkError(f"no page has the tables {', '.join(sorted(missing))}")
    return differences

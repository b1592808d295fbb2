"""The tables of pages that show stored measurements, between marks that name the table:

<!-- benchmarks proxy: written by scripts/benchmark --page -->
<!-- end of benchmarks proxy -->

A table has a column for each machine that has some of its quantities, and below it a list of the aims that are not met.
"""
import difflib
import re

from benchmarks.measuring import ROOT, BenchmarkError
from benchmarks.quantities import QUANTITIES, TABLES
from benchmarks.quantity import LEVELS
from benchmarks.stored import MEASURED, load

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


def number(value):
    return None if value is None else f"{value:g}"


def aim_text(aim, levels):
    if aim is None:
        return ""
    bounds = {level: number(aim.at(level)) for level in levels}
    word = "at least" if aim.at_least else "at most"
    if len(set(bounds.values())) == 1:
        return f"{word} {next(iter(bounds.values()))}"
    return f"{word} {bundle(bounds)}"


def entries_of_table(stored, quantity):
    """{level: entry} of a machine."""
    part = stored["parts"].get(quantity.part, {"quantities": {}})
    keys = {level: quantity.key_at(level) for level in quantity.levels()}
    return {level: part["quantities"][key] for level, key in keys.items() if key in part["quantities"]}


def row(machines, quantity, field, text, unit, aim):
    cells = []
    for stored in machines:
        entries = entries_of_table(stored, quantity)
        cells.append(bundle({level: number(entries.get(level, {}).get(field)) for level in quantity.levels()}))
    if all(cell == NONE for cell in cells):
        return None
    return f"| {text} | {unit} | {aim_text(aim, quantity.levels())} | {' | '.join(cells)} |"


def heading(stored):
    return stored["title"] if stored["origin"] == MEASURED else f"{stored['title']}, earlier"


# --- tables ---

def table_lines(stored, table):
    quantities = [each for each in QUANTITIES if each.table == table]
    machines = [each for each in stored.values() if any(entries_of_table(each, quantity) for quantity in quantities)]
    if not machines:
        return ["Nothing of this table is stored."]
    lines = [f"| what | unit | aim | {' | '.join(heading(each) for each in machines)} |", "|---" * (3 + len(machines)) + "|"]
    for quantity in quantities:
        lines += [row(machines, quantity, "value", quantity.text, quantity.unit, quantity.aim),
                  row(machines, quantity, "ratio", quantity.compared_with, "times", quantity.ratio_aim)]
    return [line for line in lines if line] + ["", *verdict_lines(machines, quantities)]


def verdict_lines(machines, quantities):
    """The aims that are not met, for each machine; nothing if no entry has an aim."""
    lines, has_aims = [], False
    for stored in machines:
        missed = []
        for quantity in quantities:
            found = entries_of_table(stored, quantity)
            for field, met, text in (("value", "met", quantity.text), ("ratio", "ratio_met", quantity.compared_with)):
                judged = {level: each for level, each in found.items() if met in each}
                has_aims |= bool(judged)
                not_met = [f"{each[field]:g}{f' with {NAMES_OF_LEVELS[level]}' if level else ''}"
                           for level, each in reversed(judged.items()) if not each[met]]
                if not_met:
                    missed.append(f"{text}: {', '.join(not_met)}")
        if missed:
            lines += [f"- {heading(stored)}: {'; '.join(missed)}."]
    if lines:
        return ["**Not met:**", "", *lines]
    return ["Every stored number meets its aim."] if has_aims else []


def machines_lines(stored):
    lines = ["| column | processor | instruction sets | cores | caches | numbers |", "|---|---|---|---|---|---|"]
    for each in stored.values():
        machine = {key: NONE if value is None else value for key, value in each["machine"].items()}
        lines.append(f"| {heading(each)} | {machine['processor']} | {machine['instruction_sets']} | {machine['cores']} | "
                     f"{machine['caches']} | {each['origin']} |")
    lines += ["", "| column | part | date | commit | compiler | load before and after |", "|---|---|---|---|---|---|"]
    for each in stored.values():
        for part, content in each["parts"].items():
            load_text = f"{content['load'][0]:g}, {content['load'][1]:g}" if content["load"] else NONE
            lines.append(f"| {heading(each)} | {part} | {content['date']} | {content['commit'] or NONE} | "
                         f"{content['compiler'] or NONE} | {load_text} |")
    return lines


# --- pages ---

def with_tables(text, stored):
    """The page with all its marked tables made anew. Raises a BenchmarkError for a mark that has no end or no table."""
    for table in re.findall(r"^<!-- benchmarks (\S+): written", text, re.MULTILINE):
        if table not in (MACHINES, *TABLES):
            raise BenchmarkError(f"no such table: {table}; expected one of {', '.join((MACHINES, *TABLES))}")
        before, begin, rest = text.partition(begin_of(table))
        old, end, after = rest.partition(end_of(table))
        if not begin or not end or "<!--" in old:
            raise BenchmarkError(f"table {table}: expected {begin_of(table).strip()} and {end_of(table).strip()}")
        lines = machines_lines(stored) if table == MACHINES else table_lines(stored, table)
        text = before + begin + "\n".join(lines) + "\n" + end + after
    return text


def update(root=ROOT, check_only=False):
    """Writes the tables of all pages, or only compares them; returns the differences as lines."""
    stored, differences, shown = load(root / "data" / "benchmarks"), [], set()
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

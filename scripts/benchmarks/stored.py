"""Stored measurements in data/benchmarks: numbers.csv has a row for each number, runs.csv one for each machine and part.

An aim and whether it is met are those of quantities.py; renew() writes them again. The load is the mean number of
running programs in the minute before and after a measurement, with the benchmark itself (after).
"""
import csv
import datetime
import io
import os

from benchmarks.machine import commit, compiler
from benchmarks.measuring import ROOT, BenchmarkError
from benchmarks.quantities import QUANTITIES

FOLDER = ROOT / "data" / "benchmarks"
NUMBERS = ("machine", "part", "what", "instructions", "number", "unit", "aim", "met")
RUNS = ("machine", "part", "date", "commit", "compiler", "load before", "load after", "processor", "instruction sets", "cores", "caches")


def read(folder, name, columns):
    try:
        rows = list(csv.DictReader((folder / name).read_text(encoding="utf-8").splitlines(), strict=True))
    except (OSError, csv.Error) as error:
        raise BenchmarkError(f"{name}: {error}") from error
    for row in rows:
        if tuple(row) != columns or None in row.values():
            raise BenchmarkError(f"{name}: expected the columns {', '.join(columns)}, found {row}")
    return rows


def text_of(rows, columns):
    text = io.StringIO()
    writer = csv.DictWriter(text, columns, lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def row_of(machine, quantity, instructions, number):
    return {"machine": machine, "part": quantity.part, "what": quantity.text, "instructions": instructions, "number": number,
            "unit": quantity.unit, "aim": quantity.aim_of(instructions), "met": quantity.met(float(number), instructions)}


def rows_of(machine, part, times):
    """The numbers of the part that the times have."""
    values = [(quantity, each, quantity.value(times, each)) for quantity in QUANTITIES if quantity.part == part
              for each in quantity.instructions()]
    return [row_of(machine, quantity, each, value) for quantity, each, value in values if value is not None]


def renewed(rows):
    """The same numbers by machine, in the order of the quantities, with the aims of now."""
    known = [(quantity, each) for quantity in QUANTITIES for each in quantity.instructions()]
    places = {(quantity.part, quantity.text, each): place for place, (quantity, each) in enumerate(known)}
    found = {}
    for row in rows:
        place = places.get((row["part"], row["what"], row["instructions"]))
        if place is None:
            raise BenchmarkError(f"no such quantity in scripts/benchmarks/quantities.py: {row}")
        if row["unit"] != known[place][0].unit or (row["machine"], place) in found:
            raise BenchmarkError(f"another unit, or there twice: {row}")
        try:
            is_number = 0 < float(row["number"]) < float("inf")
        except ValueError:
            is_number = False
        if not is_number:
            raise BenchmarkError(f"expected a positive number: {row}")
        found[row["machine"], place] = row_of(row["machine"], *known[place], row["number"])
    return [row for _, row in sorted(found.items())]


def renew(folder=FOLDER, new_numbers=(), new_runs=()):
    """Writes both files with new rows, which replace those of their machines and parts, and with the aims of now."""
    replaced = {(run["machine"], run["part"]) for run in new_runs}
    numbers, runs = ([row for row in read(folder, name, columns) if (row["machine"], row["part"]) not in replaced] + list(new)
                     for name, columns, new in (("numbers.csv", NUMBERS, new_numbers), ("runs.csv", RUNS, new_runs)))
    (folder / "numbers.csv").write_text(text_of(renewed(numbers), NUMBERS), encoding="utf-8")
    (folder / "runs.csv").write_text(text_of(sorted(runs, key=lambda run: run["machine"]), RUNS), encoding="utf-8")


def check(folder=FOLDER):
    """Raises a BenchmarkError if the files are not what renew() would write, or do not belong together."""
    numbers, runs = read(folder, "numbers.csv", NUMBERS), read(folder, "runs.csv", RUNS)
    for row, expected in zip(numbers, renewed(numbers)):
        if row != expected:
            raise BenchmarkError(f"expected {expected}, found {row}; scripts/benchmark --renew writes aims and order again")
    parts = [(run["machine"], run["part"]) for run in runs]
    if len(set(parts)) < len(parts) or set(parts) != {(row["machine"], row["part"]) for row in numbers}:
        raise BenchmarkError("runs.csv does not have one row for each machine and part of numbers.csv")
    if empty := [run for run in runs if "" in run.values()]:
        raise BenchmarkError(f"not stated: {empty[0]}")


def state():
    """The commit and the load before a measurement."""
    return {"commit": commit(), "load before": f"{os.getloadavg()[0]:.1f}"}


def run_of(machine, part, before):
    """The row of a part that was just measured. before: state() as it was before the build."""
    return {"machine": machine["title"], "part": part, "date": datetime.datetime.now(datetime.timezone.utc).date().isoformat(),
            "compiler": compiler(), "load after": f"{os.getloadavg()[0]:.1f}", "processor": machine["processor"],
            "instruction sets": machine["instruction_sets"], "cores": str(machine["cores"]), "caches": machine["caches"]} | before

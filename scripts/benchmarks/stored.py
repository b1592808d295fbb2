"""Stored measurements: one file for each kind of machine, data/benchmarks/NAME.json.

{
  "title": "AMD EPYC (Zen 4)", "origin": "measured",
  "machine": {"processor": ..., "instruction_sets": ..., "cores": ..., "caches": ...},
  "parts": {"proxy": {"date": ..., "commit": ..., "compiler": ..., "load": [before, after], "quantities": {KEY: ENTRY}}}
}

An entry has a value with its unit, or a ratio with what it is compared with, or both, and the aim of each with whether
it is met. The origin is "measured", or says from which page the numbers were transcribed. null: not stated there.
load: the mean number of running programs in the minute before and after, including the benchmark itself (after).
"""
import datetime
import functools
import json
import os
import re

from benchmarks.machine import commit, compiler, describe_machine, name_of
from benchmarks.measuring import ROOT, BenchmarkError
from benchmarks.quantities import PARTS, QUANTITIES, entries_of
from benchmarks.quantity import entry

FOLDER = ROOT / "data" / "benchmarks"
MEASURED = "measured"
FILE_KEYS = ("title", "origin", "machine", "parts")
MACHINE_KEYS = ("processor", "instruction_sets", "cores", "caches")
PART_KEYS = ("date", "commit", "compiler", "load", "quantities")


@functools.cache
def by_key():
    """{key of an entry: (quantity, level)}."""
    return {quantity.key_at(level): (quantity, level) for quantity in QUANTITIES for level in quantity.levels()}


# --- reading ---

def read(path):
    try:
        return json.loads(path.read_text(encoding="utf-8"), object_pairs_hook=unique)
    except ValueError as error:
        raise BenchmarkError(f"{path.name}: {error}") from error


def unique(pairs):
    if len({key for key, _ in pairs}) < len(pairs):
        raise ValueError(f"a key is there twice: {', '.join(key for key, _ in pairs)}")
    return dict(pairs)


def load(folder=FOLDER):
    """{name: what is stored}: machines that were measured first, then transcribed ones."""
    stored = {path.stem: read(path) for path in sorted(folder.glob("*.json"))}
    for name, content in stored.items():
        check(f"{name}.json", content)
    titles = [(content["title"], content["origin"] == MEASURED) for content in stored.values()]
    if len(set(titles)) < len(titles):
        raise BenchmarkError(f"two machines have the same title: {', '.join(sorted(title for title, _ in titles))}")
    return dict(sorted(stored.items(), key=lambda item: (item[1]["origin"] != MEASURED, item[0])))


def check(name, stored):
    """Raises a BenchmarkError if the file has not exactly what it should have."""
    require_keys(name, stored, FILE_KEYS)
    require_keys(f"{name}: machine", stored["machine"], MACHINE_KEYS)
    is_measured = stored["origin"] == MEASURED
    if not is_measured and not re.match(r"transcribed from \S", stored["origin"]):
        raise BenchmarkError(f'{name}: origin: expected "{MEASURED}" or "transcribed from ..."')
    known = by_key()
    for part, content in require_object(f"{name}: parts", stored["parts"]).items():
        place = f"{name}: {part}"
        if part not in PARTS:
            raise BenchmarkError(f"{place}: expected one of {', '.join(PARTS)}")
        require_keys(place, content, PART_KEYS)
        check_is_stated(place, content, is_measured)
        for key, stored_entry in require_object(f"{place}: quantities", content["quantities"]).items():
            check_entry(f"{place}: {key}", stored_entry, part, *known.get(key, (None, None)))
    if is_measured:
        check_stated(f"{name}: machine", stored["machine"], MACHINE_KEYS)


def require_object(place, content):
    if not isinstance(content, dict):
        raise BenchmarkError(f"{place}: expected an object, found {json.dumps(content)}")
    return content


def require_keys(place, content, keys):
    if set(require_object(place, content)) != set(keys):
        raise BenchmarkError(f"{place}: expected the keys {', '.join(keys)}, found {', '.join(content)}")


def check_stated(place, content, keys):
    for key in keys:
        if content[key] in (None, "", []):
            raise BenchmarkError(f"{place}: {key} is not stated")


def check_is_stated(place, content, is_measured):
    check_stated(place, content, PART_KEYS[:-1] if is_measured else ("date",))
    if not re.fullmatch(r"\d{4}(-\d\d(-\d\d)?)?", content["date"]):
        raise BenchmarkError(f"{place}: date: expected YYYY-MM-DD, YYYY-MM or YYYY")
    load_ = content["load"]
    if load_ is not None and not (isinstance(load_, list) and len(load_) == 2 and all(is_number(each) for each in load_)):
        raise BenchmarkError(f"{place}: load: expected two numbers, found {json.dumps(load_)}")


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool) and abs(value) < float("inf")


def check_entry(place, stored, part, quantity, level):
    if quantity is None:
        raise BenchmarkError(f"{place}: no such quantity in scripts/benchmarks/quantities.py")
    if quantity.part != part:
        raise BenchmarkError(f"{place}: belongs to {quantity.part}")
    value, ratio = (require_object(place, stored).get(each) for each in ("value", "ratio"))
    for number in (value, ratio):
        if number is not None and not (is_number(number) and number > 0):
            raise BenchmarkError(f"{place}: expected a positive number, found {number!r}")
    if value is None and ratio is None:
        raise BenchmarkError(f"{place}: expected a value or a ratio")
    if ratio is not None and quantity.ratio is None:
        raise BenchmarkError(f"{place}: this quantity has no ratio")
    expected = entry(quantity, level, value, ratio)
    if stored != expected:
        raise BenchmarkError(f"{place}: expected {json.dumps(expected)}, found {json.dumps(stored)}; if the aim has "
                             "changed, scripts/benchmark --page writes it")


# --- writing ---

def text_of(stored):
    """JSON with one line for each entry, in the order of their keys."""
    def line(content):
        return json.dumps(content, ensure_ascii=False)
    lines = ["{", f' "title": {line(stored["title"])},', f' "origin": {line(stored["origin"])},', ' "machine": {',
             ",\n".join(f"  {line(key)}: {line(stored['machine'][key])}" for key in MACHINE_KEYS), " },", ' "parts": {']
    parts = []
    for part in (each for each in PARTS if each in stored["parts"]):
        content = stored["parts"][part]
        rows = [f"   {line(key)}: {line(content[key])}," for key in PART_KEYS[:-1]]
        entries = ",\n".join(f"    {line(key)}: {line(each)}" for key, each in sorted(content["quantities"].items()))
        parts.append("\n".join([f"  {line(part)}: {{", *rows, '   "quantities": {', entries, "   }", "  }"]))
    return "\n".join([*lines, ",\n".join(parts), " }", "}"]) + "\n"


def write(name, stored, folder=FOLDER):
    check(f"{name}.json", stored)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{name}.json").write_text(text_of(stored), encoding="utf-8")


def renew_aims(folder=FOLDER):
    """Writes the aims that quantities.py has now, and whether they are met, into all files. Numbers stay as they are."""
    for path in sorted(folder.glob("*.json")):
        stored = read(path)
        require_keys(path.name, stored, FILE_KEYS)
        for content in require_object(path.name, stored["parts"]).values():
            require_keys(path.name, content, PART_KEYS)
            entries = require_object(path.name, content["quantities"])
            content["quantities"] = {key: with_aims_of_now(key, each) for key, each in entries.items()}
        write(path.stem, stored, folder)


def with_aims_of_now(key, stored_entry):
    """The unit and the comparison stay, so that the check finds those that have changed."""
    if key not in by_key() or not isinstance(stored_entry, dict):
        return stored_entry
    now = entry(*by_key()[key], stored_entry.get("value"), stored_entry.get("ratio"))
    return now | {field: stored_entry[field] for field in ("unit", "compared_with") if field in stored_entry}


def with_parts(before, machine, parts):
    """The content of a file in which the parts replace earlier ones. before: the earlier content, or None."""
    title = machine["title"]
    described = {key: machine[key] for key in MACHINE_KEYS}
    if before is None:
        before = {"title": title, "origin": MEASURED, "machine": described, "parts": {}}
    if before["origin"] != MEASURED:
        raise BenchmarkError(f"{title}: a file of transcribed numbers does not get measured ones; give another name")
    if before["machine"] != described:
        raise BenchmarkError(f"{title}: the file is of another machine ({before['machine']}); give another name")
    return before | {"parts": before["parts"] | parts}


def load_average():
    return round(os.getloadavg()[0], 1)


def state():
    """The commit and the load before a measurement."""
    return {"commit": commit(), "load": load_average()}


def part_of(part, times, before):
    """What is stored of a part that was just measured. before: state() as it was before the build."""
    return {"date": datetime.datetime.now(datetime.timezone.utc).date().isoformat(), "commit": before["commit"],
            "compiler": compiler(), "load": [before["load"], load_average()], "quantities": entries_of(part, times)}


def store(parts, name=None, folder=FOLDER):
    """Writes measured parts into the file of this machine; returns its path. name: of the file, if it is not that of the
    processor; it is also in the title."""
    machine = describe_machine()
    if name:
        machine["title"] += f", {name}"
    name = name or name_of(machine["title"])
    path = folder / f"{name}.json"
    write(name, with_parts(read(path) if path.exists() else None, machine, parts), folder)
    return path

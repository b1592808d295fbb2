"""A quantity that is stored: what it is, how it is read from the measured times, and its aims.

A quantity has a value, and may have a ratio to something that was measured in the same run. It has one value for each
instruction set if its key ends with /{level}. Its aims are bounds for the value and for the ratio.
"""
import dataclasses
from typing import Callable, Optional

from benchmarks.aims import LEVELS
from benchmarks.measuring import LEAST_SHARE

TIME_UNITS = {"ns": 1, "us": 1e3, "ms": 1e6, "s": 1e9}
TIMES = "times"


@dataclasses.dataclass(frozen=True)
class Aim:
    """bound: a number, or one for each level. at_least: otherwise at most."""
    bound: object
    at_least: bool = False

    def at(self, level):
        return self.bound.get(level) if isinstance(self.bound, dict) else self.bound

    def text(self, level):
        bound = self.at(level)
        return None if bound is None else f"{'>=' if self.at_least else '<='} {bound:g}"

    def is_met(self, value, level):
        return value >= self.at(level) if self.at_least else value <= self.at(level)


def most(bound):
    return Aim(bound)


def least(bound):
    return Aim(bound, at_least=True)


Reader = Callable[[object, str], Optional[float]]  # (times of the part, level): ns, or a pure number


@dataclasses.dataclass(frozen=True)
class Quantity:
    key: str
    part: str    # the benchmark that measures it: a key of PARTS
    table: str   # a key of TABLES
    text: str
    unit: str    # a time, "times" or "frames/s"
    value: Optional[Reader] = None
    aim: Optional[Aim] = None
    ratio: Optional[Reader] = None
    compared_with: str = ""  # the row of the ratio, for example "the same written plainly: times as long"
    ratio_aim: Optional[Aim] = None

    def key_at(self, level):
        return self.key.format(level=level)

    def levels(self):
        return LEVELS if self.key.endswith("/{level}") else [""]


# --- readers ---

def cpu(name):
    return lambda times, level: times.ns.get(name.format(level=level))


def wall(name):
    return lambda times, level: times.wall_ns.get(name.format(level=level))


def counter(name, key):
    return lambda times, level: times.counters.get(name.format(level=level), {}).get(key)


def over(numerator, denominator):
    def read(times, level):
        above, below = numerator(times, level), denominator(times, level)
        return above / below if above is not None and below else None
    return read


def scaled(reader, factor):
    def read(times, level):
        value = reader(times, level)
        return None if value is None else factor * value
    return read


def extreme(choose, prefix):
    def read(times, _):
        values = [ns for name, ns in times.ns.items() if name.startswith(prefix)]
        return choose(values) if values else None
    return read


def two_threads_wall(name):
    """Wall-clock time, if no other program had the processor of the thread that waits for the other one."""
    def read(times, level):
        name_ = name.format(level=level)
        seconds, own = times.wall_ns.get(name_), times.ns.get(name_)
        return seconds if seconds is not None and own >= LEAST_SHARE * seconds else None
    return read


# --- entries of stored files ---

def entry(quantity, level, value, ratio):
    """As it is stored. value, ratio: None if only the other one is known."""
    fields = {}
    if value is not None:
        value = rounded(value)
        fields |= {"value": value, "unit": quantity.unit}
        if quantity.aim and quantity.aim.at(level) is not None:
            fields |= {"aim": quantity.aim.text(level), "met": quantity.aim.is_met(value, level)}
    if ratio is not None:
        ratio = rounded(ratio)
        fields |= {"compared_with": quantity.compared_with, "ratio": ratio}
        if quantity.ratio_aim and quantity.ratio_aim.at(level) is not None:
            fields |= {"ratio_aim": quantity.ratio_aim.text(level), "ratio_met": quantity.ratio_aim.is_met(ratio, level)}
    return fields


def rounded(number):
    number = float(f"{number:.3g}")
    return int(number) if number == int(number) else number

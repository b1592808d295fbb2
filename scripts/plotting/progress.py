"""Reads progress.json, which `remote-touch figure` keeps in its folder while it makes figures."""
import dataclasses
import json
import math


@dataclasses.dataclass(frozen=True)
class Progress:
    left_s: float  # 0: not known
    figures: list  # name, summary, state (waiting, running, done), left_s

    def to_come(self):
        """The names of their files."""
        return {f"fig{entry['name']}" for entry in self.figures if entry["state"] != "done"}


def is_entry(entry):
    return (isinstance(entry, dict) and all(isinstance(entry.get(name), str) for name in ("name", "summary", "state"))
            and is_time(entry.get("left_s")))


def is_time(value):
    return isinstance(value, (int, float)) and math.isfinite(value)


def read_progress(path):
    """None where no figures are being made."""
    try:
        stored = json.loads(path.read_text(encoding="utf-8"))
        progress = Progress(stored["left_s"], stored["figures"])
        complete = is_time(progress.left_s) and isinstance(progress.figures, list) and all(map(is_entry, progress.figures))
    except (FileNotFoundError, ValueError, KeyError, TypeError, RecursionError, OverflowError):
        return None
    return progress if complete else None


def duration(seconds):
    return f"about {max(1, round(seconds))} s" if seconds < 100 else f"about {round(seconds / 60)} min"

"""Reads progress.json, which `remote-touch figure` keeps in its folder while it makes figures."""
import dataclasses
import json


@dataclasses.dataclass(frozen=True)
class Progress:
    left_s: float  # 0: not known
    figures: list  # name, summary, state (waiting, running, done), left_s

    def to_come(self):
        """The names of their files."""
        return {f"fig{entry['name']}" for entry in self.figures if entry["state"] != "done"}


def read_progress(path):
    """None where no figures are being made."""
    try:
        stored = json.loads(path.read_text(encoding="utf-8"))
        return Progress(stored["left_s"], stored["figures"])
    except (FileNotFoundError, ValueError, KeyError, TypeError):
        return None


def duration(seconds):
    return f"about {max(1, round(seconds))} s" if seconds < 100 else f"about {round(seconds / 60)} min"

"""The states of the runs of a sweep. A run of an unfinished sweep whose checksum is wrong counts as not made."""
import numpy as np

from .figure_file import text
from .results import dataset

PENDING, DONE = 1, 2


def checksums(file, state):
    """Returns the checksums that the runs should have: FNV-1a over number, state, values and notes, as in sweep_file.cpp."""
    runs = dataset(file, "/sweep/run")[()] if "/sweep/run" in file else np.arange(state.size)
    words = [runs, state, *(dataset(file, f"/sweep/{name}")[()].view(np.uint64) for name in text(file.attrs, "measures").split(","))]
    if "/sweep/notes" in file:
        notes = dataset(file, "/sweep/notes")[()]  # 32 bits for each run, or 64
        words.append(notes.view(f"u{notes.dtype.itemsize}"))
    sums = np.full(state.size, 2166136261, dtype=np.uint32)
    for word in words:
        for byte in np.ravel(word).astype("<u8").view(np.uint8).reshape(-1, 8).T:
            sums = (sums ^ byte) * np.uint32(16777619)
    return sums.reshape(state.shape)


def read_states(file):
    """Returns the states of the runs in the file; PENDING for a run with a wrong checksum."""
    state = dataset(file, "/sweep/state")[()]
    if "/sweep/checksum" not in file:
        return state
    return np.where(checksums(file, state) == dataset(file, "/sweep/checksum")[()].view(np.uint32), state, PENDING)

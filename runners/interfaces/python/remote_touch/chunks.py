"""Lets the workers of a concurrent.futures.Executor do the runs of a sweep, in chunks. Only the calling process opens the file.

A chunk is a pure function of the sweep and of the numbers of its runs. So a lost worker loses a chunk, which is submitted
again, and nothing else.
"""
import collections
import concurrent.futures
import functools
import os
import socket
import threading
import time

import numpy as np

from remote_touch import _core
from remote_touch._core import InputError

CHUNK_S = 1.0  # time that a chunk should take
LOSSES = 5  # times that a chunk is submitted again while no other succeeds


@functools.lru_cache(maxsize=2)
def _worker_sweep(config, build):
    """The sweep, with the classes that this process has in this build."""
    return _core.WorkerSweep(config)


def do_runs(config, runs, number):
    """Does runs of a sweep, on one thread, and returns their outcomes, and who made them, as a dict of plain values.

    config: the complete JSON of the sweep. runs: an array of their numbers. number: another one in each call; the outcome
    does not depend on it, but an engine that remembers results by arguments has to compute this chunk.
    """
    made = {"build": _core.build(), "worker": f"{socket.gethostname()}/{os.getpid()}", "thread": threading.get_native_id()}
    try:
        sweep = _worker_sweep(config, tuple(made["build"]))
    except InputError as error:  # of another build, or without the recording
        return {**made, "problem": str(error)}
    begin_s = time.perf_counter()
    states, values, notes, errors = sweep.do_runs(runs)
    if _core.build() != made["build"]:
        return {**made, "problem": "a class was registered while the worker made these runs"}
    return {**made, "inputs": sweep.inputs, "states": states, "values": values, "notes": notes, "errors": errors,
            "seconds": time.perf_counter() - begin_s}


class _Chunk:
    def __init__(self, runs, first=None):
        self.runs = runs
        self.first = first  # the outcome of its only run, and its worker, if the run is made again as a check
        self.repeats = self.losses = self.successes = 0


class Engine:
    """One call of rt.sweep with an executor. do_round() is called for the runs of each round, or batch of a tally."""

    def __init__(self, executor, chunk, output, report):
        self.executor, self.fixed, self.output, self.report = executor, chunk, output, report
        self.size, self.number = chunk or 1, 0
        self.build = _core.build()
        self.made_by = collections.defaultdict(list)  # worker: the runs of its chunks that can be forgotten
        self.made_for_good = set()  # workers whose earlier runs are added up in a tally
        self.seen = {}  # (worker, thread): when its last chunk arrived, the latest last
        self.checked = self.checked_by_another = self.successes = 0
        self._submit(os.getpid)  # starts forked workers before the file is locked: they would hold the lock, too

    def do_round(self, config, inputs, pending, done, total, is_tally, store, forget):
        """Does the pending runs. The arguments: see WorkElsewhere in sweeps.cpp."""
        self.config, self.inputs, self.pending, self.store, self.forget = config, inputs, pending, store, forget
        self.done, self.ended, self.total, self.next = done, done, total, 0
        self.is_tally = is_tally
        if is_tally:
            self.made_for_good.update(self.made_by)
            self.made_by.clear()
        self.to_check, self.again, flying = _chosen(pending, 1 if is_tally else 100), collections.deque(), {}
        self.unchecked = len(self.to_check)
        try:
            while True:
                # Three chunks for each worker that answered lately. More workers answer, so that this number grows.
                while len(flying) < 4 + 3 * len(self.seen) and (chunk := self._next_chunk()):
                    self.number += 1
                    flying[self._submit(do_runs, config, chunk.runs, self.number)] = chunk
                if not flying:
                    return
                ready, _ = concurrent.futures.wait(flying, return_when=concurrent.futures.FIRST_COMPLETED)
                for future in sorted(ready, key=_is_lost):
                    chunk = flying.pop(future)
                    if _is_lost(future):
                        error = concurrent.futures.CancelledError() if future.cancelled() else future.exception()
                        self._lose(chunk, f"{type(error).__name__}: {error}", error)
                    else:
                        self._take(chunk, future.result())
        except BaseException:
            self._drop_unchecked()
            raise
        finally:
            for future in flying:
                future.cancel()

    def _drop_unchecked(self):
        """Forgets the runs of a batch of a tally whose checks have not all passed. A sweep that keeps its runs keeps them all."""
        if self.is_tally and self.unchecked and self.made_by:
            runs = np.concatenate([runs for of_worker in self.made_by.values() for runs in of_worker])
            self.forget(runs, "")
            self.done -= len(runs)
            self.made_by.clear()

    def _submit(self, *call):
        try:
            future = self.executor.submit(*call)
        except Exception as error:
            raise self._end(f"{type(error).__name__}: {error}") from error
        if not isinstance(future, concurrent.futures.Future):
            raise self._end(f"its submit() returned {type(future).__name__} instead of a Future")
        return future

    def _next_chunk(self):
        if self.again:
            return self.again.popleft()
        runs = self.pending[self.next:self.next + self.size]
        self.next += len(runs)
        return _Chunk(runs) if len(runs) else None

    def _lose(self, chunk, why, error=None):
        if chunk.successes != self.successes:
            chunk.losses, chunk.successes = 0, self.successes
        chunk.losses += 1
        if isinstance(error, concurrent.futures.BrokenExecutor) or chunk.losses > LOSSES:
            raise self._end(why) from error
        self.again.append(chunk)

    def _end(self, why):
        if hasattr(self, "done"):
            self._drop_unchecked()
        stored = f"{self.done} of {self.total} runs are" if hasattr(self, "done") else "no new run is"
        why = " ".join(why.split())
        return concurrent.futures.BrokenExecutor(f"{self.output}: {stored} stored, and the same call continues; the executor "
                                                 f"does no more work ({why})")

    def _take(self, chunk, made):
        if not _is_whole(made, len(chunk.runs)):
            raise self._damage(chunk.runs)
        worker, theirs = made["worker"], dict(made["build"])
        for name, ours in self.build:
            self._require_same(worker, name, theirs.get(name), ours)
        if "problem" in made:
            self._lose(chunk, f"worker {worker}: {made['problem']}")
            return
        self._require_same(worker, "recordings", made["inputs"], self.inputs)
        self.successes += 1
        self._see(worker, made)
        if chunk.first:
            self._compare(chunk, made)
        else:
            self._store(chunk.runs, made)

    def _damage(self, runs):
        return InputError(f"{self.output}: a chunk: damaged: expected an outcome for each of its runs {_ranges(runs)}; none of them "
                          "is stored, and the same call makes them again")

    def _require_same(self, worker, name, theirs, ours):
        if theirs != ours:
            raise InputError(f"worker {worker}: its {name} is {theirs!r}, here it is {ours!r}: expected workers with the same "
                             "build, classes and recordings")

    def _see(self, worker, made):
        now_s = time.monotonic()
        self.seen.pop((worker, made["thread"]), None)
        self.seen[worker, made["thread"]] = now_s
        while self.seen[oldest := next(iter(self.seen))] < now_s - 20 * max(CHUNK_S, made["seconds"]):
            del self.seen[oldest]

    def _store(self, runs, made):
        self.store(runs, made["states"], made["values"], made["notes"], made["errors"])
        self.made_by[made["worker"]].append(runs)
        self.done += int((made["states"] == 2).sum())
        self.ended += len(runs)
        for at in np.flatnonzero(np.isin(runs, self.to_check)):
            self.again.append(_Chunk(runs[at:at + 1], (_outcome(made, at), made["worker"])))
        if not self.fixed:  # small at the end, so that all workers end at the same time
            fair = (len(self.pending) - self.next) / (2 * len(self.seen))
            self.size = int(max(1, min(CHUNK_S * len(runs) / max(made["seconds"], 1e-9), 4 * len(runs), fair)))
        if self.report:
            self.report(self.ended / self.total)

    def _compare(self, chunk, made):
        (outcome, worker), again = chunk.first, _outcome(made, 0)
        if again != outcome:
            self._refuse(int(chunk.runs[0]), outcome, worker, again, made["worker"])
        is_another = made["worker"] != worker
        workers = self.made_for_good.union(self.made_by)
        if not is_another and len(workers) > 1 and chunk.repeats < 2:  # another one may have it next time
            chunk.repeats += 1
            self.again.append(chunk)
            return
        self.checked += 1
        self.unchecked -= 1
        self.checked_by_another += is_another

    def _refuse(self, run, outcome, worker, again, other):
        runs = np.unique(np.concatenate(self.made_by[worker] + (self.made_by[other] if other != worker else [])))
        is_late = bool({worker, other} & self.made_for_good)
        self.forget(runs, f"run {run} differs between the workers {worker} and {other}" if is_late else "")
        earlier = "; the tally also has earlier runs by them: expected a new file" if is_late else ""
        raise RuntimeError(f"{self.output}: run {run} has {_text(outcome)} by worker {worker}, but {_text(again)} by worker "
                           f"{other}: one of them computes wrongly; the {len(runs)} runs that they made are pending again: "
                           f"{_ranges(runs)}{earlier}")


_FORM = {"build": (list, tuple), "worker": str, "thread": int}
_OUTCOME = {"inputs": str, "states": np.ndarray, "values": np.ndarray, "notes": np.ndarray, "errors": list, "seconds": float}


def _is_whole(made, count):
    """True if made has the form of what do_runs() returns for `count` runs, as far as it can be checked without the sweep."""
    if not isinstance(made, dict):
        return False
    form = _FORM if "problem" in made else _FORM | _OUTCOME
    if not all(isinstance(made.get(name), kind) for name, kind in form.items()):
        return False
    if not all(isinstance(pair, (list, tuple)) and len(pair) == 2 and isinstance(pair[0], str) for pair in made["build"]):
        return False
    if "problem" in made:
        return True
    states, values, notes = made["states"], made["values"], made["notes"]
    return (states.shape == notes.shape == (count,) and states.dtype.kind == "i" and notes.dtype.kind == "u" and values.ndim == 2
            and values.shape[1] == count and values.dtype == np.float64 and made["seconds"] >= 0
            and len(made["errors"]) == count and all(isinstance(text, str) for text in made["errors"]))


def _is_lost(future):
    return future.cancelled() or future.exception() is not None


def _chosen(runs, least):
    """One run of each thousand numbers; the first run if that is none and there are at least so many."""
    chosen = runs[runs % 1000 == (99 + 7 * (runs // 1000)) % 1000]
    return chosen if len(chosen) or len(runs) < least else runs[:1]


def _outcome(made, at):
    return int(made["states"][at]), made["values"][:, at].tobytes(), int(made["notes"][at])


def _text(outcome):
    state, values, notes = outcome
    return f"state {state}, values {np.frombuffer(values).tolist()} and notes {notes}"


def _ranges(runs):
    parts = np.split(runs, np.flatnonzero(np.diff(runs) > 1) + 1)
    texts = [str(part[0]) if len(part) == 1 else f"{part[0]}-{part[-1]}" for part in parts]
    return ", ".join(texts[:20]) + (f" and {len(texts) - 20} more ranges" if len(texts) > 20 else "")

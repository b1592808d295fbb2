"""Sweeps by the workers of executors: the same bytes as by the command line, whatever workers do to their chunks."""
import concurrent.futures
import copy
import json
import os
import pathlib
import random
import re
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest
import remote_touch as rt
from class_scripts import COMMON
from conftest import PRESS, assert_same_file
from remote_touch import chunks

SWEEP = {
    "title": "presses",
    "experiment": {**PRESS, "duration_s": 0.1},
    "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.002, "count": 3},
             {"parameter": "renderer.steps_per_tick", "values": [5, 30]}],
    "replicates": 40,
    "measures": ["max_force", "popped_through"],
}
REFINED = {
    "title": "refined", "experiment": "fig4.12", "set": {"haptic_rate_hz": 900, "renderer.steps_per_tick": 1},
    "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.015, "count": 4},
             {"parameter": "scenario.acceleration_m_per_s2", "from": 0, "to": 7, "count": 5}],
    "replicates": 6, "measures": ["popped_through", "max_penetration"],
    "refine": {"measure": "popped_through", "budget": 220, "max_replicates": 12, "levels": 1},
}
TALLY = {**SWEEP, "keep": "events"}
PLANS = {"plain": SWEEP, "refined": REFINED, "tally": TALLY}


@pytest.fixture(scope="module", params=PLANS)
def plan(request, command_line, tmp_path_factory):
    """The file of a sweep, and the result of the command line."""
    folder = tmp_path_factory.mktemp(request.param)
    file = folder / "sweep.json"
    file.write_text(json.dumps(PLANS[request.param]))
    command_line("sweep", file, "-o", folder / "command.h5")
    return file, folder / "command.h5"


def states_in(file):
    return rt.open(file).state.values.ravel()


def done_and_asked(file):
    """The numbers of runs that the file has, and that it has when it is finished."""
    stored = rt.open(file)
    if "runs" in stored:
        return int(stored.runs.sum()), 240
    return int((stored.state == 2).sum()), int((stored.state != 0).sum())


class Workers(concurrent.futures.Executor):
    """Does each chunk at once, as workers that take turns. change(number, made, is_check) alters or loses what one has made."""

    def __init__(self, change=lambda number, made, is_check: made, workers=3):
        self.change, self.workers, self.number, self.known = change, workers, 0, set()

    def submit(self, function, *arguments):
        future = concurrent.futures.Future()
        if function is not chunks.do_runs:
            return future
        self.number += 1
        try:
            made = {**function(*arguments), "worker": f"w{self.number % self.workers}"}
            runs = {*arguments[1].tolist()}
            future.set_result(self.change(self.number, made, runs <= self.known))
            self.known |= runs
        except OSError as lost:
            future.set_exception(lost)
        return future


def test_processes_give_the_bytes_of_the_command_line(plan, tmp_path):
    """They are forked after OpenMP has made threads in this process, which a child does not have."""
    file, expected = plan
    rt.sweep(SWEEP, threads=2)
    fractions = []
    with concurrent.futures.ProcessPoolExecutor(2) as pool:
        sweep = rt.sweep(file, output=tmp_path / "map.h5", executor=pool, progress=fractions.append)
    assert_same_file(tmp_path / "map.h5", expected)
    assert fractions[-1] == 1
    assert sweep.attrs["checked_runs"] >= sweep.attrs["checked_by_another_worker"] >= 0 and sweep.attrs["checked_runs"] >= 1
    assert sweep.equals(rt.open(expected))


def test_threads_are_workers_too_and_few_chunks_wait(plan, tmp_path):
    file, expected = plan
    waiting, most, lock = 0, 0, threading.Lock()

    class Counting(concurrent.futures.ThreadPoolExecutor):
        def submit(self, *call):
            nonlocal waiting, most
            with lock:
                waiting += 1
                most = max(most, waiting)
            future = super().submit(*call)
            future.add_done_callback(ended)
            return future

    def ended(_):
        nonlocal waiting
        with lock:
            waiting -= 1
    with Counting(2) as pool:
        sweep = rt.sweep(file, output=tmp_path / "map.h5", executor=pool, chunk=1)
    assert_same_file(tmp_path / "map.h5", expected)
    assert sweep.attrs["checked_runs"] >= 1 and sweep.attrs["checked_by_another_worker"] == 0
    assert 2 < most <= 4 + 3 * 2 + 1  # of some hundred chunks, and the first call


def test_runs_that_passed_a_check_stay_when_the_call_ends(plan, tmp_path):
    """In a sweep each stored run stays; in a tally the batches whose checks have passed."""
    file, expected = plan

    def stop(fraction):
        if fraction > 0.6:  # after the check of run 99
            raise KeyboardInterrupt
    with pytest.raises(KeyboardInterrupt):
        rt.sweep(file, output=tmp_path / "map.h5", executor=Workers(), chunk=2, progress=stop)
    done, asked = done_and_asked(tmp_path / "map.h5")
    is_tally = "keep" in json.loads(file.read_text())
    assert done >= 112 if is_tally else done > 0.6 * asked - 2
    rt.sweep(file, output=tmp_path / "map.h5", executor=Workers())
    assert_same_file(tmp_path / "map.h5", expected)


def test_lost_chunks_are_done_again(plan, tmp_path):
    file, expected = plan
    drawn, lost = random.Random(1), []

    def lose(number, made, is_check):
        if drawn.random() < 0.3:
            lost.append(number)
            raise OSError("the worker is away")
        return made
    rt.sweep(file, output=tmp_path / "map.h5", executor=Workers(lose), chunk=3)
    assert len(lost) > 10
    assert_same_file(tmp_path / "map.h5", expected)


def test_an_executor_that_loses_everything_ends_the_call(plan, tmp_path):
    file, expected = plan

    def lose(number, made, is_check):
        if number > 5:
            raise OSError("the worker\nis away")
        return made
    workers = Workers(lose)
    with pytest.raises(concurrent.futures.BrokenExecutor) as raised:
        rt.sweep(file, output=tmp_path / "map.h5", executor=workers, chunk=3)
    done, asked = done_and_asked(tmp_path / "map.h5")
    is_tally = "runs" in rt.open(tmp_path / "map.h5")
    assert done == (12 if is_tally else 15)  # of a tally, one of the five chunks is a check
    assert str(raised.value) == (
        f"{tmp_path / 'map.h5'}: {done} of {asked} runs are stored, and the same call continues; the executor does no "
        "more work (OSError: the worker is away)")
    assert workers.number <= 5 + (4 + 3 * 3) * (chunks.LOSSES + 1)
    rt.sweep(file, output=tmp_path / "map.h5", executor=Workers())
    assert_same_file(tmp_path / "map.h5", expected)


def do_or_die(dies, function, *arguments):
    if dies:
        os.kill(os.getpid(), signal.SIGKILL)
    return function(*arguments)


class Deadly(concurrent.futures.ProcessPoolExecutor):
    """A pool, one of whose workers kills itself when it gets that chunk."""

    def __init__(self, chunk):
        super().__init__(2)
        self.chunk, self.number = chunk, -1

    def submit(self, function, *arguments):
        self.number += 1
        return super().submit(do_or_die, self.number == self.chunk, function, *arguments)


@pytest.mark.parametrize("chunk", [1, 12])
def test_a_killed_process_loses_no_stored_run(plan, chunk, tmp_path):
    file, expected = plan
    output = tmp_path / "map.h5"
    with Deadly(chunk) as pool, pytest.raises(concurrent.futures.BrokenExecutor) as raised:
        rt.sweep(file, output=output, executor=pool, chunk=2)
    stored = done_and_asked(output)[0] if output.exists() else 0
    assert stored < 120 and (stored > 0 or chunk == 1)
    assert f"map.h5: {stored} of " in str(raised.value) and "the same call continues" in str(raised.value)
    with pytest.raises(concurrent.futures.BrokenExecutor, match="no new run is stored"):
        rt.sweep(file, output=output, executor=pool)  # the same pool, which is broken
    with concurrent.futures.ProcessPoolExecutor(2) as pool:
        rt.sweep(file, output=output, executor=pool)
    assert_same_file(output, expected)


def test_an_interrupted_call_continues_on_the_command_line(plan, command_line, tmp_path):
    file, expected = plan
    output = tmp_path / "map.h5"

    def stop(fraction):
        if fraction > 0.3:
            raise KeyboardInterrupt
    with concurrent.futures.ProcessPoolExecutor(2) as pool:
        with pytest.raises(KeyboardInterrupt):
            rt.sweep(file, output=output, executor=pool, chunk=2, progress=stop)
        done, asked = done_and_asked(output)
        assert 0 < done < asked
    command_line("sweep", file, "-o", output)
    assert_same_file(output, expected)


def test_workers_that_outlive_a_killed_call_do_not_hold_its_file(command_line, tmp_path):
    file = tmp_path / "sweep.json"
    file.write_text(json.dumps(SWEEP))
    script = '''
import concurrent.futures, os, signal, sys
import remote_touch as rt
pool = concurrent.futures.ProcessPoolExecutor(2)
def die(fraction):
    print(*pool._processes, flush=True)
    os.kill(os.getpid(), signal.SIGKILL)
rt.sweep(sys.argv[1], output="map.h5", executor=pool, progress=die)
'''
    with subprocess.Popen([sys.executable, "-B", "-c", script, file], cwd=tmp_path, stdout=subprocess.PIPE, text=True) as call:
        workers = [int(pid) for pid in call.stdout.readline().split()]
    try:
        assert len(workers) == 2 and call.returncode == -signal.SIGKILL
        assert all(pathlib.Path(f"/proc/{pid}").exists() for pid in workers)
        command_line("sweep", file, "-o", tmp_path / "map.h5")
    finally:
        for pid in workers:
            os.kill(pid, signal.SIGKILL)
    command_line("sweep", file, "-o", tmp_path / "whole.h5")
    assert_same_file(tmp_path / "map.h5", tmp_path / "whole.h5")


def test_a_run_that_differs_when_made_again_names_both_workers(plan, tmp_path):
    """The last bit of a value is another one the second time. What both workers made is done again."""
    file, expected = plan
    output = tmp_path / "map.h5"

    def flip(number, made, is_check):
        if is_check:
            made["values"].view(np.uint64)[...] ^= 1
        return made
    with pytest.raises(RuntimeError) as raised:
        rt.sweep(file, output=output, executor=Workers(flip), chunk=2)
    text, is_tally = str(raised.value), "keep" in json.loads(file.read_text())
    form = (rf"map\.h5: run {0 if is_tally else 99} has state 2, values \[(.*)\] and notes (\d+) by worker (w\d), but state 2, values \[(.*)\] and "
            r"notes \2 by worker (w\d): one of them computes wrongly; the (\d+) runs that they made are pending again: ([-\d, ]+)"
            r"( and \d+ more ranges)?$")
    found = re.search(form, text)
    assert found and found.group(1) != found.group(4)
    if is_tally:
        assert not output.exists()  # the first batch has not passed its check
    else:
        done, asked = done_and_asked(output)
        assert asked - done >= int(found.group(6)) > 0 and done > 0  # of a third worker: it is still there
        assert states_in(output)[int(found.group(7).split("-")[0].split(",")[0])] == 1
    rt.sweep(file, output=output, executor=Workers())
    assert_same_file(output, expected)


def test_a_difference_in_a_later_round_takes_back_the_rounds_that_rest_on_it(command_line, tmp_path, monkeypatch):
    (tmp_path / "sweep.json").write_text(json.dumps(REFINED))
    command_line("sweep", tmp_path / "sweep.json", "-o", tmp_path / "command.h5")
    checks = []
    monkeypatch.setattr(chunks, "_chosen", lambda runs, least: runs[:1])  # in each round

    def wrong_late(number, made, is_check):
        if is_check:
            checks.append(number)
            if len(checks) == 2:
                made["notes"][:1] ^= np.uint64(1)
        return made
    output = tmp_path / "map.h5"
    with pytest.raises(RuntimeError, match="made are pending again"):
        rt.sweep(tmp_path / "sweep.json", output=output, executor=Workers(wrong_late, 1), chunk=100)
    stored = rt.open(output)
    assert set(np.unique(stored["round"])) == {-1, 0} and set(np.unique(stored.state)) == {0, 1}
    rt.sweep(tmp_path / "sweep.json", output=output, executor=Workers())
    assert_same_file(output, tmp_path / "command.h5")


def test_results_of_another_build_are_refused(plan, tmp_path):
    file, expected = plan
    output = tmp_path / "map.h5"

    def foreign(number, made, is_check):
        if number > 4:
            made["build"] = [(name, "clang 99" if name == "compiler" else value) for name, value in made["build"]]
        return made
    with pytest.raises(rt.InputError) as raised:
        rt.sweep(file, output=output, executor=Workers(foreign), chunk=2)
    ours = rt.open(expected).attrs["compiler"]
    assert str(raised.value)[9:] == (f": its compiler is 'clang 99', here it is {ours!r}: expected workers with the same build, "
                                     "classes and recordings")
    is_tally = "keep" in json.loads(file.read_text())  # which has no run that was not checked
    assert output.exists() != is_tally and (is_tally or done_and_asked(output)[0] == 8)
    rt.sweep(file, output=output, executor=Workers())
    assert_same_file(output, expected)


def test_a_damaged_chunk_is_refused(tmp_path):
    def cut(number, made, is_check):
        made["values"] = made["values"][:1]
        return made
    with pytest.raises(rt.InputError, match="a chunk: damaged: expected an outcome for each of its runs"):
        rt.sweep(SWEEP, output=tmp_path / "map.h5", executor=Workers(cut))


GARBAGE = [None, 3, "text", [], {}, np.zeros(3), {"worker": "w", "thread": 1, "build": []}, {"worker": "w", "thread": 1, "build": [1]},
           lambda made: {**made, "states": "done"}, lambda made: {**made, "errors": [None] * len(made["states"])},
           lambda made: {**made, "values": made["values"].astype(object)}, lambda made: {**made, "seconds": float("nan")},
           lambda made: {**made, "notes": made["notes"][:0]}, lambda made: {**made, "states": made["states"] + 5}]


@pytest.mark.parametrize("garbage", GARBAGE)
@pytest.mark.parametrize("sweep", [SWEEP, TALLY])
def test_garbage_instead_of_a_chunk_is_refused_in_one_line(sweep, garbage, tmp_path):
    """The line names the runs, and the same call makes them again."""
    def spoil(number, made, is_check):
        return made if number != 3 else garbage(made) if callable(garbage) else garbage
    with pytest.raises(rt.InputError) as raised:
        rt.sweep(sweep, output=tmp_path / "map.h5", executor=Workers(spoil), chunk=2)
    text = str(raised.value)
    assert re.search(r"a chunk: damaged: .* runs?,? .*\d.*; none of them is stored, and the same call makes them again$", text)
    assert "\n" not in text
    rt.sweep(sweep, output=tmp_path / "map.h5", executor=Workers())


def test_an_executor_without_futures_is_refused(tmp_path):
    class Forgetful(Workers):
        def submit(self, function, *arguments):
            super().submit(function, *arguments)
    with pytest.raises(concurrent.futures.BrokenExecutor, match=r"no new run is stored, .*its submit\(\) returned NoneType instead"):
        rt.sweep(SWEEP, output=tmp_path / "map.h5", executor=Forgetful())


def test_failed_runs_are_stored_with_their_reason(command_line, tmp_path):
    failing = copy.deepcopy(SWEEP)
    failing["axes"] = [{"parameter": "trajectory.depth_m", "values": [0.001, 0.002]}]
    failing["experiment"] = {**PRESS, "scenario": {"name": "box"}}  # which has no height to press at
    failing["replicates"] = 2
    with pytest.warns(UserWarning, match="4 of 4 runs failed, the first: .*expected"):
        by_workers = rt.sweep(failing, output=tmp_path / "map.h5", executor=Workers())
    with pytest.warns(UserWarning):
        here = rt.sweep(failing, output=tmp_path / "here.h5")
    assert (by_workers.error.values == here.error.values).all()
    assert_same_file(tmp_path / "map.h5", tmp_path / "here.h5")


def test_one_run_of_a_thousand_is_checked():
    numbers = np.arange(10**6, dtype=np.uint64)
    assert len(chunks._chosen(numbers, 100)) == 1000
    assert len(np.unique(chunks._chosen(numbers, 100) // 1000)) == 1000
    for few in (numbers[:100], numbers[200:300], numbers[:7000:7][:100]):
        assert len(chunks._chosen(few, 100)) >= 1
    assert len(chunks._chosen(numbers[:99], 100)) == 0 and len(chunks._chosen(numbers[:99], 1)) == 1


@pytest.mark.parametrize("arguments, problem", [
    ({"executor": 3, "output": "a.h5"}, "expected a concurrent.futures.Executor"),
    ({"executor": Workers()}, "and an output"),
    ({"executor": Workers(), "output": "a.h5", "threads": 2}, "expected no threads"),
    ({"executor": Workers(), "output": "a.h5", "chunk": 0}, "chunk = 0: expected 1 to"),
    ({"chunk": 4}, "expected an executor"),
])
def test_wrong_arguments_are_refused(arguments, problem):
    with pytest.raises(rt.InputError, match=problem):
        rt.sweep(SWEEP, **arguments)


OWN = COMMON + '''
import concurrent.futures, importlib, multiprocessing, pathlib, sys
pathlib.Path("mine.py").write_text("""
import remote_touch as rt
@rt.register
class Mine(rt.Renderer):
    def step(self, device, time_s):
        return rt.Output(force_N=(0, device.position_m[1], 0))
    def max_stiffness_N_per_m(self):
        return 1
""")
sys.path.insert(0, ".")
import mine
sweep = {"title": "own", "experiment": {**PRESS, "renderer": {"name": "mine"}}, "measures": ["max_force"],
         "axes": [{"parameter": "scenario.noise_sigma_m", "values": [0, 0.001]}]}
def by(pool, file):
    with pool:
        return rt.sweep(sweep, output=file, executor=pool)
Pool, spawn = concurrent.futures.ProcessPoolExecutor, multiprocessing.get_context("spawn")
'''


def test_own_classes_are_registered_in_each_worker(in_python):
    out = in_python(OWN + '''
if __name__ == "__main__":
    try:
        by(Pool(1, spawn), "a.h5")
    except rt.InputError as error:
        print(error)
    known = by(Pool(1, spawn, initializer=importlib.import_module, initargs=("mine",)), "a.h5")
    forked = by(Pool(1, multiprocessing.get_context("fork")), "b.h5")
    print(known.attrs["digest"] == forked.attrs["digest"] == rt.sweep(sweep).attrs["digest"])
''')
    refusal, same = out.splitlines()
    assert "its program is '', here it is 'Python mine.py: Mine': expected workers with the same build, classes" in refusal
    assert same == "True"


def test_no_class_is_registered_while_workers_make_runs(in_python):
    in_python(COMMON + """
import concurrent.futures
def register():
    @rt.register("mine")
    class Mine(rt.Renderer):
        stiffness_N_per_m = 600
        def step(self, device, time_s): return rt.Output()
register()
sweep = {"title": "t", "experiment": {**PRESS, "renderer": {"name": "mine"}}, "replicates": 20,
         "axes": [{"parameter": "trajectory.depth_m", "values": [0.001, 0.002]}], "measures": ["max_force"]}
with concurrent.futures.ThreadPoolExecutor(1) as pool:
    try:
        rt.sweep(sweep, output="a.h5", executor=pool, progress=lambda done: register())
    except rt.InputError as error:
        assert "register: a run or a sweep is in progress" in str(error), error
    else:
        raise AssertionError
    assert (rt.sweep(sweep, output="a.h5", executor=pool).state == 2).all()
""")

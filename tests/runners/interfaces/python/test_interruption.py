"""Ctrl-C ends a run and a sweep at once with KeyboardInterrupt, and nothing half-written is left."""
import signal
import subprocess
import sys

import pytest
from class_scripts import COMMON

RUN = '''
import remote_touch as rt, sys
def begun(fraction):
    print("begun", flush=True)
print("go", flush=True)
try:
    {call}
except KeyboardInterrupt:
    print("interrupted", flush=True)
    # The interpreter is as it was: the next call works.
    print(rt.run("fig4.12", set={{"duration_s": 0.05}}).sizes["time"], flush=True)
'''
SLOW = '''
class Slow(rt.Renderer):
    def step(self, device, time_s):
        return rt.Output()
    def max_stiffness_N_per_m(self):
        return 0
'''
LONG = '{"duration_s": 3000, "renderer.steps_per_tick": 30}'
SWEEP = ('{"title": "long", "experiment": "fig4.12", "set": {"duration_s": 3000}, "replicates": 4, '
         '"axes": [{"parameter": "scenario.noise_sigma_m", "values": [0, 0.001]}], "measures": ["max_force"]}')
CALLS = {
    "run": f'rt.run("fig4.12", set={LONG}, output="a.h5", progress=begun)',
    "sweep": f'rt.sweep({SWEEP}, threads=2, progress=begun)',
    "class": 'exec(' + repr(SLOW) + '); rt.register(Slow); rt.run("fig4.12", set={"duration_s": 3000, "renderer": '
             '{"name": "slow"}}, output="a.h5", progress=begun)',
}


@pytest.mark.parametrize("call", CALLS)
def test_ctrl_c(call, tmp_path):
    with subprocess.Popen([sys.executable, "-B", "-c", RUN.format(call=CALLS[call])], cwd=tmp_path, stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True) as child:
        assert child.stdout.readline() == "go\n"
        assert child.stdout.readline() == "begun\n"  # the work goes on in its thread
        child.send_signal(signal.SIGINT)
        out, problems = child.communicate(timeout=600)  # which only ends a test that hangs
    assert out.replace("begun\n", "") == "interrupted\n50\n", problems
    assert child.returncode == 0
    assert [*tmp_path.iterdir()] == []


def test_an_exception_of_the_progress_ends_the_run(in_python):
    in_python('''
import os
import remote_touch as rt
def gone(fraction):
    raise LookupError("enough")
try:
    rt.run("fig4.12", set={"duration_s": 3000}, output="a.h5", progress=gone)
except LookupError as error:
    assert str(error) == "enough" and os.listdir(".") == []
else:
    raise AssertionError
''')


def test_other_threads_of_python_go_on(in_python):
    """The lock of the interpreter is free while C++ runs: another thread counts on between two reports of the progress. It
    could count once if it had the lock during a report only. The run takes minutes unless that ends it."""
    in_python(f'''
import threading
import remote_touch as rt
counted, at_report, ended = [0], [], threading.Event()
def count():
    while not ended.is_set():
        counted[0] += 1
        ended.wait(0.001)
other = threading.Thread(target=count)
def look(fraction):
    at_report.append(counted[0])
    if len(at_report) > 1 and at_report[-1] - at_report[-2] >= 3:
        raise KeyboardInterrupt
other.start()
try:
    rt.run("fig4.12", set={LONG}, progress=look)
except KeyboardInterrupt:
    pass
else:
    raise AssertionError(f"counted at each report: {{at_report}}")
finally:
    ended.set()
    other.join()
''')


@pytest.mark.parametrize("threads", (1, 2, 3))
def test_a_sweep_takes_as_many_threads_as_it_may(in_python, threads):
    """As many runs wait for each other in their first tick, and no thread has more of them than its turn."""
    out = in_python(COMMON + f'''
import threading
meeting, seen = threading.Barrier({threads}), set()
@rt.register
class Meets(rt.Renderer):
    def __init__(self):
        self.has_met = False
    def step(self, device, time_s):
        if not self.has_met:
            self.has_met = True
            seen.add(threading.get_ident())
            meeting.wait(600)  # seconds, which only end a test that hangs
        return rt.Output()
    def max_stiffness_N_per_m(self):
        return 0
sweep = rt.sweep({{"title": "meetings", "experiment": {{**PRESS, "renderer": {{"name": "meets"}}}}, "replicates": {threads},
                   "axes": [{{"parameter": "scenario.noise_sigma_m", "values": [0, 0.001]}}], "measures": ["max_force"]}},
                 threads={threads})
assert (sweep.state == 2).all()
print(len(seen))
''')
    assert int(out) == threads

"""Ctrl-C ends a run and a sweep at once with KeyboardInterrupt, and nothing half-written is left."""
import signal
import subprocess
import sys

import pytest

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
        out, problems = child.communicate(timeout=60)
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
    """The lock of the interpreter is free while C++ runs."""
    in_python('''
import threading
import remote_touch as rt
rt.run("fig4.12", set={"duration_s": 0.05})
counted, ended = [0], threading.Event()
def count():
    while not ended.is_set():
        counted[0] += 1
        ended.wait(0.001)
other = threading.Thread(target=count)
other.start()
at_start = counted[0]
rt.run("fig4.12", set={"duration_s": 200})
at_end = counted[0]
ended.set()
other.join()
assert at_end - at_start > 20, at_end - at_start
''')


@pytest.mark.parametrize("threads", (1, 2, 3))
def test_a_sweep_takes_as_many_threads_as_it_may(in_python, threads):
    """Seen in the list of the process's threads while runs go on; the calling thread only waits for them.

    One process for each: threads of a sweep that has ended go a little later, and would be counted as there before.
    """
    out = in_python(f'''
import os
import remote_touch as rt
def threads_now():
    return len(os.listdir("/proc/self/task"))
before, most = threads_now(), 0
def look(fraction):
    global most
    most = max(most, threads_now() - before)
    if most >= {threads}:
        raise KeyboardInterrupt
try:
    rt.sweep({SWEEP}, threads={threads}, progress=look)
except KeyboardInterrupt:
    print(most)
''')
    assert int(out) == threads

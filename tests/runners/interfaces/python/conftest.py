"""What the tests of the Python package share: the program, whose results are the oracle, and small experiments."""
import json
import os
import pathlib
import re
import subprocess
import sys

import pytest

for name in ("REMOTE_TOUCH_ISA", "REMOTE_TOUCH_DATA", "OMP_NUM_THREADS", "PYTHONWARNINGS"):  # settings of the user
    os.environ.pop(name, None)
import remote_touch as rt  # noqa: E402: it reads the first two

ROOT = pathlib.Path(__file__).resolve().parents[4]
EXAMPLES = ROOT / "runners" / "interfaces" / "python" / "examples"
PAGE = ROOT / "runners" / "interfaces" / "python" / "README.md"
STUDY_PAGE = ROOT / "data" / "studies" / "README.md"

# A plane at rest, pressed by hand: milliseconds.
PRESS = {
    "scenario": {"name": "moving-lift", "noise_sigma_m": 0.001},
    "renderer": {"name": "proxy"},
    "trajectory": {"name": "press", "press_at_s": 0.05, "depth_m": 0.01},
    "duration_s": 0.2,
}


@pytest.fixture(scope="session")
def command_line():
    """Runs remote-touch with arguments; returns what it prints."""
    program = os.environ["REMOTE_TOUCH_PROGRAM"]

    def run(*arguments):
        done = subprocess.run([program, "-q", *map(str, arguments)], capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return done.stdout
    return run


# Runs scripts that it reads line by line, each in a fork of itself: what all of them import is imported once.
FORKS = """
import json, os, sys, types
import numpy, remote_touch, xarray
for line in sys.stdin:
    script, folder, output, *sys.argv[1:] = json.loads(line)
    child = os.fork()
    if child == 0:
        break
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
else:
    sys.exit()
os.chdir(folder)
for number, file in enumerate(("/dev/null", output + ".out", output + ".err")):
    os.dup2(os.open(file, os.O_RDWR | os.O_CREAT | os.O_TRUNC), number)
main = sys.modules["__main__"] = types.ModuleType("__main__")
exec(compile(script, "<string>", "exec"), vars(main))
"""


@pytest.fixture(scope="session")
def forks(tmp_path_factory):
    """Runs a script in a fork of an interpreter that no other script has changed; returns exit code, output and errors."""
    output = str(tmp_path_factory.mktemp("forks") / "script")
    with subprocess.Popen([sys.executable, "-B", "-c", FORKS], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as server:
        def run(script, folder, arguments):
            server.stdin.write(json.dumps([script, str(folder), output, *arguments]) + "\n")
            server.stdin.flush()
            return int(server.stdout.readline()), *(pathlib.Path(f"{output}.{end}").read_text() for end in ("out", "err"))
        yield run
        server.stdin.close()


@pytest.fixture
def in_python(tmp_path, forks):
    """Runs a script in a Python of its own, in an empty folder: what is registered there stays there. fresh: one that imports
    everything itself, with its own environment and order of sets."""
    def run(script, *arguments, code=0, fresh=False):
        arguments = [str(each) for each in arguments]
        if fresh:
            done = subprocess.run([sys.executable, "-B", "-c", script, *arguments], cwd=tmp_path, capture_output=True, text=True,
                                  check=False)
            ended, out, err = done.returncode, done.stdout, done.stderr
        else:
            ended, out, err = forks(script, tmp_path, arguments)
        assert ended == code, out + err
        return out
    return run


def digest_in(text):
    return re.search(r"digest ([0-9a-f]{64})", text).group(1)


def assert_same_file(a, b):
    """First what differs if module and program were built at different times."""
    for name, value in rt.open(a).attrs.items():
        assert rt.open(b).attrs[name] == value, f"{name}: build both, remote_touch_python and remote-touch"
    assert a.read_bytes() == b.read_bytes()

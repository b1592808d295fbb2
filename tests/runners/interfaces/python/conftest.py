"""What the tests of the Python package share: the program, whose results are the oracle, and small experiments."""
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


@pytest.fixture
def in_python(tmp_path):
    """Runs a script in a Python of its own, in an empty folder: what is registered there stays there."""
    def run(script, *arguments, code=0):
        done = subprocess.run([sys.executable, "-B", "-c", script, *map(str, arguments)], cwd=tmp_path, capture_output=True,
                              text=True, check=False)
        assert done.returncode == code, done.stdout + done.stderr
        return done.stdout
    return run


def digest_in(text):
    return re.search(r"digest ([0-9a-f]{64})", text).group(1)


def assert_same_file(a, b):
    """First what differs if module and program were built at different times."""
    for name, value in rt.open(a).attrs.items():
        assert rt.open(b).attrs[name] == value, f"{name}: build both, remote_touch_python and remote-touch"
    assert a.read_bytes() == b.read_bytes()

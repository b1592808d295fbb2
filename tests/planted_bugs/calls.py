"""Calls of programs, in an environment that holds nothing of the user's settings."""
import os
import shlex
import subprocess

JOBS = 2  # as tests/CMakeLists.txt reserves


class Failure(Exception):
    """One line for the row of a bug."""


def environment(root, bug=None):
    env = {key: value for key, value in os.environ.items()
           if key not in ("REMOTE_TOUCH_ISA", "REMOTE_TOUCH_PLANTED_BUG", "OMP_NUM_THREADS", "GLIBC_TUNABLES", "CXXFLAGS")}
    env.update(LC_ALL="C", OMP_NUM_THREADS="1")
    env.setdefault("REMOTE_TOUCH_DATA", str(root.parent / "shared" / "data"))
    if bug:
        env["REMOTE_TOUCH_PLANTED_BUG"] = bug
    return env


def output_of(command, folder, allowed=(0,), env=None):
    done = subprocess.run(command, cwd=folder, env=env, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode not in allowed:
        what = command if isinstance(command, str) else shlex.join(map(str, command))
        raise Failure(f"exit {done.returncode} of {what[-120:]}: {done.stdout.strip()[-1500:]}")
    return done.stdout

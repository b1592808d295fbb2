"""Runs the scripts of Node that drive headless Chromium, with the packages of the viewer's tests."""
import pathlib
import shutil
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
NOT_TRIED = 77


class NoBrowser(OSError):
    """There is no Chromium, no npm, or npm cannot get its packages."""


def chromium():
    found = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    if not found:
        raise NoBrowser("no Chromium (scripts/install site)")
    return found


def drive(script, *arguments):
    """Runs a script of this folder or of the viewer's tests; returns what it printed and whether it succeeded."""
    done = subprocess.run(["bash", "-euc", 'source "$1/packages.sh"; get_packages "$2" "$3"; cp "$1"/*.mjs "$2"/scripts/website/*.mjs .; '
                           'node "${@:4}"', "drive", ROOT / "tests/system/viewer", ROOT, ROOT / "build/pictures", script, *arguments],
                          stdout=subprocess.PIPE, text=True, check=False)
    if done.returncode == NOT_TRIED:
        raise NoBrowser(done.stdout.strip())
    return done.stdout, done.returncode == 0


def take_pictures(script, *arguments):
    printed, is_fine = drive(script, *arguments)
    if not is_fine:
        raise OSError(f"{script} took no pictures: {printed}")

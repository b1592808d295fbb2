#!/usr/bin/python3
"""Builds and runs the tests that can notice what changed: by the rooms and their includes.

Usage: run_changed.py BUILD_FOLDER [COMMIT]      what changed since COMMIT; by default since the last one, or, where nothing
                                                 has, what the last one changed

A changed room: its own tests and those of the rooms that include it. The whole program is tested by the stored results
where what computes them changed, and by the command line, figures or pages where those changed. What is left to
`scripts/test --ci` is printed. Exit: 0 all passed, 1 not, 2 cannot be built.
"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
TOPS = ("core", "scenarios", "analysis", "runners")
INCLUDE = re.compile(r'^ *# *include *"([^"]+)/[^"/]+"', re.MULTILINE)
# Tests of the whole program (regular expressions) for changes below a path.
ALWAYS = ["layers", "programs_are_installed", "planted_bugs_fit"]
OF_THE_PROGRAM = [
    (r"(core|scenarios|analysis)/", ["baselines"]),
    (r"runners/(experiment/(catalog|hand|simulation)|evaluation/(regression|verification))/|data/(baselines|experiments)/",
     ["baselines"]),
    (r"data/(baselines|experiments)/(fig5.8|fig6.3|fig7.5|handshake)\.", ["pictures"]),  # those that README.md shows
    (r"runners/(interfaces/cli|presentation|sweep|experiment/(settings|sessions))/",
     ["command_line_.*"]),
    (r"runners/live/", ["command_line_live", "runners/live/sensors"]),
    (r"runners/evaluation/(scorecard|figures)/|data/(methods|scenes|scorecard)", ["stored_scorecard", "figures_quick"]),
    (r"runners/presentation/|tests/system/viewer/|scripts/(viewer_bundle|plotting/colours)", ["command_line_view", "viewer_.*"]),
    (r"runners/interfaces/python/|tests/runners/interfaces/python/", ["python_module", "studies_quick"]),
    (r"data/studies/", ["python_module", "studies_quick"]),
    (r"scripts/(plot|plotting/)", ["plot", "plot_drawing", "plot_style", "scorecard_page", "figures_quick", "pictures"]),
    (r"scripts/pictures|data/pictures/|runners/presentation/page/|tests/system/viewer/live_picture", ["pictures", "plot_style"]),
    (r"scripts/benchmark|data/benchmarks/|tests/benchmarks/README\.md$", ["benchmark_tables"]),
    (r".*\.md$", ["page_links", "reference", "site"]),
    (r"scripts/(site$|website/)|data/experiments/|tests/system/site_test$", ["pictures", "site"]),
    (r"scripts/testing/|tests/(system/(run|evidence)_\w+|allowed_skips)$", ["run_ctest", "run_changed", "evidence"]),
    (r"scripts/release$|tests/system/release_test$", ["release"]),
    (r"\.github/.*\.yml$", ["forms"]),
    (r"data/sweeps/", ["figures_quick", "page_commands"]),
    (r"tests/system/page_commands$|scripts/example_recording$", ["page_commands"]),
    (r"(core|scenarios|analysis|runners)/.*\.h$", ["reference", "page_links"]),  # any of them may have settings
]


def git(*words):
    return subprocess.run(["git", *words], cwd=ROOT, check=True, capture_output=True, text=True).stdout.splitlines()


def changed_files(commit):
    new = git("ls-files", "--others", "--exclude-standard")
    return git("diff", "--name-only", commit or "HEAD") + new or git("diff", "--name-only", "HEAD~1")


def users_of_rooms():
    """{room: the rooms with a file that includes one of its headers}."""
    users = {}
    for top in TOPS:
        for file in [*(ROOT / top).rglob("*.h"), *(ROOT / top).rglob("*.cpp")]:
            room = str(file.parent.relative_to(ROOT))
            for other in set(INCLUDE.findall(file.read_text())) - {room}:
                users.setdefault(other, set()).add(room)
    return users


def with_further_users(rooms, users):
    found, left = set(rooms), list(rooms)
    while left:
        new = users.get(left.pop(), set()) - found
        found |= new
        left += new
    return found


def rooms_to_test(files):
    """Rooms whose tests run, and rooms that could notice it too, from farther away."""
    users = users_of_rooms()
    changed, tests_changed = set(), set()
    for name in files:
        parts = pathlib.PurePosixPath(name).parts
        if parts[0] in TOPS and name.endswith((".h", ".cpp", ".cl")):
            changed.add("/".join(parts[:-1]))
        elif parts[0] == "tests" and len(parts) > 2 and parts[1] in TOPS:
            tests_changed.add("/".join(parts[1:-1]))
        elif name.startswith("tests/support/") and name.endswith(".h"):
            tests_changed |= {str(test.parent.relative_to(ROOT / "tests")) for top in TOPS
                              for test in (ROOT / "tests" / top).rglob("*_test.cpp") if f'"{name}"' in test.read_text()}
    tested = changed | tests_changed | {user for room in changed for user in users.get(room, ())}
    return tested, with_further_users(changed, users) - tested


def targets_of_build(build):
    return {line.split(":")[0] for line in subprocess.run(
        ["ninja", "-C", build, "-t", "targets", "all"], check=True, capture_output=True, text=True).stdout.splitlines()}


def main():
    build, commit = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2] if len(sys.argv) > 2 else None
    files = changed_files(commit)
    tested, left = rooms_to_test(files)
    of_program = sorted({test for name in files for path, tests in OF_THE_PROGRAM if re.match(path, name) for test in tests})
    with_tests = sorted(room for room in tested if any((ROOT / "tests" / room).glob("*.cpp")))
    print(f"{len(files)} files changed. Rooms whose tests run: {', '.join(with_tests) or 'none'}")
    print(f"Tests of the whole program: {', '.join(ALWAYS + of_program)}")
    print(f"Left to scripts/test --ci: {', '.join(sorted(left)) or 'nothing that includes what changed'}", flush=True)
    known = targets_of_build(build)
    targets = [room.replace("/", "_") + "_tests" for room in with_tests] + ["remote-touch"]
    if {"python_module", "studies_quick"} & {*of_program}:
        targets.append("remote_touch_python")
    own_main = [file.stem for room in with_tests for file in (ROOT / "tests" / room).glob("*_test.cpp")]
    wanted = [each for each in targets + own_main if each in known]
    if of_program or with_tests:
        code = subprocess.run(["ninja", "-C", build, "-j", "2", *wanted], check=False).returncode
        if code != 0:
            print("test: FAILED: the build (see above)")
            sys.exit(2)
    # ctest allows nine pairs of parentheses in a pattern.
    names = [f"{re.escape(room)}{end}" for room in with_tests for end in ("$", "\\..*$")]
    names += [f"{test}$" for test in ALWAYS + of_program]
    sys.exit(subprocess.run([ROOT / "scripts" / "testing" / "run_ctest.py", build, "-R", f"^({'|'.join(names)})",
                             "-LE", "^evidence$"], check=False).returncode)


main()

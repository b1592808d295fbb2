"""What `baseline check` and `verify` say of a program: as a row of the table."""
import concurrent.futures
import itertools
import json
import os
import re
import subprocess
import time
import xml.etree.ElementTree

from bug_table import FIRST
from calls import JOBS, Failure, environment, output_of

LEVELS = ["x86-64", "x86-64-v3", "x86-64-v4"]
THREADS = [1, 2, 8]


def is_recorded(baseline, arguments):
    """Whether a baseline of the manifest plays a recording."""
    stored = arguments.root / "data" / "experiments" / f"{baseline['subject']}.json"
    beside = arguments.baselines / baseline["subject"]
    for file in (stored, beside):
        if baseline["command"] == "run" and file.is_file():
            return json.loads(file.read_text())["scenario"]["name"] == "recording"
    return False


def first_difference(found):
    """Tick, quantity and class of one baseline's entry in the report."""
    divergence = found.get("divergence")
    configuration = "configuration differs" if found.get("configuration") else "-"
    if divergence:
        return [str(divergence["tick"]), divergence["quantity"], divergence["cause"]]
    if found.get("sweep", {}).get("first_difference"):
        first = found["sweep"]["first_difference"]
        cell = ",".join(map(str, first["cell"]))
        return [f"cell {cell} run {first['replicate']}", first["measure"] or "-", configuration]
    return ["-", "-", configuration if found["outcome"] in ("regressed", "changed") else "not comparable"]


def baseline_entries(program, names, scratch, env, arguments):
    """What `baseline check` says of the baselines named, all without names; those not run are left out."""
    report = scratch / "check.json"
    log = output_of([program, "-q", "baseline", "check", *names, "--folder", arguments.baselines, "--json", report],
                    arguments.root, (0, 1, 2), env)
    if not report.is_file():
        raise Failure(f"no report of baseline check: {log.strip()[-300:]}")
    return [each for each in json.loads(report.read_text()) if each["kind"] != "not run"]


def failed_checks(program, scratch, env, arguments):
    junit = scratch / "verify.xml"
    output_of([program, "verify", "proxy", "--junit", junit], arguments.root, (0, 1), env)
    return [case.get("name") for case in xml.etree.ElementTree.parse(junit).iter("testcase")
            if case.find("failure") is not None]


def verify_cell(failed):
    checks = list(dict.fromkeys(each.split(" in ")[0] for each in failed))
    shown = ", ".join(checks[:3]) + (f" and {len(checks) - 3} more" if len(checks) > 3 else "")
    return f"{len(failed)}: {shown}" if failed else "-"


def quick_row(want, program, scratch, env, arguments):
    """The row again, from what is needed to tell that the bug is found as it says; None where that cannot be had."""
    row = list(want)
    if row[FIRST] != "-":
        entries = baseline_entries(program, [row[FIRST]], scratch, env, arguments)
        if not entries:
            return None
        caught = [each for each in entries if each["outcome"] != "same"]
        if not caught:
            raise Failure(f"slips through {row[FIRST]}, which should find it")
        row[FIRST:FIRST + 4] = [caught[0]["baseline"], *first_difference(caught[0])]
    if row[1] != "check":
        row[-1] = verify_cell(failed_checks(program, scratch, env, arguments))
    return row


def full_row(name, program, recorded, scratch, env, arguments):
    """What `baseline check` and `verify` say of a program."""
    entries = baseline_entries(program, [], scratch, env, arguments)
    caught = [each for each in entries if each["outcome"] != "same"]
    caught.sort(key=lambda each: each["baseline"] in recorded)  # stable: as in the manifest, recorded ones last
    failed = failed_checks(program, scratch, env, arguments)
    if not caught and not failed:
        raise Failure("slips through: every baseline and every check passes")

    def count(of_recordings):
        of = [each for each in entries if (each["baseline"] in recorded) == of_recordings]
        here = [each for each in caught if (each["baseline"] in recorded) == of_recordings]
        return f"{len(here)}/{len(of)}" if of else "?"

    first = [caught[0]["baseline"], *first_difference(caught[0])] if caught else ["-", "-", "-", "-"]
    found_by = "both" if caught and failed else "check" if caught else "verify"
    return [name, found_by, count(False), count(True), *first, verify_cell(failed)]


def levels_here(program):
    def has(level):
        return subprocess.run([program, "list"], env=dict(os.environ, REMOTE_TOUCH_ISA=level),
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL).returncode == 0
    return [level for level in LEVELS if has(level)]


def passes_unchanged(levels, arguments):
    """Every level of this machine, with 1, 2 and 8 threads in turn; one thread also on the best."""
    def judge(level_and_threads):
        level, threads = level_and_threads
        env = dict(environment(arguments.root), REMOTE_TOUCH_ISA=level, OMP_NUM_THREADS=str(threads))
        start, text = time.monotonic(), ""
        verifies = level_and_threads == (levels[-1], 1)  # one of its checks is that of the other levels
        for command in (["-q", "baseline", "check", "--folder", arguments.baselines], ["verify", "proxy"])[:1 + verifies]:
            try:
                text += output_of([arguments.program, *command], arguments.root, env=env)
            except Failure as failure:
                return f"FAILED  unchanged, {level}, {threads} thread(s): {failure}"
        same, not_run = (len(re.findall(f"^{word} ", text, re.MULTILINE)) for word in ("same", "not run"))
        return (f"ok      unchanged, {level}, {threads} thread(s): {same} baselines the same, {not_run} not run"
                f"{', verify passes' if verifies else ''} ({time.monotonic() - start:.0f} s)")

    lines = []
    pairs = list(zip(levels, itertools.cycle(THREADS)))
    with concurrent.futures.ThreadPoolExecutor(JOBS) as pool:
        for line in pool.map(judge, dict.fromkeys([*pairs, (levels[-1], 1)])):
            print(line, flush=True)
            lines.append(line)
    return not any(line.startswith("FAILED") for line in lines)

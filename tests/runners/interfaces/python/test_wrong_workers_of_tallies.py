"""Workers that compute wrongly or vanish before a check: no wrong run is added to a tally without a word."""
import concurrent.futures
import json
import re

import h5py
import numpy as np
import pytest
import remote_touch as rt
from test_executors import TALLY, Workers


def missing_in(tally):
    with h5py.File(tally) as file:
        held = file["tally/held_runs"][()].astype(int).reshape(-1, 2)
    return {*range(240)} - {run for first, last in held for run in range(first, last + 1)}


def test_a_tally_has_no_run_of_a_batch_whose_check_was_lost(tmp_path):
    def lose_checks(number, made, is_check):
        if is_check:
            raise OSError("away")
        return made
    with pytest.raises(concurrent.futures.BrokenExecutor, match="tally.h5: 0 of 240 runs are stored"):
        rt.sweep(TALLY, output=tmp_path / "tally.h5", executor=Workers(lose_checks), chunk=2)
    assert not (tmp_path / "tally.h5").exists()


def test_a_tally_with_wrong_runs_is_not_continued(command_line, tmp_path):
    """The sums of earlier batches cannot be taken back, so the file says why it is wrong, and nobody adds to it."""
    (tmp_path / "sweep.json").write_text(json.dumps(TALLY))
    output, checks = tmp_path / "tally.h5", []

    def wrong_late(number, made, is_check):
        checks.extend([number] * is_check)
        if len(checks) == 2:
            made["values"].view(np.uint64)[...] ^= 1
        return made
    with pytest.raises(RuntimeError, match=r"run \d+ has .*; the tally also has earlier runs by them: expected a new file$") as raised:
        rt.sweep(tmp_path / "sweep.json", output=output, executor=Workers(wrong_late), chunk=2)
    wrong = re.search(r"run \d+", str(raised.value)).group()  # of the second batch
    assert 15 not in missing_in(output) and 16 in missing_in(output)
    for read in (rt.open, rt.analyse, lambda file: rt.replay(file, cell=(0, 0))):
        with pytest.warns(UserWarning, match=f"tally.h5: some runs are WRONG: {wrong} differs between the workers w"):
            read(output)
    with pytest.warns(UserWarning):
        assert rt.open(output).attrs["distrusted"].startswith(f"{wrong} differs between the workers w")
    assert f"note: some runs are WRONG: {wrong} differs" in command_line("analyse", output)
    for again in ({"executor": Workers()}, {"threads": 1}):
        with pytest.raises(rt.InputError, match=f"tally.h5: has runs of a machine that computed wrongly .{wrong} differs"):
            rt.sweep(tmp_path / "sweep.json", output=output, **again)

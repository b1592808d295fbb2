"""Sweeps: the same bits as the command line gives, for any number of threads, over named axes."""
import copy
import json

import h5py
import numpy as np
import pytest
import remote_touch as rt
from conftest import PRESS, assert_same_file, digest_in

SWEEP = {
    "title": "presses",
    "experiment": PRESS,
    "axes": [{"parameter": "scenario.noise_sigma_m", "from": 0, "to": 0.002, "count": 3},
             {"parameter": "renderer.steps_per_tick", "values": [5, 30]},
             {"parameter": "renderer.contact_motion", "values": ["mean-plane", "regions"]}],
    "replicates": 2,
    "measures": ["max_force", "popped_through"],
}


@pytest.fixture(scope="module", autouse=True)
def rules():
    """The second axis takes the names that the renderer has."""
    text = next(line for line in rt.describe("proxy").split("contact_motion")[1].splitlines() if "allowed" in line)
    SWEEP["axes"][2]["values"] = text.split("allowed ")[1].split(", ")[:2]


def test_threads_do_not_matter_and_the_file_is_that_of_the_command_line(command_line, tmp_path):
    (tmp_path / "sweep.json").write_text(json.dumps(SWEEP))
    file = tmp_path / "sweep.json"
    text = command_line("sweep", file, "-o", tmp_path / "command.h5")
    one, two = rt.sweep(file, threads=1), rt.sweep(file, threads=2, output=tmp_path / "python.h5")
    assert one.attrs["digest"] == two.attrs["digest"] == digest_in(text)
    assert one.identical(two)
    assert_same_file(tmp_path / "python.h5", tmp_path / "command.h5")
    opened = rt.open(tmp_path / "command.h5")
    assert opened.identical(two)


def test_axes_units_and_values():
    sweep = rt.sweep(SWEEP)
    assert sweep.max_force.dims == ("noise_sigma_m", "steps_per_tick", "contact_motion", "replicate")
    assert sweep.max_force.shape == (3, 2, 2, 2)
    assert list(sweep.noise_sigma_m.values) == [0, 0.001, 0.002] and sweep.noise_sigma_m.attrs["units"] == "m"
    assert list(sweep.contact_motion.values) == SWEEP["axes"][2]["values"]
    assert sweep.max_force.attrs["units"] == "N" and (sweep.state == 2).all()
    assert not sweep.max_force.values.flags.owndata
    # Cell (1, 0, 0) is that run, with its own noise.
    run = rt.replay(sweep, cell=(1, 0, 0), replicate=1)
    assert float(run.max_force) == float(sweep.max_force[1, 0, 0, 1])
    without_noise = rt.run(PRESS, set={"scenario.noise_sigma_m": 0, "renderer.steps_per_tick": 30})
    assert float(without_noise.max_force) == float(sweep.max_force.sel(noise_sigma_m=0, steps_per_tick=30)[0, 0])


def test_replay_is_the_command(command_line, tmp_path):
    file = tmp_path / "map.h5"
    sweep = rt.sweep(SWEEP, output=file)
    text = command_line("replay", file, "--cell", "2,1,0", "--replicate", "1", "-o", tmp_path / "command.h5")
    rule = SWEEP["axes"][2]["values"][0]
    cell = {"noise_sigma_m": 0.002, "steps_per_tick": 30, "contact_motion": rule}
    again = rt.replay(file, cell=cell, replicate=1, output=tmp_path / "python.h5")
    assert again.attrs["digest"] == digest_in(text)
    assert_same_file(tmp_path / "python.h5", tmp_path / "command.h5")
    assert rt.replay(sweep, cell=(2, 1, 0), replicate=1).attrs == again.attrs


def test_settings_of_a_sweep():
    sweep = rt.sweep(SWEEP, set={"replicates": 1, "seed": 9, "axes.0.count": 2})
    assert sweep.sizes == {"noise_sigma_m": 2, "steps_per_tick": 2, "contact_motion": 2, "replicate": 1}
    assert json.loads(sweep.attrs["config"])["experiment"]["seed"] == 9


def test_notes_are_bits_with_names(tmp_path):
    sweep = rt.sweep(SWEEP, set={"axes.0": {"parameter": "trajectory.depth_m", "values": [0.001, 0.01]}})
    kinds = sweep.attrs["note_kinds"].split(",")
    not_reached, no_contact = (1 << kinds.index(kind) for kind in ("phase not reached", "no contact"))
    assert sweep.notes.shape == sweep.max_force.shape and (sweep.notes == not_reached).all()  # the surface is still at rest
    assert list(sweep.notes.flag_masks) == [1 << bit for bit in range(len(kinds))]
    assert sweep.notes.flag_meanings.split() == [kind.replace(" ", "_") for kind in kinds]
    short = rt.sweep(SWEEP, set={"duration_s": 0.01}, output=tmp_path / "short.h5")
    for noted in (short, rt.open(tmp_path / "short.h5")):
        assert (noted.notes.values & not_reached != 0).all() and (noted.notes.values & no_contact != 0).all()


def test_failed_runs_are_nan_with_their_reason():
    failing = copy.deepcopy(SWEEP)
    failing["axes"] = [{"parameter": "trajectory.depth_m", "values": [0.001, 0.002]}]
    failing["experiment"] = {**PRESS, "scenario": {"name": "box"}}  # which has no height to press at
    with pytest.warns(UserWarning, match="4 of 4 runs failed, the first: .*expected"):
        sweep = rt.sweep(failing)
    assert np.isnan(sweep.max_force).all() and (sweep.state == 3).all()
    assert all("\n" not in text and text for text in sweep.error.values.ravel())


def test_a_sweep_goes_on_where_it_stopped(tmp_path):
    file = tmp_path / "map.h5"

    def stop_half_way(fraction):
        if fraction > 0.1:
            raise KeyboardInterrupt
    longer = {**SWEEP, "replicates": 20, "experiment": {**PRESS, "duration_s": 5}}
    with pytest.raises(KeyboardInterrupt):
        rt.sweep(longer, threads=1, output=file, progress=stop_half_way)
    part = rt.open(file)
    done = int((part.state == 2).sum())
    assert 0 < done < part.state.size
    with h5py.File(file, "r") as stored:  # a bit of the first run, which is done
        offset = stored["sweep/max_force"].id.get_offset()
    damaged = bytearray(file.read_bytes())
    damaged[offset] ^= 1
    file.write_bytes(damaged)
    with pytest.warns(UserWarning, match="map.h5: 1 run has a wrong checksum, .*: it is left out, and the command of the sweep makes it"):
        assert int((rt.open(file).state == 2).sum()) == done - 1
    with pytest.warns(UserWarning, match="1 run has a wrong checksum"):
        rt.analyse(file, mean="max_force")
    whole = rt.sweep(longer, output=file)
    assert (whole.state == 2).all() and whole.attrs["digest"] == rt.sweep(longer).attrs["digest"]


def test_a_figure_is_a_dict_of_tables(command_line, tmp_path):
    command_line("figure", "4.11", "-o", tmp_path)
    tables = rt.open(next(tmp_path.glob("*.h5")))
    assert len(tables) > 0
    for table in tables.values():
        assert table.attrs["figure"] and table.sizes["row"] > 0
        for variable in table.data_vars.values():
            assert variable.attrs["units"]


VARIANTS = {"name": "variant", "variants": [{"name": "printed"}, {"name": "slow", "set": {"renderer.steps_per_tick": 1}}]}


def test_joint_axes_are_coordinates():
    radii = {"name": "r_c", "unit": "m", "parameters": ["renderer.r1_m", "renderer.r2_m"],
             "values": [[0.00399, 0.00401], [0.00499, 0.00501]], "labels": [0.004, 0.005]}
    sweep = rt.sweep({**SWEEP, "axes": [radii, VARIANTS]})
    assert sweep.max_force.dims == ("r_c", "variant", "replicate")
    assert [*sweep.r_c.values] == [0.004, 0.005] and sweep.r_c.attrs["units"] == "m"
    assert [*sweep["variant"].values] == ["printed", "slow"]
    run = rt.replay(sweep, cell={"r_c": 0.005, "variant": "slow"}, replicate=1)
    assert float(run.max_force) == float(sweep.max_force.sel(r_c=0.005, variant="slow", replicate=1))


def test_a_selection_is_replayed_by_its_coordinates():
    sweep = rt.sweep({**SWEEP, "axes": [SWEEP["axes"][0], VARIANTS]})
    noise = SWEEP["axes"][0]["parameter"].split(".")[-1]
    selections = [sweep.isel({noise: slice(1, None)}), sweep.isel({noise: [2, 0], "variant": 1}), sweep.sel(variant=["slow"]),
                  sweep.isel(replicate=[1]), sweep.transpose("variant", noise, "replicate"), sweep[["max_force"]].isel({noise: -1})]
    for selection in selections:
        axes = [axis for axis in selection.max_force.dims if axis != "replicate"]
        for place in np.ndindex(*(selection.sizes[axis] for axis in axes)):
            run = rt.replay(selection, cell=place, replicate=0)
            assert float(run.max_force) == float(selection.max_force.isel({**dict(zip(axes, place)), "replicate": 0}))
    with pytest.raises(rt.InputError, match="cell = .*: expected the place on variant, or a dict"):
        rt.replay(sweep.isel({noise: 0}), cell=(0, 0))
    with pytest.raises(rt.InputError, match=f"expected .*{noise}=VALUE"):
        rt.replay(sweep.isel({noise: 0}, drop=True), cell=(0,))


def test_an_analysis_of_a_file_and_of_a_data_set_are_the_same(tmp_path):
    file = tmp_path / "map.h5"
    sweep = rt.sweep({**SWEEP, "axes": [SWEEP["axes"][0], VARIANTS]}, output=file)
    question = {"limit": "max_force", "above": float(sweep.max_force.median()), "mean": ["max_force"], "by": "noise_sigma_m",
                "difference": "max_force"}
    stored, given = rt.analyse(file, **question), rt.analyse(sweep, **question)
    assert [*stored] == ["limits", "mean_max_force", "difference_max_force"]
    for name, table in stored.items():
        assert table.drop_attrs().identical(given[name].drop_attrs()) if hasattr(table, "drop_attrs") else table.equals(given[name])
    means = sweep.max_force.mean(["variant", "replicate"])
    assert np.allclose(stored["mean_max_force"]["value"], means, rtol=1e-12)
    differences = (sweep.max_force.sel(variant="slow") - sweep.max_force.sel(variant="printed")).mean("replicate")
    assert np.allclose(stored["difference_max_force"]["value"], differences, rtol=1e-12)


@pytest.mark.parametrize("question, problem", [
    ({"limit": "force"}, "limit force: expected one of max_force, popped_through"),
    ({"along": "x"}, "along x: expected one of noise_sigma_m"),
    ({"limit": "popped_through", "level": 2}, "level 2"),
    ({"level": "half"}, "level = 'half': expected a number"),
])
def test_a_wrong_question_is_refused_in_one_line(question, problem):
    with pytest.raises(rt.InputError, match=problem):
        rt.analyse(rt.sweep({**SWEEP, "axes": SWEEP["axes"][:1]}), **question)


def test_a_tally_has_the_counts_and_means_of_the_runs(tmp_path, command_line):
    plan = {**SWEEP, "keep": "events", "replicates": 20}
    file = tmp_path / "plan.json"
    file.write_text(json.dumps(plan))
    tally = rt.sweep(file, output=tmp_path / "tally.h5", threads=2)
    runs = rt.sweep({**plan, "keep": "runs"})
    assert (tally.runs == 20).all() and (tally.failed == 0).all() and "replicate" not in tally.dims
    np.testing.assert_allclose(tally.max_force_mean, runs.max_force.mean("replicate"), rtol=1e-15)
    np.testing.assert_allclose(tally.max_force_standard_deviation, runs.max_force.std("replicate", ddof=1), atol=1e-13)
    assert (tally.max_force_least == runs.max_force.min("replicate")).all()
    assert (tally.max_force_greatest == runs.max_force.max("replicate")).all()
    assert tally.max_force_mean.attrs["units"] == "N" and tally.equals(rt.open(tmp_path / "tally.h5"))
    of_tally, of_runs = (rt.analyse(of, mean="max_force", by="noise_sigma_m")["mean_max_force"]
                         for of in (tmp_path / "tally.h5", runs))
    np.testing.assert_allclose(of_tally["value"], of_runs["value"], rtol=1e-14)
    command_line("sweep", file, "-o", tmp_path / "command.h5")
    assert_same_file(tmp_path / "tally.h5", tmp_path / "command.h5")


def test_no_axis_of_a_tally_has_the_name_of_a_variable(tmp_path):
    """The file could be written, but no data set could hold both."""
    def plan(name):
        return {**SWEEP, "keep": "tally", "measures": ["max_force"],
                "axes": [{"name": name, "parameters": ["trajectory.depth_m"], "values": [[0.01], [0.02]]}]}
    tally = rt.sweep(plan("depth"), output=tmp_path / "tally.h5")
    assert len(tally.data_vars) == 7
    for name in tally.data_vars:
        with pytest.raises(rt.InputError, match=f"a part of the tally has the name {name}: expected"):
            rt.sweep(plan(name), output=tmp_path / "refused.h5")


def test_an_axis_of_a_sweep_may_be_named_failed():
    """Only the data set of a tally has a variable of that name."""
    axis = {"name": "failed", "parameters": ["trajectory.depth_m"], "values": [[0.01], [0.02]]}
    assert rt.sweep({**SWEEP, "axes": [axis], "measures": ["max_force"]}).failed.dims == ("failed",)


def test_a_tally_needs_a_file():
    with pytest.raises(rt.InputError, match="keeps a tally: expected an output"):
        rt.sweep({**SWEEP, "keep": "tally"})

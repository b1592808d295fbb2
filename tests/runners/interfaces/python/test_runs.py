"""Runs: the same bits as the command line gives, in arrays that are not copied, with units."""
import json

import h5py
import numpy as np
import pytest
import remote_touch as rt
import xarray
from conftest import PRESS, assert_same_file, digest_in

EXPERIMENTS = [  # with a proxy, regions, a tool, guidance and a hand, a slave; the last three for a part of their time
    ("fig4.12", {}, 7),
    ("fig4.12", {"scenario.noise_sigma_m": 0.003, "renderer": {"name": "tracked-sheet"}}, None),
    ("fig5.5", {"duration_s": 0.5}, 3),
    ("fig6.3", {"duration_s": 0.1}, None),
    ("fig7.5", {"duration_s": 0.1}, 2),
    ("steer-robot", {"duration_s": 0.3, "feedback": {"force": "slave-force"}}, None),
]


def as_options(settings, seed):
    options = []
    for path, value in settings.items():
        options += ["--set", f"{path}={json.dumps(value)}"]
    return options + (["--set", f"seed={seed}"] if seed is not None else [])


@pytest.mark.parametrize("experiment, settings, seed", EXPERIMENTS)
def test_digest_and_file_are_those_of_the_command_line(experiment, settings, seed, command_line, tmp_path):
    text = command_line("run", experiment, *as_options(settings, seed), "-o", tmp_path / "command.h5")
    run = rt.run(experiment, set=settings, seed=seed, output=tmp_path / "python.h5")
    assert run.attrs["digest"] == digest_in(text)
    assert_same_file(tmp_path / "python.h5", tmp_path / "command.h5")
    assert rt.run(experiment, set=settings, seed=seed).attrs == run.attrs  # without a file, too


def test_every_column_is_that_of_the_file_as_h5py_reads_it(command_line, tmp_path):
    command_line("run", "fig7.5", "--set", "duration_s=0.1", "-o", tmp_path / "a.h5")
    run = rt.run("fig7.5", set={"duration_s": 0.1})
    with h5py.File(tmp_path / "a.h5") as file:
        for name in run.attrs["columns"].split(","):
            stored = file["trace"][name]
            np.testing.assert_array_equal(run[name].values, stored[...], err_msg=name)
            assert run[name].dtype == stored.dtype
            assert run[name].attrs["units"].encode() == np.bytes_(stored.attrs["units"])
        assert set(run.attrs["columns"].split(",")) == set(file["trace"]) - {"xyz", "wxyz"}
        assert run.attrs["config"].encode() == np.bytes_(file.attrs["config"])


def test_opened_is_what_was_run(tmp_path):
    run = rt.run(PRESS, output=tmp_path / "a.h5")
    assert rt.open(tmp_path / "a.h5").identical(run[run.attrs["columns"].split(",")[1:]])


def test_it_is_what_xarray_reads_of_the_file(tmp_path):
    """Dimensions, coordinates, units and names of values, by the reader of netCDF 4 files."""
    run = rt.run("fig6.3", set={"duration_s": 0.05}, output=tmp_path / "a.h5")
    stored = xarray.open_dataset(tmp_path / "a.h5", group="trace", engine="h5netcdf")
    assert set(stored.data_vars) == set(run.attrs["columns"].split(",")) - {"time"}
    for name, variable in stored.variables.items():
        np.testing.assert_array_equal(run[name].values, variable.values, err_msg=name)
        assert run[name].dims == variable.dims
        for attribute in ("units", "long_name", "flag_meanings"):
            if name in stored.data_vars:
                assert run[name].attrs.get(attribute) == variable.attrs.get(attribute), (name, attribute)


def test_no_column_is_copied():
    run = rt.run(PRESS)
    for name in run.attrs["columns"].split(","):
        if name == "time":
            continue  # an index of pandas
        values = run[name].values
        owner = values
        while isinstance(owner, np.ndarray):
            assert not owner.flags.owndata, f"{name}: NumPy has numbers of its own"
            owner = owner.base
        assert type(owner).__name__ == "PyCapsule", name  # which deletes the vector of C++
    force = run.force.values
    assert np.shares_memory(force, run.force.sel(xyz="y").values)
    kept = force.copy()
    del run
    rt.run(PRESS, seed=99)
    np.testing.assert_array_equal(force, kept)  # the vector lives as long as an array shows it


def test_units_names_and_coordinates():
    run = rt.run(PRESS)
    assert run.force.dims == ("time", "xyz") and list(run.xyz.values) == ["x", "y", "z"]
    assert run.force.attrs["units"] == "N" and "force of the renderer" in run.force.attrs["long_name"]
    assert run.time.attrs["units"] == "s" and run.sizes["time"] == 200
    assert run.state.attrs["flag_meanings"] == "free contact entrenched"
    assert list(run.state.attrs["flag_values"]) == [0, 1, 2]
    assert json.loads(run.attrs["config"])["scenario"]["noise_sigma_m"] == 0.001
    for name in ("version", "git_commit", "source_digest", "digest", "command", "isa"):
        assert run.attrs[name], name
    tool = rt.run("fig6.3", set={"duration_s": 0.05})
    assert tool.tool_orientation.dims == ("time", "wxyz") and list(tool.wxyz.values) == list("wxyz")


def test_attributes_are_texts():
    """As every file format of xarray stores them."""
    for value in rt.run(PRESS).attrs.values():
        assert isinstance(value, str)


def test_measures_are_those_that_the_command_prints(command_line, tmp_path):
    run = rt.run("fig4.12", seed=5)
    lines = command_line("run", "fig4.12", "--all", "--set", "seed=5", "-o", tmp_path / "a.h5").splitlines()[1:]
    printed = {line.split()[0]: line for line in lines}
    assert len(printed) > 20
    for name, line in printed.items():
        assert f"{float(run[name]):.6g}" == line.split()[1], name
        assert line.endswith(run[name].attrs["long_name"]), name
        assert run[name].dims == ()


def test_a_measure_is_what_its_column_says():
    run = rt.run(PRESS)
    assert float(run.max_force) == pytest.approx(float(np.sqrt((run.force ** 2).sum("xyz")).max()), rel=1e-12)


def test_a_dict_a_file_and_a_name_are_the_same(tmp_path):
    (tmp_path / "press.json").write_text(json.dumps(PRESS))
    assert rt.run(PRESS).attrs["digest"] == rt.run(tmp_path / "press.json").attrs["digest"]
    config = json.loads(rt.run("fig4.12").attrs["config"])
    assert rt.run(config).attrs["digest"] == rt.run("fig4.12").attrs["digest"]


def test_numbers_of_numpy_are_settings():
    a = rt.run(PRESS, set={"scenario.noise_sigma_m": np.float64(0.002), "trajectory.start_m": np.zeros(3)}, seed=np.int64(4))
    b = rt.run(PRESS, set={"scenario.noise_sigma_m": 0.002, "trajectory.start_m": [0, 0, 0]}, seed=4)
    assert a.attrs["digest"] == b.attrs["digest"]


def test_timing_and_progress():
    seen = []
    run = rt.run("fig4.12", set={"duration_s": 20}, timing=True, progress=seen.append)
    assert run.step_duration.dims == ("time",) and run.step_duration.attrs["units"] == "s"
    assert (run.step_duration >= 0).all() and run.step_duration.max() > 0  # a clock may be too coarse for one tick
    assert seen[-1] == 1 and seen == sorted(seen)
    assert run.attrs["digest"] == rt.run("fig4.12", set={"duration_s": 20}).attrs["digest"]


def test_list_and_describe_are_those_of_the_command(command_line):
    names = rt.list()
    text = command_line("list")
    for kind, rows in names.items():
        assert f"\n{kind}\n" in "\n" + text
        for name, summary in rows.items():
            assert f"  {name:<18} {summary}\n" in text
    for name in ("proxy", "fig4.12", "trace", "popped_through"):
        assert rt.describe(name) == command_line("describe", name)


def test_compare_is_the_command(command_line, tmp_path):
    a, b = tmp_path / "a.h5", tmp_path / "b.h5"
    first = rt.run(PRESS, output=a)
    second = rt.run(PRESS, set={"trajectory.depth_m": 0.01 + 1e-9}, output=b)
    same = rt.compare(a, a)
    assert same.same and not same.differences and str(same) == command_line("compare", a, a)
    other = rt.compare(a, b)
    assert not other.same and "force" in other.differences and "first divergent tick" in str(other)
    assert "time" not in other.differences
    in_memory = rt.compare(first, second)
    assert in_memory.differences == other.differences and in_memory.outcome == other.outcome
    assert in_memory.judgements == other.judgements and other.judgements["max_force"] == "changed"  # a force is no merit
    assert other.outcome == ("regressed" if "worse" in other.judgements.values() else "changed")
    assert not same.judgements
    assert rt.compare(first, a).same
    wide = rt.compare(a, b, tolerance={"*": 1e9})
    assert wide.same == command_line("compare", a, b, "--tolerance", "*=1e9").startswith("same")
    assert wide.same and rt.compare(first, second, tolerance={"*": (1e9, 0)}).same


def test_texts_stay_texts():
    for title in ("1", "true", "null", "[1]", '"quoted"', "1e3", "plain", " x "):
        assert json.loads(rt.run(PRESS, set={"title": title}).attrs["config"])["title"] == title
    with pytest.raises(rt.InputError, match="noise_sigma_m"):
        rt.run(PRESS, set={"scenario.noise_sigma_m": "0.001"})

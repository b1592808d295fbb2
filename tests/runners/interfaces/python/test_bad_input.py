"""Bad input is an InputError, a ValueError of one line, and leaves no file."""
import json
import os

import numpy as np
import pytest
import remote_touch as rt
from class_scripts import PENALTY
from conftest import PRESS

CIRCLE = {}
CIRCLE["scenario"] = CIRCLE

BAD = {
    "an unknown experiment": (lambda: rt.run("fig9.99"), "fig9.99: "),
    "no text": (lambda: rt.run(4.12), "4.12: expected a name, a path or a dict"),
    "no JSON": (lambda: rt.run(b"fig4.12"), "b'fig4.12': expected"),
    "an empty dict": (lambda: rt.run({}), "scenario: missing"),
    "a circle": (lambda: rt.run(CIRCLE), "dict: "),
    "an unknown setting": (lambda: rt.run(PRESS, set={"scenario.noise": 1}), "scenario.noise"),
    "a value out of range": (lambda: rt.run(PRESS, set={"scenario.noise_sigma_m": -1}), "scenario.noise_sigma_m = -1"),
    "not a number": (lambda: rt.run(PRESS, set={"scenario.noise_sigma_m": np.nan}), "scenario.noise_sigma_m = float: "),
    "infinite": (lambda: rt.run(PRESS, set={"duration_s": np.inf}), "duration_s = float: "),
    "a function": (lambda: rt.run(PRESS, set={"duration_s": len}), "<built-in function len>: expected"),
    "a key that is no text": (lambda: rt.run({(1, 2): 3}), "dict: keys must be"),
    "a negative seed": (lambda: rt.run(PRESS, seed=-1), "seed = -1"),
    "a seed beyond 64 bits": (lambda: rt.run(PRESS, seed=2**64), "seed = "),
    "surrogates": (lambda: rt.run("\ud800"), "'\\ud800': expected text"),
    "a zero byte": (lambda: rt.run("fig4.12\0"), "fig4.12"),
    "lines": (lambda: rt.run("a\nb"), "a b: "),
    "an unwritable folder": (lambda: rt.run(PRESS, output="absent/a.h5"), "absent/a.h5: "),
    "another's file": (lambda: rt.run(PRESS, output="other.txt"), "other.txt: exists already and is not a result"),
    "an unknown sweep": (lambda: rt.sweep("absent"), "absent: "),
    "no threads": (lambda: rt.sweep("absent", threads=0), "threads = 0: expected 1 to 4096"),
    "threads that are no number": (lambda: rt.sweep("absent", threads="all"), "threads = 'all': expected an integer"),
    "half a thread": (lambda: rt.sweep("absent", threads=1.5), "threads = 1.5: expected an integer"),
    "settings that are no dict": (lambda: rt.run(PRESS, set=[1]), "set = [1]: expected a dict"),
    "tolerances that are no dict": (lambda: rt.compare("trace.h5", "trace.h5", tolerance=1e-9), "tolerance = 1e-09: expected"),
    "a sweep that is none": (lambda: rt.replay(5, cell=0), "int: expected a file, or what rt.sweep returned"),
    "a cell of texts": (lambda: rt.replay("trace.h5", cell=("a", "b")), "cell = 'a': expected an integer"),
    "a replicate": (lambda: rt.replay("trace.h5", cell=0, replicate=-1), "replicate = -1: expected 0 to"),
    "no seeds": (lambda: rt.scorecard(["proxy"], seeds=0, output="card"), "seeds = 0: expected 1 to"),
    "a key": (lambda: rt.scene("moving-lift", key=5), "key = 5: expected an rt.NoiseKey"),
    "a negative key": (lambda: rt.NoiseKey(seed=-1), "NoiseKey: seed: expected an integer of 64 bits, 0 or more"),
    "buttons": (lambda: rt.Device((0, 0, 0), buttons=2**32), "Device: buttons: expected an integer of 32 bits, 0 or more"),
    "a path of a number": (lambda: rt.open(5), "5: expected a text or a path"),
    "no axes": (lambda: rt.sweep({"experiment": PRESS}), "configuration"),
    "no result": (lambda: rt.open("other.txt"), "other.txt: not a readable HDF5 file"),
    "no file": (lambda: rt.open("absent.h5"), "absent.h5: "),
    "a folder without a scorecard": (lambda: rt.open("."), "./scorecard.h5: "),
    "a damaged file": (lambda: rt.open("damaged.h5"), "damaged.h5: "),
    "a cut file": (lambda: rt.open("cut.h5"), "cut.h5: "),
    "no such cell": (lambda: rt.replay("trace.h5", cell=(0,)), "trace.h5: "),
    "a negative tolerance": (lambda: rt.compare("trace.h5", "trace.h5", tolerance={"force": -1}), "tolerance force = -1"),
    "a tolerance of three": (lambda: rt.compare("trace.h5", "trace.h5", tolerance={"force": (1, 2, 3)}), "tolerance force"),
    "a tolerance of nothing": (lambda: rt.compare("trace.h5", "trace.h5", tolerance={"absent": 1}), "tolerance of absent: "),
    "no data sets": (lambda: rt.compare(3, 4), "int: expected files, or data sets of traces"),
    "an unknown name": (lambda: rt.describe("absent"), "absent: unknown"),
    "an unknown scene": (lambda: rt.scene("absent"), 'scene = "absent": expected'),
    "a setting of a scene": (lambda: rt.scene("moving-lift", noise=1), "scene.noise"),
    "a frame": (lambda: rt.scene("moving-lift").cloud(-1), "frame = -1: expected 0 to "),
    "a method": (lambda: rt.scorecard([3], output="card"), "method 3: expected"),
    "an unknown method": (lambda: rt.scorecard(["absent"], output="card"), "method absent: unknown"),
    "a class that is not registered": (lambda: rt.scorecard([rt.Renderer], output="card"), "class Renderer: is not in"),
    "a use of noise": (lambda: rt.NoiseKey().normals("mine", 0, 1), "use = mine: expected point_position"),
    "a used number": (lambda: rt.NoiseKey().normals(3, 0, 1), "use = 3: expected"),
    "a negative frame": (lambda: rt.NoiseKey().normals("depth", -1, 1), "frame = -1: expected"),
    "too many": (lambda: rt.NoiseKey().normals("depth", 0, 10**12), "count = 1000000000000: expected"),
    "two numbers a point": (lambda: rt.Cloud(np.zeros((3, 2))), "Cloud: points: an array of shape (3, 2)"),
    "texts": (lambda: rt.Cloud([["a", "b", "c"]]), "Cloud: points: an array of <U1"),
    "half a point": (lambda: rt.Cloud([[0, 0, 0], [1, np.nan, 2]]), "Cloud: points: row 1: a number is not finite"),
    "long normals": (lambda: rt.Cloud(np.zeros((2, 3)), normals=[[0, 1, 0], [0, 0, 1e200]]),
                     "Cloud: normals: row 1: expected a normal of length 1"),
    "fewer normals": (lambda: rt.Cloud(np.zeros((3, 3)), normals=np.zeros((2, 3))), "Cloud: normals: expected one for each"),
    "a colour": (lambda: rt.Cloud(np.zeros((1, 3)), colour=[2**24]), "Cloud: colour: expected 1 integers"),
    "a radius": (lambda: rt.Cloud(np.zeros((1, 3)), fixture_radius_m=[np.nan]), "Cloud: fixture_radius_m: expected"),
    "columns": (lambda: rt.Cloud(np.zeros((3, 3)), columns=2), "Cloud: columns = 2: expected"),
    "a device": (lambda: rt.Device((0, 0, np.inf)), "Device: position_m: a number is not finite"),
}


@pytest.fixture
def in_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    rt.run(PRESS, output="trace.h5")
    whole = (tmp_path / "trace.h5").read_bytes()
    (tmp_path / "cut.h5").write_bytes(whole[:-1000])
    (tmp_path / "damaged.h5").write_bytes(whole[:3000] + b"damaged" + whole[3007:])
    (tmp_path / "other.txt").write_text("no result")
    return tmp_path


@pytest.mark.parametrize("what", BAD)
def test_bad_input(what, in_folder):
    call, begins = BAD[what]
    before = {file.name: file.read_bytes() for file in in_folder.iterdir()}
    with pytest.raises(rt.InputError) as refused:
        call()
    said = str(refused.value)
    assert said.startswith(begins), said
    assert "\n" not in said and isinstance(refused.value, ValueError)
    assert {file.name: file.read_bytes() for file in in_folder.iterdir()} == before


def test_a_file_of_others_is_replaced_when_asked(in_folder):
    rt.run(PRESS, output="other.txt", force=True)
    assert rt.compare("other.txt", "trace.h5").same


WRITES_LATE = PENALTY + '''
class Late(Penalty):
    def step(self, device, time_s):
        with open("late.h5", "w") as other:
            other.write("not a result")
        return super().step(device, time_s)

rt.register(Late, "late")
try:
    rt.run(PRESS | {"renderer": {"name": "late"}}, output="late.h5")
except rt.InputError as refused:
    print(refused)
'''


def test_a_file_of_others_that_appears_during_a_run_is_kept(in_python, tmp_path):
    said = in_python(WRITES_LATE)
    assert "late.h5: was written by another program while this one computed" in said
    assert (tmp_path / "late.h5").read_text() == "not a result"


def test_a_refusal_of_the_text_of_a_file_begins_with_the_file(in_folder):
    (in_folder / "press.json").write_text(json.dumps(PRESS | {"duration_s": -1}))
    with pytest.raises(rt.InputError, match="^press.json: duration_s = -1: expected"):
        rt.run("press.json")
    (in_folder / "press.json").write_text(json.dumps(PRESS))
    with pytest.raises(rt.InputError, match="^duration_s = -1: expected"):
        rt.run("press.json", set={"duration_s": -1})


def test_an_input_is_never_replaced(in_folder):
    (in_folder / "press.json").write_text(json.dumps(PRESS))
    with pytest.raises(rt.InputError, match="press.json"):
        rt.run("press.json", output="press.json", force=True)
    assert json.loads((in_folder / "press.json").read_text()) == PRESS


def test_the_environment_is_that_of_the_command_line(in_python, monkeypatch, command_line, tmp_path):
    monkeypatch.setenv("REMOTE_TOUCH_ISA", "x86-64")
    assert in_python('import remote_touch as rt; print(rt.run("fig4.12").attrs["isa"])', fresh=True) == "x86-64\n"
    monkeypatch.setenv("REMOTE_TOUCH_ISA", "x86-64-v9")
    out = in_python('try:\n    import remote_touch\nexcept ValueError as error:\n    print(error)', fresh=True)
    assert out.startswith("REMOTE_TOUCH_ISA = x86-64-v9: expected x86-64 up to")
    monkeypatch.delenv("REMOTE_TOUCH_ISA")
    monkeypatch.setenv("REMOTE_TOUCH_DATA", os.fspath(tmp_path))
    out = in_python('''
import remote_touch as rt
try:
    rt.run({"scenario": {"name": "recording", "path": "absent"}, "renderer": {"name": "proxy"},
            "trajectory": {"name": "waypoints", "waypoints": [[0, 0, 0, 0], [0, 0, 0.1, 0.1]]}})
except rt.InputError as error:
    print(error)''', fresh=True)
    assert f"REMOTE_TOUCH_DATA = {tmp_path}" in out

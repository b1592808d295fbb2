"""Studies: what the library makes of runs, and what it refuses."""
import concurrent.futures
import json
import multiprocessing
import re
import subprocess
import sys

import h5py
import numpy as np
import pytest
import remote_touch as rt
from conftest import PRESS, ROOT, STUDY_PAGE
from remote_touch import InputError, studies, theory
from remote_touch.studies import Rows, line, product, study


@study("test-depth", "how hard a plane pushes, over the depth", title="A press", caption="A plane that is pressed.", quick_coarse=2)
def press(s):
    rows = s.grid({"depth": [0.005, 0.01], "seed": [1, 2]},
                  lambda cell: (PRESS, {"trajectory.depth_m": cell.depth, "seed": cell.seed}),
                  {"force": lambda run: run.norm("force").max(), "twice": lambda run, cell: 2 * cell.depth})
    s.table("forces", "largest force", depth=(rows.depth, "m", "depth"), force=(rows.force, "N", "largest force"),
            name=([f"seed {seed}" for seed in rows.seed], "1", "name"))
    s.panel("Largest force", "depth (m)", "force (N)", [line("forces", "depth", "force", "proxy")], x_range=(0, 0.02))
    claims = s.claims("a press: ")
    claims.at_least("the plane pushes: smallest force", rows.force.min(), 0.1, "N")
    claims.agrees("the depth is doubled: difference", rows.twice.sum(), 0.06, 0.001)


def made(folder, name="test-depth", **options):
    folder.mkdir(exist_ok=True)
    result = studies.make(name, folder, **options)
    return result, h5py.File(folder / f"fig{name}.h5"), json.loads((folder / "claims.json").read_text())


def text(file, name):
    return file.attrs[name].decode()


def declared(name, make):
    """A study that a test declares."""
    study(name, "of a test")(make)
    return name


def test_a_study_writes_the_files_of_a_figure(tmp_path):
    result, file, claims = made(tmp_path)
    assert text(file, "schema") == "remote-touch-figure/3" and text(file, "figure") == "test-depth"
    assert text(file, "summary").startswith("how hard") and len(json.loads(text(file, "config"))) == 1
    assert file["tables/forces/force"].attrs["units"] == b"N" and file["tables/forces/force"][()].min() > 0.1
    assert b"".join(file["tables/forces/name"][0]) == b"seed 1"
    assert list(file["panels/0"].attrs["x_range"]) == [0, 0.02]
    assert [claim["verdict"] for claim in claims] == ["pass", "pass"] == [claim.verdict for claim in result.all_claims]
    assert claims[0]["claim"] == "a press: the plane pushes: smallest force" and claims[0]["criterion"] == "at least 0.1"
    assert claims[1]["unit"] == "standard errors" and claims[1]["measured"] < 1e-9


def test_the_file_has_configurations_as_the_program_writes_them(tmp_path):
    _, file, _ = made(tmp_path, declared("test-text", lambda s: (s.runs([PRESS]), s.uses(PRESS), s.measure([PRESS], len))))
    used = rt.run(PRESS).attrs["config"]
    assert text(file, "config") == f"[{used}, {used}, {used}]"


def test_an_executor_changes_no_bit(tmp_path):
    in_the_air = declared("test-free", lambda s: s.run(PRESS, {"trajectory.depth_m": -0.01}))
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as workers:
        _, by_workers, _ = made(tmp_path / "workers", executor=workers)
        free, _, _ = made(tmp_path / "workers", in_the_air, executor=workers)
    _, by_threads, _ = made(tmp_path / "threads")
    assert by_workers.attrs["digest"] == by_threads.attrs["digest"] and by_workers.attrs["config"] == by_threads.attrs["config"]
    assert free.notes == made(tmp_path / "threads", in_the_air)[0].notes and "1 of 1 runs: " in free.notes[0]


SWEEP = {"title": "depth", "experiment": PRESS, "axes": [{"parameter": "trajectory.depth_m", "from": 0.002, "to": 0.01, "count": 5}],
         "measures": ["max_force"]}


def test_a_coarse_map_leaves_claims_about_it_open(tmp_path):
    def mapped(s):
        cells = s.map(SWEEP)
        s.claims(of_map=True).at_least("a map: forces", cells.max_force.min(), 0)
        s.claims().at_most("no map: number of cells", cells.max_force.size, 5)
    name = declared("test-map", mapped)
    _, whole, claims = made(tmp_path / "whole", name)
    assert [claim["verdict"] for claim in claims] == ["pass", "pass"] and "Made from" not in text(whole, "caption")
    _, coarse, claims = made(tmp_path / "coarse", name, coarse=2)
    assert [claim["verdict"] for claim in claims] == ["open", "pass"] and claims[1]["measured"] == 3
    assert "Made from 3 of the 5 runs of its maps: one in 2" in text(coarse, "caption")


def test_claims_judge():
    entry = studies.Entry("judged", "", None, {"title": "", "caption": "", "source": "a book"}, 1, "")
    s = studies.Study(entry)
    claims = s.claims("x: ", set_up=True)
    claims.at_most("a", 1, 2)
    claims.at_most("b", float("nan"), 2)
    claims.between("c", 3, 1, 2)
    claims.differs("d", 1.5, 1, 2, paper="7")
    claims.agrees("e", 1, 2, 0.1)
    claims.agrees("f", 1, 1, 0)  # no error: nothing can be judged
    assert [claim.verdict for claim in s.all_claims] == ["pass", "fail", "fail", "differs", "fail", "fail"]
    assert all(claim.set_up and claim.source == "a book" for claim in s.all_claims)


def test_rows():
    rows = Rows(a=np.array([1, 1, 2]), b=np.array([3, 4, 5]))
    assert rows.where(a=1).b.tolist() == [3, 4] and len(rows) == 3 and len(Rows()) == 0
    assert [(cell.x, cell.y) for cell in product({"x": [1, 2], "y": [3, 4]})] == [(1, 3), (1, 4), (2, 3), (2, 4)]
    assert Rows(a=0.1 * np.arange(5)).where(a=0.3).a.tolist() == [0.1 * 3]
    with pytest.raises(AttributeError, match="no column 'c': there is a, b"):
        rows.c
    with pytest.raises(InputError, match="no row has a = 3"):
        rows.where(a=3)


def test_theory_and_estimates():
    assert theory.critical_acceleration(0.00499, 30) == pytest.approx(4.491)  # (4.14)
    acceleration = theory.bound_acceleration(r1_m=0.00499, frame_rate_hz=30, start_velocity_m_per_s=0.1, updates=10,
                                             thickness_m=0.002, normal_error=0.05)
    assert 0.00499 + 0.002 == pytest.approx(acceleration / 900 + (0.1 + 9 * acceleration / 30) / 30 * 0.05)  # (4.25)
    assert theory.exact_interval(0, 10) == pytest.approx((0, 1 - 0.025 ** 0.1))
    assert theory.estimated_fraction(5, 5)[0] == 0.5
    value, low, high = theory.estimated_mean(np.linspace(0, 1, 11))
    assert value == pytest.approx(0.5) and low < 0.5 < high and low + high == pytest.approx(1)
    assert theory.fit_polynomial([0, 1, 2, 3], [1, 3, 5, 7], [0, 1]) == pytest.approx([1, 2])
    assert {"impact_force_N", "delay_onset"} < {*theory.__all__}
    for refused in (lambda: theory.exact_interval(5, 3), lambda: theory.noisy_jump_m(0.01, [], 0.001),
                    lambda: theory.sinusoid_in([0.0], [1.0, 2.0], 1), lambda: theory.exact_wall_limit_N_per_m(mass_kg=0),
                    lambda: theory.first_impact(speed_m_per_s=np.nan, way_m=1, gap_m=1, natural_frequency_hz=1),
                    lambda: theory.bar_in_slot(0.04, 0.005, 0.02, np.nan), lambda: theory.estimated_fraction(-1, 5),
                    lambda: theory.fit_polynomial([1, 2, 3], [1], [0, 1])):
        with pytest.raises(InputError, match="theory.*expected"):
            refused()


def test_doors_to_scenes_refuse_what_they_cannot_use():
    scene = rt.scene("mesh-scene", mesh="fork", sensor="structured-light", width=64, height=48, focal_px=52)
    cloud, times = scene.cloud(0), np.array([[0, 7], [0.1, 7], [0.2, 7]])[:, 0]
    points = np.zeros((3, 3))
    smooth = [cloud.filtered(0, 0, 64, 48, filter_window=5, **more).points for more in ({}, {"device": "cpu", "exact": True})]
    assert np.array_equal(*smooth, equal_nan=True)  # a whole section depth_pipeline is accepted
    assert scene.signed_distances(points, times).tolist() == [scene.signed_distance((0, 0, 0), time_s) for time_s in times]
    sensor = rt.DepthSensor(sensor="structured-light", width=np.int64(64), height=48, focal_px=52)
    for refused in (lambda: scene.signed_distances(points, [0, 1]), lambda: scene.signed_distances(points, np.nan),
                    lambda: cloud.surface_distances(points, np.nan), lambda: cloud.surface_distances(points, 0),
                    lambda: cloud.window(0, 0, 65, 1), lambda: sensor.measured(np.ones((64, 48))),
                    lambda: scene.true_image(0, {"width": 4}, np.eye(4)), lambda: scene.true_image(0, cloud.camera, np.full((4, 4), np.nan)),
                    lambda: cloud.rule_weights({"name": "half-space", "normal": [0, 0, 0]})):
        with pytest.raises(InputError, match="expected"):
            refused()


def refusal(folder, make, **options):
    with pytest.raises(InputError) as error:
        made(folder, declared("test-refused", make), **options)
    assert not (folder / "figtest-refused.h5").exists()
    return str(error.value)


def refusal_with(folder, monkeypatch, **options):
    monkeypatch.delitem(studies.STUDIES, "test-refused", raising=False)
    return refusal(folder, lambda s: None, **options)


def test_a_tool_is_a_mesh_about_its_centre_of_mass():
    vertices, triangles = rt.tool_mesh(tool_mesh="slab-10", tool_voxel_m=0.002)
    assert np.abs(vertices).max(axis=0) == pytest.approx([0.02, 0.005, 0.02]) and {*triangles.ravel()} == {*range(len(vertices))}
    a, b, c = np.moveaxis(vertices[triangles], 1, 0)
    assert np.sum(a * np.cross(b, c)) / 6 == pytest.approx(0.04 * 0.01 * 0.04)  # the volume: triangles face outwards
    for settings in ({"tool_mesh": "no-such-tool"}, {"tool_voxel_m": -1}, {"mesh": "key"}):
        with pytest.raises(InputError, match="expected|unknown"):
            rt.tool_mesh(**settings)


def test_files_of_others_are_not_replaced(tmp_path, monkeypatch):
    for name, text_ in (("figtest-refused.h5", "hello"), ("claims.json", '{"mine": 1}')):
        (tmp_path / name).write_text(text_)
        with pytest.raises(InputError):
            monkeypatch.delitem(studies.STUDIES, "test-refused", raising=False)
            made(tmp_path, declared("test-refused", lambda s: None))
        assert (tmp_path / name).read_text() == text_
        (tmp_path / name).unlink()


def test_refusals(tmp_path, monkeypatch):
    def refuse(make):
        monkeypatch.delitem(studies.STUDIES, "test-refused", raising=False)
        return refusal(tmp_path, make)
    assert "expected an experiment's name" in refuse(lambda s: s.run("no-such-experiment"))
    assert "scenario.noise_sigma_m = -1" in refuse(lambda s: s.run("fig4.12", {"scenario.noise_sigma_m": -1}))
    point = dict(x=([1.0], "m", "x"), name=(["one"], "1", "name"))
    assert "asks for t/y: expected a column" in refuse(lambda s: (s.table("t", "t", **point), s.panel("", "", "", [line("t", "x", "y")])))
    assert "asks for t/name" in refuse(lambda s: (s.table("t", "t", **point), s.panel("", "", "", [line("t", "x", "name")])))
    assert "asks for u/x" in refuse(lambda s: s.panel("", "", "", [line("u", "x", "x")]))
    assert "expected (row, column)" in refuse(lambda s: s.panel("", "", "", [], at=(-1, 0)))
    assert "values: expected another name" in refuse(lambda s: s.table("t", "t", values=([1.0], "m", "x")))
    assert "expected another word for each table" in refuse(lambda s: (s.table("t", "t", **point), s.table("t", "t", **point)))
    assert "expected another word for each table" in refuse(lambda s: s.table("t/u", "t", **point))
    assert "expected a list of numbers" in refuse(lambda s: s.table("t", "t", x=([[1.0]], "m", "x")))
    assert "depth is an axis and a column" in refuse(lambda s: s.grid({"depth": [1]}, lambda cell: PRESS, {"depth": len}))
    assert "takes no settings" in refusal_with(tmp_path, monkeypatch, set=["a=1"])
    for name in ("", "4.12", "../evil", "A b"):
        with pytest.raises(InputError, match="expected small letters"):
            study(name, "")(test_rows)
    assert "differ in length: a 2, b 1" in refuse(lambda s: s.table("t", "t", a=([1, 2], "1", "a"), b=([1], "1", "b")))
    assert "unknown style of a curve: wave" in refuse(
        lambda s: (s.table("t", "t", **point), s.panel("", "", "", [studies.Curve("t", "x", "x", "wave")])))
    with pytest.raises(InputError, match="declared twice"):
        study("test-depth", "again")(test_rows)


def test_a_missing_recording_is_told(tmp_path):
    name = declared("test-missing", lambda s: s.run("fig4.16-recorded"))
    _, file, claims = made(tmp_path, name)
    assert claims[0]["verdict"] == "not run" and "REMOTE_TOUCH_DATA" in claims[0]["criterion"]
    assert text(file, "caption").startswith("Not run: ")


SCRIPT = """
import sys
from remote_touch.studies import line, main, study
@study("mine", "of a user", title="Mine", caption="Of a user.", takes_settings=True)
def mine(s):
    s.table("t", "t", x=([1, 2], "m", "place"), y=([1, 3], "N", "force"))
    s.panel("A line", "x (m)", "y (N)", [line("t", "x", "y")])
    s.claims().at_most("it is small: largest", 3, float(s.overrides[0]) if s.overrides else 2)
if __name__ == "__main__":
    sys.exit(main())
"""


def test_a_file_is_a_program(tmp_path):
    (tmp_path / "mine.py").write_text(SCRIPT)
    call = lambda *words: subprocess.run([sys.executable, "-B", "mine.py", *words], cwd=tmp_path, capture_output=True, text=True, check=False)
    held = call("-o", "out", "--set", "4", "--format", "pdf")
    assert held.returncode == 0, held.stderr
    assert {file.name for file in (tmp_path / "out").iterdir()} == {"figmine.h5", "figmine.png", "figmine.pdf", "figmine.small.png",
                                                                    "claims.json", "index.html"}
    assert "pass    it is small: largest: 3 1 (at most 4)" in held.stdout
    failed = call("-o", "out", "--no-pictures")
    assert failed.returncode == 1 and "FAIL    it is small" in failed.stdout
    assert call("--list").stdout.split()[0] == "mine"
    assert call("--processes", "0").stderr == "studies: processes = 0: expected 1 to 4096\n"
    wrong = call("yours")
    assert wrong.returncode == 2 and wrong.stderr == "studies: study yours: unknown: expected one of mine\n"


def test_the_script_of_the_page(tmp_path):
    script = re.search(r"^```python\n(.*?)^```", STUDY_PAGE.read_text(), re.MULTILINE | re.DOTALL).group(1)
    (tmp_path / "soft_wall.py").write_text(script)
    done = subprocess.run([sys.executable, "-B", "soft_wall.py", "-o", "soft_wall"], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and "pass    a spring on a plane" in done.stdout, done.stdout + done.stderr
    assert (tmp_path / "soft_wall" / "figsoft-wall.png").exists()


def test_every_study_of_the_project_is_declared():
    """Each file in data/studies that declares a study is a program, and all can be imported together."""
    paths = sorted((ROOT / "data" / "studies").glob("*/*.py"))
    for path in paths:
        if "@study(" in path.read_text():
            assert "sys.exit(main())" in path.read_text(), path
    listed = subprocess.run([sys.executable, "-B", "-m", "remote_touch.studies", *paths, "--", "--list"], capture_output=True, text=True,
                            check=True).stdout.splitlines()
    assert len(listed) >= 25 and any(line.startswith("camera-error ") for line in listed)


def lost_by_the_rules(beside_m, moved_m, phase):
    """Whether a proxy at rest is lost, by the rules of 4.2 alone, frame by frame in one dimension: heights along the normal of a
    plane of points that rises by moved_m a frame."""
    r1_m, r2_m, r3_m, rc_m = 0.00499, 0.00501, 0.01, 0.005
    rest_m, height_m, step_before_m, has_normal = np.sqrt(rc_m ** 2 - beside_m ** 2), 0.0, 0.0, False
    for frame in range(40):
        plane_m = -(30 - frame + phase) * moved_m
        height_m += step_before_m  # (4.3)
        if height_m < plane_m:
            return True
        nearest_m, step_m = np.hypot(height_m - plane_m, beside_m), 0.0
        if nearest_m < r1_m:
            step_m = plane_m + rest_m - height_m  # (4.10)
        elif nearest_m > r2_m:
            step_m = max(0.0, plane_m + rest_m) - height_m  # (4.9)
        height_m += step_m
        step_before_m = max(0.0, step_before_m + (step_m if has_normal else 0))  # (4.13) uses the normal from before the frame
        has_normal = has_normal or np.hypot(height_m - plane_m, beside_m) < r3_m
    return False


def test_the_law_of_the_first_touch_is_that_of_the_rules(monkeypatch):
    monkeypatch.syspath_prepend(ROOT / "data" / "studies" / "proxy")
    import first_touch
    phases = (np.arange(200) + 0.5) / 200
    for beside_m in (0, 0.00075, 0.0010606601717798212):
        law = first_touch.Touches("", "", 30, beside_m, 0)
        for moved_m in np.arange(0.0045, 0.0105, 0.00043):
            followed = np.mean([lost_by_the_rules(beside_m, moved_m, phase) for phase in phases])
            assert abs(law.derived(30 * moved_m) - followed) <= 1 / 200

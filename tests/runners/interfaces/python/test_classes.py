"""Classes of Python in experiments: renderers, scenarios, trajectories. Each script runs in a Python of its own."""
import hashlib

from class_scripts import COMMON, PENALTY
from conftest import digest_in

def test_a_renderer_is_the_built_in_one(in_python):
    in_python(PENALTY + '''
AT_REST = {**PRESS, "scenario": {"name": "flat-grid"},
           "trajectory": {"name": "waypoints", "waypoints": [[0, 0.01, 0, 0], [0.001, 0.002, 0, 0.2]]}}
for experiment in (PRESS, AT_REST):
    mine = rt.run(experiment, set={"renderer": {"name": Penalty}})
    theirs = rt.run(experiment, set={"renderer": {"name": "penalty"}})
    assert float(theirs.max_force) > 0.5, float(theirs.max_force)
    for name in ("force", "normal", "nearest_distance", "signed_distance", "hip_position", "slave_command"):
        np.testing.assert_allclose(mine[name], theirs[name], rtol=1e-6, atol=1e-7, err_msg=name)
    for name in ("state", "contact_count", "frame_index", "frame_hash", "converged", "status", "proxy_steps"):
        np.testing.assert_array_equal(mine[name], theirs[name], err_msg=name)
    for name in theirs.data_vars:  # measures of contact too, which need rest_distance_m and spring_N_per_m
        if not theirs[name].dims:
            np.testing.assert_allclose(mine[name], theirs[name], rtol=1e-5, atol=1e-6, err_msg=name)
''')


def test_a_slave_touches_a_scene_of_python_and_follows_a_renderer_of_python(in_python):
    in_python(PENALTY + '''
class Table(rt.Scenario):
    "the plane y = 0"
    frame_rate_hz, frame_count = 30, 1
    def cloud(self, frame):
        x, z = (grid.ravel() for grid in np.meshgrid(np.linspace(-0.02, 0.02, 30), np.linspace(-0.02, 0.02, 30)))
        return np.column_stack([x, 0 * x, z])
    def signed_distance(self, p, time_s):
        return p[1]
rt.register(Table, "python-table")
PUSH = {"scenario": {"name": Table}, "renderer": {"name": Penalty}, "slave": {}, "duration_s": 0.6,
        "trajectory": {"name": "waypoints", "waypoints": [[0, 0.02, 0, 0], [0, -0.002, 0, 0.1]]}}
sent = rt.run(PUSH)
np.testing.assert_array_equal(sent.slave_command, sent.hip_position)  # the position that the class sends
assert sent.slave_position.dims == ("time", "xyz") and sent.slave_force.attrs["units"] == "N"
np.testing.assert_allclose(sent.slave_clearance, sent.slave_position[:, 1] - 0.005, atol=1e-12)
assert float(sent.max_slave_force) > 1 and float(sent.slave_force[-1, 1]) > 1
assert "slave without surface" not in sent.attrs.get("notes", "")
felt = rt.run(PUSH, set={"feedback": {"force": "slave-force"}})
np.testing.assert_array_equal(felt.device_force, felt.slave_force)  # without a delay
np.testing.assert_array_equal(felt.slave_position, sent.slave_position)
''')


def test_a_run_without_what_a_renderer_needs_is_refused(in_python):
    in_python(PENALTY + '''
class Careful(Penalty):
    "needs normals and rows"
    needs = ("normals", "organised")
rt.register(Careful, "careful")
try:
    rt.run(PRESS, set={"renderer": {"name": "careful"}})
except rt.InputError as error:
    assert str(error).startswith('renderer.name = "careful": needs normals'), error
else:
    raise AssertionError("it ran")
''')


def test_a_cloud_without_points_has_arrays_of_length_0(in_python):
    in_python(COMMON + '''
empty = rt.Cloud(np.zeros((0, 3)))
for column in (empty.x, empty.y, empty.z):
    assert column.shape == (0,) and column.dtype == np.float64 and not column.flags.writeable, column
assert len(empty) == 0 and empty.points.shape == (0, 3)
assert empty.nx is None and empty.normals is None and empty.colour is None and empty.stiffness_N_per_m is None
''')


def test_live_settings_change_during_a_run(in_python):
    in_python(PENALTY + '''
change = [{"time_s": 0.1, "parameter": "renderer.stiffness_N_per_m", "value": 1200}]
a, b = (rt.run(PRESS, set={"renderer": {"name": name}, "changes": change}) for name in ("python-penalty", "penalty"))
np.testing.assert_allclose(a.force, b.force, rtol=1e-6, atol=1e-7)
one = rt.run(PRESS, set={"renderer": {"name": Penalty}})
assert not np.allclose(one.force, a.force)
''')


def test_a_sweep_over_a_class_does_not_depend_on_threads(in_python):
    in_python(PENALTY + '''
sweep = {"title": "presses", "experiment": {**PRESS, "renderer": {"name": Penalty}},
         "axes": [{"parameter": "renderer.stiffness_N_per_m", "values": [300, 600, 1200]}], "replicates": 2,
         "measures": ["max_force"]}
one, two = rt.sweep(sweep, threads=1), rt.sweep(sweep, threads=2, output="map.h5")
assert one.identical(two) and (one.state == 2).all()
assert one.max_force[0, 0] < one.max_force[1, 0] < one.max_force[2, 0]
assert rt.replay("map.h5", cell=(1,), replicate=1).max_force == two.max_force[1, 1]
''')


def test_a_class_is_on_the_scorecard(in_python):
    in_python(PENALTY + '''
tables = rt.scorecard(["penalty", Penalty], scenes=["free-2"], seeds=2, output="card")
success = tables["success"]
by_method = {}
for name in success.data_vars:
    assert success[name].sizes["row"] > 0
text = json.dumps({name: success[name].values.tolist() for name in success.data_vars})
assert "python-penalty" in text or "python-penalty" in tables["measures"].attrs["config"], text
report = json.load(open("card/scorecard.json"))
assert [m if isinstance(m, str) else m["name"] for m in report["methods"]] == ["penalty", "python-penalty"]
''')


def test_results_record_the_class_and_the_hash_of_its_file(tmp_path, in_python, command_line):
    (tmp_path / "mine.py").write_text(PENALTY)
    source = hashlib.sha256((tmp_path / "mine.py").read_bytes()).hexdigest()
    out = in_python('import remote_touch as rt, sys; sys.path.insert(0, "."); import mine; '
                    'r = rt.run(mine.PRESS, set={"renderer": {"name": mine.Penalty}}, output="a.h5"); '
                    'print(r.attrs["program"], r.attrs["program_sha256"])')
    assert out.split() == ["Python", "mine.py:", "Penalty", source]
    assert source in command_line("inspect", tmp_path / "a.h5")


def test_a_class_that_is_not_used_changes_no_digest(in_python, command_line, tmp_path):
    out = in_python(PENALTY + 'print("digest", rt.run("fig4.12").attrs["digest"])')
    assert digest_in(out) == digest_in(command_line("run", "fig4.12", "-o", tmp_path / "a.h5"))


SCENE = COMMON + '''
@rt.register("waves")
class Waves(rt.Scenario):
    """A wavy floor."""
    settings = {"sigma_m": rt.Setting(0.001, low=0, high=1), "count": rt.Setting(41, low=2, high=500, integer=True),
                "steep": rt.Setting(True), "word": rt.Setting("word"), "at_m": rt.Setting((0, 0.01, 0), low=-1, high=1)}
    frame_count = 10
    def __init__(self):
        side = np.linspace(-0.04, 0.04, self.count)
        self.x, self.z = (a.ravel() for a in np.meshgrid(side, side))
    def cloud(self, frame):
        noise = self.sigma_m * self.key.normals("point_position", frame, self.x.size)
        return np.column_stack([self.x, self.surface_height(self.x, self.z, frame / 30), self.z]) + noise
    def surface_height(self, x, z, time_s):
        return self.at_m[1] + 0.002 * np.sin(100 * x) * self.steep
    def signed_distance(self, p, time_s):
        return p[1] - self.surface_height(p[0], p[2], time_s)

@rt.register("dive")
class Dive(rt.Trajectory):
    duration_s = 0.3
    def at(self, time_s):
        return (0, 0.03 - 0.1 * time_s, 0)

DIVE = {"scenario": {"name": "waves"}, "renderer": {"name": "proxy"}, "trajectory": {"name": "dive"}}
'''


def test_a_scene_and_a_motion(in_python):
    in_python(SCENE + '''
run = rt.run(DIVE)
t = run.time.values
np.testing.assert_array_equal(run.hip_position.sel(xyz="y"), 0.03 - 0.1 * t)
proxy = run.proxy_position.values
truth = proxy[:, 1] - (0.01 + 0.002 * np.sin(100 * proxy[:, 0]))
np.testing.assert_array_equal(run.signed_distance, truth)
assert float(run.max_force) > 1 and int(run.frame_index.max()) == 8, run.frame_index.values.max()
assert rt.run(DIVE).attrs["digest"] == run.attrs["digest"]
other = rt.run(DIVE, seed=2)
assert (other.frame_hash != run.frame_hash).all()
flat = rt.run(DIVE, set={"scenario": {"name": "waves", "steep": False, "sigma_m": 0, "word": "other", "at_m": [0, 0.02, 0]}})
# r_c above the plane at rest
pressed = flat.isel(time=-1)
assert abs(float(pressed.proxy_position[1]) - 0.025) < 2e-4, pressed.proxy_position.values
config = json.loads(flat.attrs["config"])["scenario"]
assert config == {"name": "waves", "sigma_m": 0.0, "count": 41, "steep": False, "word": "other", "at_m": [0.0, 0.02, 0.0]}
assert "default 41; allowed integers 2 to 500" in rt.describe("waves")
''')


def test_noise_of_a_scene_in_a_sweep_is_its_own(in_python):
    """Every cell and replicate has another key; a run alone has the noise that it had in the sweep."""
    in_python(SCENE + '''
sweep = rt.sweep({"title": "dives", "experiment": DIVE, "replicates": 3, "measures": ["max_force"],
                  "axes": [{"parameter": "scenario.sigma_m", "values": [0, 0.001]}]}, threads=2)
assert len(set(sweep.max_force.values[0])) == 1 and len(set(sweep.max_force.values[1])) == 3
assert rt.replay(sweep, cell=(1,), replicate=2).max_force == sweep.max_force[1, 2]
''')


def test_frames_go_in_and_out_as_arrays(in_python):
    """What a renderer sees is, bit for bit, what the scenario gave, with all columns; and a built-in scene is what its
    Scene says."""
    in_python(COMMON + '''
seen = []
@rt.register
class Looks(rt.Renderer):
    def on_frame(self, frame):
        seen.append(frame)
    def step(self, device, time_s):
        return rt.Output()
    def max_stiffness_N_per_m(self):
        return 0
points = np.arange(30.0).reshape(10, 3) / 100
points[3] = np.nan
normals = np.tile([0, 1.0, 0], (10, 1))
@rt.register
class Given(rt.Scenario):
    def cloud(self, frame):
        return rt.Cloud(points, normals=normals, colour=np.arange(10), fixture_radius_m=np.full(10, 0.01),
                        stiffness_N_per_m=np.full(10, np.nan), columns=5)
still = {"scenario": {"name": "given"}, "renderer": {"name": "looks"}, "duration_s": 0.1,
         "trajectory": {"name": "waypoints", "waypoints": [[0, 0, 0, 0], [0, 0, 0.1, 0.1]]}}
rt.run(still)
frame = seen[0]
np.testing.assert_array_equal(frame.points, points)
np.testing.assert_array_equal(frame.normals, normals)
np.testing.assert_array_equal(frame.colour, np.arange(10))
np.testing.assert_array_equal(frame.fixture_radius_m, np.full(10, 0.01))
assert np.isnan(frame.stiffness_N_per_m).all() and frame.columns == 5 and frame.index == 0 and len(frame) == 10
assert frame.x.base is frame and not frame.x.flags.writeable and frame.x.dtype == np.float64  # a view, not a copy
del seen[:]
rt.run(PRESS, set={"renderer": {"name": Looks}, "seed": 5})
scene = rt.scene("moving-lift", key=rt.NoiseKey(seed=5), noise_sigma_m=0.001)
assert len(seen) == 6 == len({frame.index for frame in seen})
def rows(cloud):
    return cloud.points[np.lexsort(cloud.points.T)]
for frame in seen:
    assert frame.captured_s == scene.captured_s(frame.index)
    np.testing.assert_array_equal(rows(frame), rows(scene.cloud(frame.index)))
''')


def test_noise_is_that_of_the_built_in_scene(in_python):
    """An own noise model with the same key, use and frame makes the built-in noise, bit for bit."""
    in_python(COMMON + '''
key = rt.NoiseKey(seed=11, cell=3, replicate=2)
clean, noisy = (rt.scene("moving-lift", key=key, noise_sigma_m=s).cloud(4).points for s in (0, 0.0625))
normals = key.normals("point_position", 4, len(clean))
np.testing.assert_array_equal(clean + 0.0625 * normals, noisy)
assert abs(normals.mean()) < 0.02 and abs(normals.std() - 1) < 0.02
np.testing.assert_array_equal(key.normals("point_position", 4, 7), normals[:7])
assert (key.normals(12, 4, 100) != key.normals(13, 4, 100)).all()
u = key.uniforms("motion", 0, 1000)
assert u.shape == (1000, 4) and 0 < u.min() and u.max() < 1 and abs(u.mean() - 0.5) < 0.02
''')


def test_a_tool_and_a_motion_with_orientation(in_python):
    in_python(COMMON + '''
@rt.register
class Twist(rt.Renderer):
    degrees_of_freedom = 6
    def step(self, device, time_s):
        return rt.Output(torque_Nm=(0, 0, time_s), tool_orientation=device.orientation)
    def max_stiffness_N_per_m(self):
        return 0
@rt.register
class Turn(rt.Trajectory):
    duration_s = 0.2
    def at(self, time_s):
        height = self.scene.surface_height(0, 0, 0)
        return (0, height + 0.05, 0), (np.cos(time_s), 0, np.sin(time_s), 0)
run = rt.run({"scenario": {"name": "moving-lift"}, "renderer": {"name": "twist"}, "trajectory": {"name": "turn"}})
np.testing.assert_array_equal(run.torque.sel(xyz="z"), run.time)
np.testing.assert_allclose(run.hip_orientation.sel(wxyz="y"), np.sin(run.time), atol=1e-15)
np.testing.assert_array_equal(run.tool_orientation, run.hip_orientation)
''')


def test_a_cell_of_a_notebook_is_run_again(in_python):
    in_python(PENALTY + '''
before = rt.run(PRESS, set={"renderer": {"name": "python-penalty"}}).max_force
class Penalty(Penalty):
    def step(self, device, time_s):
        return rt.Output(force_N=(7, 0, 0))
rt.register(Penalty, "python-penalty")
assert rt.run(PRESS, set={"renderer": {"name": "python-penalty"}}).max_force == 7 != before
''')


def test_cost_of_a_tick(in_python):
    """Reported: a tick of the simplest renderer in Python, of the penalty method above, and of the one built in."""
    out = in_python(PENALTY + '''
@rt.register
class Nothing(rt.Renderer):
    def step(self, device, time_s):
        return rt.Output(force_N=device.position_m)
    def max_stiffness_N_per_m(self):
        return 1
for name in ("nothing", "python-penalty", "penalty"):
    run = rt.run(PRESS, set={"renderer": {"name": name}, "duration_s": 2 if name == "nothing" else 0.5}, timing=True)
    print(name, float(run.step_duration.median()))
''')
    ticks = {line.split()[0]: float(line.split()[1]) for line in out.splitlines()}
    print("\ntick of a renderer in Python that does nothing: {nothing:.3g} s; penalty method in NumPy {python-penalty:.3g} s, "
          "built in {penalty:.3g} s".format_map(ticks))
    assert len(ticks) == 3 and all(tick >= 0 for tick in ticks.values())


def test_settings_are_checked(in_python):
    out = in_python(PENALTY + '''
for bad in ({"stiffness_N_per_m": -1}, {"stiffness_N_per_m": "soft"}, {"stifness_N_per_m": 1}, {"contact_radius_m": 0.02}):
    try:
        rt.run(PRESS, set={"renderer": {"name": Penalty, **bad}})
    except rt.InputError as error:
        print(error)
''').splitlines()
    assert out[0].startswith("renderer.stiffness_N_per_m = -1: expected 0 to 10000")
    assert out[1].startswith('renderer.stiffness_N_per_m = "soft": expected')
    assert "stifness_N_per_m" in out[2] and "stiffness_N_per_m" in out[2]
    assert out[3] == "renderer.contact_radius_m = 0.02: expected below r3_m"


def test_no_registration_during_a_run(in_python):
    in_python(PENALTY + '''
class Registers(rt.Renderer):
    stiffness_N_per_m = 1
    def step(self, device, time_s):
        rt.register(Penalty, "other")
rt.register(Registers)
try:
    rt.run(PRESS, set={"renderer": {"name": Registers}})
except rt.InputError as error:
    assert "register: a run or a sweep is in progress" in str(error), error
else:
    raise AssertionError
''')


def test_a_scene_ends_with_its_run(in_python):
    in_python(COMMON + '''
kept = []
@rt.register
class Keeps(rt.Trajectory):
    duration_s = 0.1
    def __init__(self):
        kept.append(self.scene)
    def at(self, time_s):
        return (0, self.scene.signed_distance((0, 0, 0), time_s), 0)
rt.run(PRESS, set={"trajectory": {"name": Keeps}})
try:
    kept[0].cloud(0)
except rt.InputError as error:
    assert str(error) == "scene: its run has ended: expected a use during the run"
else:
    raise AssertionError
''')


# A cell of a notebook has no file.
NOTEBOOK = COMMON + '''
CELL = """
K = 600
def stiff(depth): return K * depth
class Base(rt.Renderer):
    stiffness_N_per_m = 600
    def rest_distance_m(self): return 0.0
class Mine(Base):
    names = frozenset(("a", "b", "c", "d"))
    settings = {"limit_N": rt.Setting(10.0, low=0, high=100)}
    def step(self, device, time_s):
        return rt.Output(force_N=(0, max(0, stiff(-device.position_m[1])), 0) if "a" in {"a", "b"} else None)
"""
def cell(text=CELL):
    exec(text, globals())
    rt.register(Mine, "mine")
def sha():
    return rt.run(PRESS, set={"renderer": {"name": "mine"}}).attrs["program_sha256"]
cell()
first = sha()
'''


def test_a_class_of_a_notebook_is_known_by_what_it_computes(in_python):
    script = NOTEBOOK + '''
for old, new in (("K = 600", "K = 601"), ("K * depth", "K + depth"), ("return 0.0", "return 0.1"), ("(10.0", "(11.0"),
                 ("position_m[1]", "position_m[0]"), ("max(0, ", "min(0, "), ('"d"', '"e"'), ("= 600\\n    def", "= 601\\n    def")):
    cell(CELL.replace(old, new))
    assert sha() != first, new
cell()
assert sha() == first
K = 5  # another cell, which registers no class
assert sha() != first
K = np.random.default_rng(1)
stiff = lambda depth: K.uniform() * depth
unknown = sha()
K = np.random.default_rng(1)
assert sha() != unknown  # nobody knows whether it computes the same
print(first)
'''
    assert len({in_python(script, fresh=True) for _ in range(2)}) == 1  # another process, another order of sets


def test_a_sweep_does_not_go_on_with_an_edited_class(in_python, tmp_path):
    base = tmp_path / "base.py"
    base.write_text("import remote_touch as rt\nclass Base(rt.Renderer):\n    stiffness_N_per_m = 600\n")
    begin = NOTEBOOK.index("class Base")
    script = NOTEBOOK[:begin] + "from base import Base\n" + NOTEBOOK[NOTEBOOK.index("class Mine"):] + '''
def sweep():
    return rt.sweep({"title": "t", "experiment": {**PRESS, "renderer": {"name": "mine"}}, "replicates": 2,
                     "axes": [{"parameter": "trajectory.depth_m", "values": [0.001, 0.002]}], "measures": ["max_force"]}, output="a.h5")
if sys.argv[1:] != ["again"]:
    sweep()
    sweep()  # goes on with the same class
    cell(CELL.replace("K = 600", "K = 700"))
try:
    sweep()
except rt.InputError as error:
    assert "a.h5" in str(error) and "program_sha256" in str(error), error
else:
    raise AssertionError
'''
    in_python(script)
    base.write_text(base.read_text() + "    def rest_distance_m(self): return 0.0\n")
    in_python(script, "again")


def test_a_class_reads_no_file_while_another_is_read(in_python):
    in_python(PENALTY + '''
for depth_m in (0.004, 0.005):
    rt.run(PRESS, set={"renderer": {"name": Penalty}, "trajectory.depth_m": depth_m}, output=f"{depth_m}.h5")
refusals = []
def validate(self):
    try:
        rt.open("0.004.h5")
    except rt.InputError as error:
        refusals.append(str(error))
Penalty.validate = validate
assert rt.compare("0.004.h5", "0.005.h5").differences
assert refusals and all("a file: this thread reads or writes another one" in text for text in refusals), refusals
Penalty.validate = lambda self: None
assert rt.compare("0.004.h5", "0.005.h5").differences
''')


def test_a_masked_point_is_missing(in_python):
    in_python(COMMON + '''
@rt.register
class Hole(rt.Scenario):
    settings = {"masked": rt.Setting(True)}
    def cloud(self, frame):
        side = np.linspace(-0.05, 0.05, 51)
        x, z = (grid.ravel() for grid in np.meshgrid(side, side))
        points = np.column_stack([x, 0 * x, z])
        hole = np.hypot(x, z) < 0.03
        return np.ma.masked_array(points, mask=np.repeat(hole[:, None], 3, 1)) if self.masked else points[~hole]
DIVE = {"name": "waypoints", "waypoints": [[0, 0.01, 0, 0], [0, -0.005, 0, 0.1]]}
def force(masked):
    return float(rt.run({**PRESS, "scenario": {"name": "hole", "masked": masked}, "trajectory": DIVE}).max_force)
assert force(True) == force(False) == 0
@rt.register("hole")
class Partly(Hole):
    def cloud(self, frame):
        return np.ma.masked_array(np.zeros((4, 3)), mask=[[True, False, False]] * 4)
try:
    force(True)
except rt.InputError as error:
    assert "row 0: a number is not finite" in str(error), error
else:
    raise AssertionError
''')

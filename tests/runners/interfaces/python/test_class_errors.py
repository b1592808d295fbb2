"""Mistakes in classes of Python end in one line that says where, with the exception as its cause."""
import json
import re

from class_scripts import COMMON

# Classes with a mistake, and how the line begins that says so.
ERRORS = [entry.split("\n-> ") for entry in '''
class A(rt.Renderer):
    def step(self, d, t): raise ValueError("the spring broke")
-> renderer a: A.step: ValueError: the spring broke (<string>, line

class A(rt.Renderer):
    def step(self, d, t): raise KeyError("two\\nlines")
-> renderer a: A.step: KeyError: 'two

class A(rt.Renderer):
    def step(self, d, t): return (1, 2, 3)
-> renderer a: A.step: returned <class 'tuple'>: expected rt.Output

class A(rt.Renderer):
    def step(self, d, t): return rt.Output(force_N=[1, 2])
-> renderer a: A.step: InputError: Output: force_N: an array of shape (2)

class A(rt.Renderer):
    def step(self, d, t): return rt.Output(force_N="abc")
-> renderer a: A.step: InputError: Output: force_N: an array of <U3: expected three numbers

class A(rt.Renderer):
    def step(self, d, t): return rt.Output(state="in")
-> renderer a: A.step: InputError: Output: state = in: expected free, contact, entrenched

class A(rt.Renderer):
    def step(self, d, t): return rt.Output(torque_Nm=(0, 0, 1))
-> renderer a: A.step: returned a torque

class A(rt.Renderer):
    def step(self, d): return rt.Output()
-> renderer a: A.step: TypeError:

class A(rt.Renderer): pass
-> renderer a: A.step: NotImplementedError: step(self, device, time_s) is missing

class A(rt.Renderer):
    def on_frame(self, frame): frame.x[0] = 1
    def step(self, d, t): return rt.Output()
-> renderer a: A.on_frame: ValueError: assignment destination is read-only

class A(rt.Renderer):
    def __init__(self): 1 / 0
-> renderer a: A.__init__: ZeroDivisionError: division by zero

class A(rt.Renderer):
    def step(self, d, t): sys.exit(3)
-> renderer a: A.step: SystemExit: 3

class A(rt.Scenario):
    def cloud(self, frame): return np.zeros((4, 2))
-> scenario a: A.cloud: points: an array of shape (4, 2): expected

class A(rt.Scenario):
    def cloud(self, frame): return [[0, 0, np.inf]]
-> scenario a: A.cloud: points: row 0: a number is not finite

class A(rt.Scenario):
    def cloud(self, frame): return [[0, np.nan, 1]]
-> scenario a: A.cloud: points: row 0: a number is not finite

class A(rt.Scenario):
    def cloud(self, frame): return np.zeros((4, 3), complex)
-> scenario a: A.cloud: points: an array of complex128

class A(rt.Scenario):
    def cloud(self, frame): return None
-> scenario a: A.cloud: points: an array of object

class A(rt.Scenario):
    frame_count = 0
    def cloud(self, frame): return [[0, 0, 0]]
-> scenario a: A.frame_count: expected 1 to

class A(rt.Scenario):
    frame_rate_hz = "fast"
    def cloud(self, frame): return [[0, 0, 0]]
-> scenario a: A.frame_rate_hz: TypeError: must be real number, not str

class A(rt.Scenario):
    def cloud(self, frame): return np.zeros((1, 3))
    def signed_distance(self, p, t): return "far"
-> scenario a: A.signed_distance: TypeError: must be real number, not str

class A(rt.Scenario):
    frame_count = 2.5
    def cloud(self, frame): return [[0, 0, 0]]
-> scenario a: A.frame_count: TypeError: 'float' object cannot be interpreted as an integer

class A(rt.Scenario):
    frame_count = 10**30
    def cloud(self, frame): return [[0, 0, 0]]
-> scenario a: A.frame_count: OverflowError: Python int too large

class A(rt.Trajectory):
    duration_s = 1
    def at(self, t): return (0, np.nan, 0)
-> trajectory a: A.at: a number is not finite

class A(rt.Trajectory):
    duration_s = 1
    def at(self, t): return (0, 0, 1e8)
-> trajectory a: A.at: a position more than 1000 m from the origin

class A(rt.Scenario):
    def cloud(self, frame): return [[1e6, 0, 0], [1e6, 1, 0]]
-> scenario a: A.cloud: points: all points are more than 1000 m from the origin

class A(rt.Trajectory):
    duration_s = 1
    def at(self, t): return (0, 0, 0), (1, 1, 0, 0)
-> trajectory a: A.at: its length is not 1

class A(rt.Trajectory):
    duration_s = -1
    def at(self, t): return (0, 0, 0)
-> trajectory a: A.duration_s: expected a number of 0 or more
'''.strip().split("\n\n")]


def test_errors_in_classes_are_one_line_with_their_cause(in_python):
    sources = [source for source, _ in ERRORS]
    said = json.loads(in_python(COMMON + f'''
import os
WAYPOINTS = {{"name": "waypoints", "waypoints": [[0, 0, 0, 0], [0, 0, 0.1, 0.1]]}}
said = []
for number, source in enumerate({sources!r}):
    exec(source)
    kind = A.__base__.__name__.lower()
    if kind == "renderer" and "max_stiffness" not in source:
        A.max_stiffness_N_per_m = lambda self: 1.0
    rt.register(A, f"a{{number}}")
    try:
        rt.run({{**PRESS, "trajectory": WAYPOINTS}}, set={{kind: {{"name": A}}}}, output="a.h5")
        said.append(["", False])
    except rt.InputError as error:
        said.append([str(error), error.__cause__ is not None])
    assert os.listdir(".") == [], os.listdir(".")
print(json.dumps(said))
'''))
    assert len(said) == len(ERRORS)
    for number, ((source, expected), (line, has_cause)) in enumerate(zip(ERRORS, said)):
        assert line.startswith(expected.replace(" a: ", f" a{number}: ", 1)), (source, line)
        assert "\n" not in line
        assert has_cause == bool(re.search(r": \w*(Error|Exit): ", line)), (source, line)


def test_an_error_in_a_class_keeps_its_cause_if_the_experiment_is_a_file(in_python):
    source, expected = next(each for each in ERRORS if "(rt.Scenario)" in each[0])
    line, has_cause = json.loads(in_python(COMMON + f'''
exec({source!r})
rt.register(A, "a")
with open("press.json", "w") as file:
    json.dump({{**PRESS, "trajectory": {{"name": "waypoints", "waypoints": [[0, 0, 0, 0], [0, 0, 0.1, 0.1]]}}}}, file)
try:
    rt.run("press.json", set={{"scenario": {{"name": "a"}}}}, output="a.h5")
except rt.InputError as error:
    print(json.dumps([str(error), error.__cause__ is not None]))
'''))
    assert line.startswith(expected)
    assert has_cause == bool(re.search(r": \w*(Error|Exit): ", line)), line


# What cannot be registered, and how the line begins that says so.
REFUSED = [entry.split("\n-> ") for entry in '''
rt.register(rt.Renderer)
-> Renderer: expected a class derived from

rt.register(int)
-> int: expected a class derived from

rt.register(a_class({}), "proxy")
-> renderer "proxy": is in the catalog already

rt.register(a_class({}), "Two Words")
-> renderer "Two Words":

rt.register(a_class({"settings": {"x": 3}}), "a")
-> renderer a: setting x: expected rt.Setting(...)

rt.register(a_class({"settings": {"x": rt.Setting(3, high=2)}}), "a")
-> renderer a: setting x: its value is not in its range

rt.register(a_class({"settings": {"a b": rt.Setting(3)}}), "a")
-> renderer a: setting a b: expected the name of an attribute

rt.register(a_class({"settings": {"x": rt.Setting("t", live=True)}}), "a")
-> renderer a: setting x: is live

rt.register(a_class({"degrees_of_freedom": 4}), "a")
-> a: degrees_of_freedom: expected 3 or 6

rt.register(a_class({"contact_model": "air"}), "a")
-> a: contact_model = air: expected points

rt.register(a_class({"needs": ("normals", "air")}), "a")
-> a: needs = air: expected normals, organised, regions, view

rt.run(PRESS, set={"renderer": {"name": a_class({})}})
-> class A: is not in the catalog
'''.strip().split("\n\n")]


def test_what_cannot_be_registered(in_python):
    calls = [call for call, _ in REFUSED]
    said = json.loads(in_python(COMMON + f'''
def a_class(members):
    return type("A", (rt.Renderer,), members)
said = []
for call in {calls!r}:
    try:
        eval(call)
        said.append("")
    except rt.InputError as error:
        said.append(str(error))
    assert "a" not in rt.list()["renderers"]
assert rt.run("fig4.12", set={{"duration_s": 0.01}}).sizes["time"] == 10
print(json.dumps(said))
'''))
    assert len(said) == len(REFUSED)
    for (call, expected), line in zip(REFUSED, said):
        assert line.startswith(expected), (call, line)

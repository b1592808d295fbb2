"""The package itself: import time, stubs, docstrings, examples, and what its page shows."""
import ast
import inspect
import pathlib
import re
import subprocess
import sys

import pytest
import remote_touch as rt
from conftest import EXAMPLES, PAGE, ROOT, STUDY_PAGE
from remote_touch import _core, calls, classes

IMPORT = ("import time; t = time.process_time(); import remote_touch; print(time.process_time() - t); import sys; "
          "print('numpy' in sys.modules, 'xarray' in sys.modules)")


def test_import_leaves_numpy_and_xarray_to_who_needs_them():
    """They take most of a second. How long the import takes is reported."""
    seconds, loaded = subprocess.run([sys.executable, "-B", "-c", IMPORT], capture_output=True, text=True,
                                     check=True).stdout.splitlines()
    print(f"\nimport remote_touch: CPU time {float(seconds):.3f} s")
    assert loaded == "False False"


PACKAGE = ROOT / "runners" / "interfaces" / "python" / "remote_touch"


def stub_functions():
    """Names and parameters of the functions of the stub; of a method Class.method."""
    found = {}

    def visit(body, prefix):
        for node in body:
            if isinstance(node, ast.ClassDef):
                found[prefix + node.name] = None
                visit(node.body, node.name + ".")
            elif isinstance(node, ast.FunctionDef):
                given = node.args
                found[prefix + node.name] = [arg.arg for arg in [*given.posonlyargs, *given.args, *given.kwonlyargs]]
    visit(ast.parse((PACKAGE / "_core.pyi").read_text()).body, "")
    return found


def bound_parameters(function):
    """Of a function of pybind11, whose first line of documentation is its signature."""
    line = function.__doc__.splitlines()[0]
    inner = line[line.index("(") + 1:line.rindex(") ->")]
    names = [part.split(":")[0].strip() for part in re.split(r", (?=\w+: |\*, |\*$)", inner)]
    return [re.sub(r"^self$|^arg0$", "self", name) for name in names if name and not name.startswith("*")]


@pytest.mark.parametrize("module", [calls, classes])
def test_public_functions_have_types(module):
    names = lambda function: [arg.arg for arg in [*function.args.args, *function.args.kwonlyargs]]
    for node in ast.parse(pathlib.Path(module.__file__).read_text()).body:
        for function in [node, *node.body] if isinstance(node, ast.ClassDef) else [node]:
            if not isinstance(function, ast.FunctionDef) or node.name.startswith("_") and node.name != "_Base":
                continue
            if function.name.startswith("_") and function.name != "__init__":
                continue
            if function.name == "register":  # its overloads have the types
                assert names(function) == [*inspect.signature(module.register).parameters]
                if not function.decorator_list:
                    continue
            given = [arg for arg in [*function.args.args, *function.args.kwonlyargs] if arg.arg != "self"]
            assert function.returns and all(arg.annotation for arg in given), function.name


def test_stubs_of_the_module():
    stubs = stub_functions()
    for name, parameters in stubs.items():
        found = _core
        for part in name.split("."):
            found = getattr(found, part)
        if parameters is not None and not isinstance(found, property) and not name.endswith("__"):
            assert bound_parameters(found) == parameters, name
        if name.endswith(".__init__"):
            assert bound_parameters(found) == parameters, name
    for name, value in vars(_core).items():
        if not name.startswith("_"):
            assert name in stubs, name
            if inspect.isclass(value):
                own = [member for member in vars(value) if not member.startswith("_")]
                assert set(own) <= {stub.split(".")[1] for stub in stubs if stub.startswith(name + ".")}, name


def test_everything_has_a_docstring():
    for name in rt.__all__:
        assert getattr(rt, name).__doc__, name
    for name in ("step", "on_frame", "max_stiffness_N_per_m", "rest_distance_m", "parameters_changed", "validate"):
        assert getattr(rt.Renderer, name).__doc__, name
    assert rt.__doc__ and rt.__version__ == _core.version()


def output_of(command, folder):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_example_own_noise(tmp_path):
    out = output_of([sys.executable, "-B", EXAMPLES / "own_noise.py"], tmp_path).splitlines()
    forces = [float(line.split("changes by ")[1].split(" N")[0]) for line in out[:3]]
    assert forces[0] < forces[1] < forces[2]
    assert out[3] == "the same seed again: the same bits"


def test_example_own_renderer(tmp_path):
    out = output_of([sys.executable, "-B", EXAMPLES / "own_renderer.py"], tmp_path)
    rows = {}
    for block in out.split("\n\n")[1:]:
        lines = block.strip().splitlines()
        rows[lines[0]] = [[float(number) for number in line.split()] for line in lines[3:]]
    assert rows["proxy"][0] == [0, 0, 0, 1]  # without noise it pops through only at 16 m/s2, above the bound (4.14)
    assert rows["fitted-plane"][0] == [0, 0, 0, 0]
    assert rows["proxy"][1][0] == 0.003 and rows["fitted-plane"][1][0] == 0.003


def test_example_plot_sweep(tmp_path):
    out = output_of([sys.executable, "-B", EXAMPLES / "plot_sweep.py"], tmp_path)
    assert out.startswith("map.png: {'noise_sigma_m': 5, 'acceleration_m_per_s2': 3, 'replicate': 3}")
    picture = (tmp_path / "map.png").read_bytes()
    assert picture.startswith(b"\x89PNG") and len(picture) > 5000
    again = output_of([sys.executable, "-B", EXAMPLES / "plot_sweep.py", "map.h5", "again.png"], tmp_path)
    assert again.replace("again", "map") == out
    assert (tmp_path / "again.png").read_bytes() == picture


def test_every_block_of_the_page_runs(tmp_path, monkeypatch):
    """In their order, in one folder and one interpreter, as a reader would."""
    blocks = re.findall(r"^```python\n(.*?)^```", PAGE.read_text(), re.MULTILINE | re.DOTALL)
    assert len(blocks) >= 5
    (tmp_path / "page.py").write_text("\n".join(blocks))
    output_of([sys.executable, "-B", "page.py"], tmp_path)


def test_no_other_page_has_python():
    """Which no test would run."""
    sys.path.insert(0, str(ROOT / "tests" / "system"))
    from page_files import pages
    assert [page for page in pages(ROOT) if re.search(r"^```python", page.read_text(), re.MULTILINE)] == [STUDY_PAGE, PAGE]


def test_an_installed_copy(tmp_path):
    """cmake --install --component python: the package alone, without the build folder."""
    build = pathlib.Path(_core.__file__).parents[2]
    output_of(["cmake", "--install", build, "--component", "python", "--prefix", tmp_path], tmp_path)
    package = tmp_path / "lib" / "python3" / "dist-packages"
    assert {file.name for file in PACKAGE.iterdir() if file.suffix != ".pyc" and file.is_file()} < {
        file.name for file in (package / "remote_touch").iterdir()}
    script = ("import sys; sys.path.insert(0, sys.argv[1]); import remote_touch as rt; "
              "print(rt.__file__, rt.run('fig4.12').attrs['digest'])")
    file, digest = output_of([sys.executable, "-B", "-c", script, str(package)], tmp_path).split()
    assert file == str(package / "remote_touch" / "__init__.py")
    assert digest == rt.run("fig4.12").attrs["digest"]


def test_an_engine_and_a_teleoperator_are_felt(tmp_path):
    """The ball of the engine is pushed by a force, and the recorded demonstration has one."""
    pytest.importorskip("ode", reason="python3-pyode is not installed")
    newtons, mm = map(float, re.search(r"up to ([\d.]+) N, and the ball rolled (\d+) mm", output_of(
        [sys.executable, "-B", EXAMPLES / "touch_a_physics_engine.py"], tmp_path)).groups())
    assert 1 < newtons < 20 and mm > 50
    steps, newtons = map(float, re.search(r"recorded, (\d+) of them in contact, up to ([\d.]+) N", output_of(
        [sys.executable, "-B", EXAMPLES / "force_for_robot_learning.py"], tmp_path)).groups())
    assert 5 < steps < 25 and 1 < newtons < 20


def test_examples_are_on_the_page():
    text = PAGE.read_text()
    for example in EXAMPLES.glob("*.py"):
        assert f"examples/{example.name}" in text

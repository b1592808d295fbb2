"""Base classes of own renderers, scenarios and trajectories, and their place in the catalog."""
from __future__ import annotations

import difflib
import dis
import hashlib
import math
import os
import pathlib
import sys
import types
from typing import TYPE_CHECKING, overload

from remote_touch import _core
from remote_touch._core import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from typing import Any, ClassVar, TypeVar, Union

    from numpy.typing import ArrayLike

    from remote_touch._core import Cloud, Device, Frame, NoiseKey, Output, Scene, Stepper
    _Class = TypeVar("_Class", bound=Union[type["Renderer"], type["Scenario"], type["Trajectory"]])


class Setting:
    """A setting of a class: its default value, a float, bool, str or three numbers, or an int with integer=True.

    low and high: the range of numbers, ends included. live: may change during a run.
    """

    def __init__(self, value: Any, low: float = -1e12, high: float = 1e12, help: str = "", live: bool = False,
                 integer: bool = False) -> None:
        self.name = ""
        self.value, self.low, self.high = value, float(low), float(high)
        self.help, self.live, self.integer = help, live, integer


class _Base:
    settings: ClassVar[dict[str, Setting]] = {}

    def validate(self) -> str | None:
        """None, or what is wrong with the settings together: "radius_m = 1: expected less than depth_m".

        Called on an object that has its settings as attributes, but whose __init__ was not called.
        """
        return None


class Renderer(_Base):
    """Computes the force. Each setting is an attribute of the object, set before __init__(self) is called.

    A renderer in Python is slow (see the page runners/interfaces/python/README.md) and holds the interpreter's lock: a sweep
    over it uses one core.
    """

    degrees_of_freedom: ClassVar[int] = 3  # or 6: outputs have torque_Nm and tool_orientation
    # or regions, mesh, sheet, nothing, oriented, resting_points, see runners/interfaces/plugins/remote_touch_plugin.h
    contact_model: ClassVar[str] = "points"
    needs: ClassVar[tuple[str, ...]] = ()  # of "normals", "organised", "regions", "view": runs whose frames lack one are refused
    haptic_rate_hz: float = 1000.0  # set before __init__ too

    def on_frame(self, frame: Frame) -> None:
        """A new Frame arrived. Drop it if its captured_s is not later than that of the last one."""

    def step(self, device: Device, time_s: float) -> Output:
        """One tick: returns an Output for a Device at a time. Equal calls must give equal numbers."""
        raise NotImplementedError("step(self, device, time_s) is missing")

    def parameters_changed(self) -> None:
        """Live settings, which are attributes, have changed between two steps."""

    def max_stiffness_N_per_m(self) -> float:
        """Upper bound of how fast the force grows with the displacement of the hand. Uses settings only."""
        if not hasattr(self, "stiffness_N_per_m"):
            raise NotImplementedError("max_stiffness_N_per_m(self) is missing, and there is no setting stiffness_N_per_m")
        return self.stiffness_N_per_m

    def rest_distance_m(self) -> float:
        """Distance of the proxy from a flat surface in contact; NaN: not known, then no contact is measured."""
        return math.nan

    def spring_N_per_m(self) -> float:
        """Of a renderer without a proxy: the stiffness with which its force pushes the HIP out; else 0."""
        return 0.0


class Scenario(_Base):
    """A scene: point clouds, and the true surface behind them. The settings are attributes, and so is key.

    key: a NoiseKey. A cloud must be a function of settings, key and frame number alone: the same call gives the same
    numbers. Take random numbers from self.key.normals(use, frame, count), never from numpy.random.
    """

    frame_rate_hz: float = 30.0  # an attribute or a method
    frame_count: int = 1  # a scene with one frame never changes
    key: NoiseKey = None

    def cloud(self, frame: int) -> ArrayLike | Cloud:
        """The points of a frame: an array of shape (n, 3) in metres, NaN where nothing was measured, or a Cloud."""
        raise NotImplementedError("cloud(self, frame) is missing")

    def signed_distance(self, p: ArrayLike, time_s: float) -> float:
        """Distance of p to the true surface, positive on the side that the sensor sees; NaN: not known."""
        return math.nan

    def surface_height(self, x: float, z: float, time_s: float) -> float:
        """Height y of the true surface over (x, z); NaN where the scene is no height field."""
        return math.nan


class Trajectory(_Base):
    """A motion of the hand. The settings are attributes, and so is scene, a Scene without the faults of a sensor."""

    duration_s: float = 0.0  # an attribute or a method; 0: it has no end
    scene: Scene = None

    def at(self, time_s: float) -> ArrayLike | tuple[ArrayLike, ArrayLike] | Device:
        """A position, or (position, quaternion w x y z), or a Device."""
        raise NotImplementedError("at(self, time_s) is missing")


_KINDS = {"renderer": Renderer, "scenario": Scenario, "trajectory": Trajectory}
_registered = {}  # (kind, name) -> class


@overload
def register(cls: _Class, name: str | None = None, *, summary: str | None = None) -> _Class: ...
@overload
def register(cls: str | None = None, name: str | None = None, *,
             summary: str | None = None) -> Callable[[_Class], _Class]: ...
def register(cls=None, name=None, *, summary=None):
    """Puts a class into the catalog, so that experiments can name it; returns the class.

    rt.register(Mine, "mine"), @rt.register("mine") or @rt.register. Without a name Mine is "mine" and SpringPlane
    "spring-plane". The first line of the docstring is the summary. A class of the same name takes its place. From now on
    results of this process record the classes and the SHA-256 of their sources.
    """
    if cls is None or isinstance(cls, str):
        given = cls if cls is not None else name
        return lambda later: register(later, given, summary=summary)
    kind = _kind_of(cls)
    name = _hyphened(cls.__name__) if name is None else name
    lines = (cls.__doc__ or "").strip().splitlines() if "__doc__" in vars(cls) else []
    text = summary or (lines[0] if lines else f"a {kind} in Python")
    _core.register_class(kind, name, text, cls, _settings_of(cls, f"{kind} {name}"))
    _registered[kind, name] = cls
    _read_files(cls)
    identify()
    return cls


def name_of(cls: type) -> str:
    """The name under which a class is registered."""
    for (_, name), registered in reversed(_registered.items()):
        if registered is cls:
            return name
    raise InputError(f"class {cls.__name__}: is not in the catalog: expected rt.register({cls.__name__}) before")


def scene(name: str, *, key: NoiseKey | None = None, **settings: Any) -> Scene:
    """A scenario of the catalog with settings, to be queried for clouds and distances: rt.scene("moving-lift")."""
    from remote_touch.calls import _json, _native
    if key is not None and not isinstance(key, _core.NoiseKey):
        raise InputError(f"key = {key!r}: expected an rt.NoiseKey")
    return _core.Scene(_native(name), _json(settings, "scene: "), key if key is not None else _core.NoiseKey())


_NO_SCENE = {"scenario": {"name": "points"}, "trajectory": {"name": "waypoints", "waypoints": [[0, 0, 0, 0], [0, 0, 0, 1]]}}


def stepper(renderer: str | type[Renderer] | os.PathLike[str] | dict[str, Any], settings: Mapping[str, Any] | None = None, *,
            set: Mapping[str, Any] | None = None) -> Stepper:
    """A renderer to be given clouds and stepped by hand: rt.stepper("proxy", {"stiffness_N_per_m": 400}).

    renderer: its name, or an experiment, which is named as for rt.run(); scene and trajectory of the experiment are not used.
    set: other settings, such as {"depth_pipeline.filter_window": 5, "haptic_rate_hz": 500}.
    frame(cloud, captured_s): a new frame, a Cloud or an array (n, 3), which the depth pipeline and the fixtures process before.
    step(device, time_s): an Output for a Device or a position. The bits are those of rt.run(), and output["status"] is a column of it.
    """
    from remote_touch.calls import _overrides, _subject
    names = _core.list()
    is_named = settings is not None or isinstance(renderer, type) or isinstance(renderer, str) and (
        renderer in names["renderers"] or renderer not in names["experiments"] and not renderer.endswith(".json")
        and bool(difflib.get_close_matches(renderer, names["renderers"])))  # so that the error names the one that was meant
    subject = {**_NO_SCENE, "renderer": {"name": renderer, **(settings or {})}} if is_named else renderer
    return _core.Stepper(*_subject(subject), _overrides(set))


def _kind_of(cls):
    for kind, base in _KINDS.items():
        if isinstance(cls, type) and issubclass(cls, base) and cls is not base:
            return kind
    raise InputError(f"{getattr(cls, '__name__', cls)}: expected a class derived from rt.Renderer, rt.Scenario or "
                     "rt.Trajectory")


def _hyphened(name):
    return "".join(("-" if i > 0 and c.isupper() and not name[i - 1].isupper() else "") + c.lower()
                   for i, c in enumerate(name.strip("_")))


def _settings_of(cls, subject):
    """Those of the class and of the classes that it is derived from, each with its name."""
    found = {}
    for part in reversed(cls.__mro__):
        found.update(vars(part).get("settings", {}))
    for name, setting in found.items():
        if not isinstance(setting, Setting):
            raise InputError(f"{subject}: setting {name}: expected rt.Setting(...)")
        if not name.isidentifier() or hasattr(_Base, name):
            raise InputError(f"{subject}: setting {name}: expected the name of an attribute")
        setting.name = name
    return [*found.values()]


_BASES = (_Base, Renderer, Scenario, Trajectory, object)
_of_files = {}  # class -> the name of its file, and the bytes that this had when the class was registered
_identity = []  # what the results record now


def identify() -> None:
    """Tells the results which classes take part, by file, and the hash of those files. Called again before each run and sweep:
    a cell of a notebook may have changed what a method calls."""
    files, sources = {}, set()
    for cls in _registered.values():
        own = [_of_files.get(part) or (part.__module__, _Definition(part).text.encode("utf-8", "surrogatepass"))
               for part in cls.__mro__ if part not in _BASES]
        files.setdefault(own[0][0], set()).add(cls.__qualname__)
        sources.update(own)
    digest = hashlib.sha256()
    for _, source in sorted(sources):
        digest.update(source)
    text = "; ".join(f"{file}: {', '.join(sorted(names))}" for file, names in sorted(files.items()))
    identity = [f"Python {text}", digest.hexdigest()]
    if files and identity != _identity:
        _core.identify_program(*identity)
        _identity[:] = identity


def _read_files(cls):
    """Reads the files of the class and of those that it is derived from. A class of a notebook has none, nor has it in a worker that
    got it from there, where its module is the file that started the worker."""
    for part in cls.__mro__:
        file = getattr(sys.modules.get(part.__module__), "__file__", None)
        codes = [getattr(getattr(value, "__func__", value), "__code__", None) for value in vars(part).values()]
        places = {os.path.basename(code.co_filename) for code in codes if code}
        if part in _BASES or file is None or (places and os.path.basename(file) not in places):
            continue
        try:
            _of_files[part] = os.path.basename(file), pathlib.Path(file).read_bytes()
        except OSError:  # its definition stands for it
            pass


class _Definition:
    """A text that differs if a class without a file computes something else: the code of its methods, and the values and functions
    that they use. Modules, and what is from their files, have their names only."""

    _unknown = []  # values of which no text can be made; they live as long as the process, so that no other has their place
    _process = os.urandom(16).hex()

    def __init__(self, cls):
        self.seen = [cls]
        self.text = self._of_class(cls)

    def _of(self, value):
        if value is None or value is ... or isinstance(value, (bool, int, float, complex, str, bytes, range, slice)):
            return f"{type(value).__name__} {value!r}"
        if isinstance(value, (frozenset, set)):  # each process has another order
            return f"{type(value).__name__} {sorted(map(self._of, value))}"
        if isinstance(value, tuple):
            return f"({', '.join(map(self._of, value))})"
        if isinstance(value, types.CodeType):
            parts = ("co_flags", "co_code", "co_exceptiontable", "co_names", "co_varnames", "co_consts")
            return f"code {value.co_name} {self._of(tuple(getattr(value, part, None) for part in parts))}"
        if isinstance(value, types.ModuleType):
            return f"module {value.__name__} {getattr(value, '__version__', '')}"
        if type(value).__module__ == "numpy" and hasattr(value, "tobytes") and not value.dtype.hasobject:
            return f"array {value.dtype} {value.shape} {value.tobytes().hex()}"
        if isinstance(value, types.MemberDescriptorType) or type(value).__name__ == "ufunc":
            return f"{type(value).__name__} {value.__name__}"
        if _is_of_a_module(value):
            return f"{value.__module__}.{getattr(value, '__qualname__', value.__name__)}"
        if any(value is one for one in self.seen):
            return f"again {getattr(value, '__qualname__', type(value).__name__)}"
        self.seen.append(value)
        return self._of_new(value)

    def _of_new(self, value):
        if isinstance(value, list):
            return f"list {self._of(tuple(value))}"
        if isinstance(value, dict):
            return f"dict {self._of(tuple(value.items()))}"
        if isinstance(value, Setting):
            return f"Setting {self._of(vars(value))}"
        if isinstance(value, (staticmethod, classmethod)):
            return f"{type(value).__name__} {self._of(value.__func__)}"
        if isinstance(value, property):
            return f"property {self._of((value.fget, value.fset, value.fdel))}"
        if isinstance(value, types.FunctionType):
            cells = tuple(cell.cell_contents for cell in value.__closure__ or () if cell != types.CellType())
            names = sorted(_globals_of(value.__code__))
            used = {name: value.__globals__[name] for name in names if name in value.__globals__}
            return f"function {self._of((value.__code__, value.__defaults__, value.__kwdefaults__, cells, used))}"
        if isinstance(value, type):
            return self._of_class(value)
        if not any(value is one for one in self._unknown):
            self._unknown.append(value)
        return f"unknown {self._process} {[value is one for one in self._unknown].index(True)}"

    def _of_class(self, cls):
        of_every_class = ("__dict__", "__weakref__", "__module__", "__doc__", "__firstlineno__", "__static_attributes__", "_abc_impl")
        own = {name: value for name, value in vars(cls).items() if name not in of_every_class}
        return f"class {cls.__qualname__} {self._of((own, cls.__bases__))}"


def _is_of_a_module(value):
    """True for functions and classes that are from a file or a library, not from a notebook or a script."""
    module = getattr(value, "__module__", None)
    has_name = isinstance(module, str) and hasattr(value, "__name__")
    return has_name and module != "__main__" and module in sys.modules


def _globals_of(code):
    """The names of the global variables that the code reads, in functions inside it, too."""
    names = {step.argval for step in dis.get_instructions(code) if step.opname in ("LOAD_GLOBAL", "LOAD_NAME")}
    return names.union(*(_globals_of(inner) for inner in code.co_consts if isinstance(inner, types.CodeType)))

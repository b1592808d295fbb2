from collections.abc import Callable
from typing import Any, ClassVar, TypeVar, Union, overload

from numpy.typing import ArrayLike

from remote_touch._core import Cloud, Device, Frame, NoiseKey, Output, Scene

class Setting:
    name: str
    value: Any
    low: float
    high: float
    help: str
    live: bool
    integer: bool
    def __init__(
        self,
        value: Any,
        low: float = -1e12,
        high: float = 1e12,
        help: str = "",
        live: bool = False,
        integer: bool = False,
    ) -> None: ...

class _Base:
    settings: ClassVar[dict[str, Setting]]
    def validate(self) -> str | None: ...

class Renderer(_Base):
    degrees_of_freedom: ClassVar[int]
    contact_model: ClassVar[str]
    needs: ClassVar[tuple[str, ...]]
    haptic_rate_hz: float
    def on_frame(self, frame: Frame) -> None: ...
    def step(self, device: Device, time_s: float) -> Output: ...
    def parameters_changed(self) -> None: ...
    def max_stiffness_N_per_m(self) -> float: ...
    def rest_distance_m(self) -> float: ...
    def spring_N_per_m(self) -> float: ...

class Scenario(_Base):
    frame_rate_hz: float
    frame_count: int
    key: NoiseKey
    def cloud(self, frame: int) -> ArrayLike | Cloud: ...
    def signed_distance(self, p: ArrayLike, time_s: float) -> float: ...
    def surface_height(self, x: float, z: float, time_s: float) -> float: ...

class Trajectory(_Base):
    duration_s: float
    scene: Scene
    def at(self, time_s: float) -> ArrayLike | tuple[ArrayLike, ArrayLike] | Device: ...

_Class = TypeVar("_Class", bound=Union[type[Renderer], type[Scenario], type[Trajectory]])

@overload
def register(cls: _Class, name: str | None = None, *, summary: str | None = None) -> _Class: ...
@overload
def register(
    cls: str | None = None, name: str | None = None, *, summary: str | None = None
) -> Callable[[_Class], _Class]: ...
def identify() -> None: ...
def name_of(cls: type) -> str: ...
def scene(name: str, *, key: NoiseKey | None = None, **settings: Any) -> Scene: ...

import os
from builtins import list as _List
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import Executor
from typing import Any, Literal, Union

import xarray

from remote_touch.classes import Renderer

_Path = Union[str, os.PathLike[str]]
_Progress = Union[None, bool, Callable[[float], object]]

def run(
    experiment: _Path | dict[str, Any],
    *,
    seed: int | None = None,
    set: Mapping[str, Any] | None = None,
    output: _Path | None = None,
    force: bool = False,
    timing: bool = False,
    progress: _Progress = None,
) -> xarray.Dataset: ...
def sweep(
    sweep: _Path | dict[str, Any],
    *,
    set: Mapping[str, Any] | None = None,
    threads: int | None = None,
    output: _Path | None = None,
    progress: _Progress = None,
    executor: Executor | None = None,
    chunk: int | None = None,
) -> xarray.Dataset: ...
def replay(
    sweep: _Path | xarray.Dataset,
    *,
    cell: Iterable[int] | Mapping[str, Any] | str | int,
    replicate: int = 0,
    output: _Path | None = None,
    force: bool = False,
    progress: _Progress = None,
) -> xarray.Dataset: ...
def analyse(
    sweep: _Path | xarray.Dataset,
    *,
    limit: str | None = None,
    along: str | None = None,
    above: float = 0.5,
    level: float = 0.5,
    mean: str | Iterable[str] = (),
    by: str | Iterable[str] = (),
    difference: str | Iterable[str] = (),
    between: str | None = None,
    direction: Literal["rises", "falls"] | None = None,
) -> dict[str, xarray.Dataset]: ...
def open(path: _Path) -> Any: ...

class Comparison:
    outcome: Literal["same", "regressed", "not comparable", "changed"]
    text: str
    report: dict[str, Any]
    def __init__(self, outcome: int, text: str, report: dict[str, Any]) -> None: ...
    @property
    def same(self) -> bool: ...
    @property
    def differences(self) -> _List[str]: ...
    @property
    def judgements(self) -> dict[str, str]: ...

def compare(
    baseline: _Path | xarray.Dataset,
    candidate: _Path | xarray.Dataset,
    *,
    tolerance: Mapping[str, float | tuple[float, float]] | None = None,
    paired: bool = False,
) -> Comparison: ...
def describe(name: str) -> str: ...
def scorecard(
    methods: Iterable[_Path | type[Renderer]] = (),
    *,
    scenes: Iterable[_Path] = (),
    seeds: int = 10,
    output: _Path,
    threads: int | None = None,
    progress: _Progress = None,
) -> dict[str, xarray.Dataset]: ...
def list() -> dict[str, dict[str, str]]: ...

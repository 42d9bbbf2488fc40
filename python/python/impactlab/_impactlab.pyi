from collections.abc import Mapping
from os import PathLike
from typing import Any, TypeAlias, final

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "Forecast",
    "ImpactlabError",
    "Motion",
    "Reconstruction",
    "__version__",
    "ask",
    "plan_sweep",
    "predict",
    "reconstruct",
    "run_chunk",
    "schema",
    "simulate",
]

_Question: TypeAlias = Mapping[str, Any] | str
_Path: TypeAlias = str | PathLike[str]
_Columns: TypeAlias = dict[str, NDArray[np.float64]]

__version__: str

class ImpactlabError(ValueError): ...

@final
class Motion:
    @property
    def report(self) -> dict[str, Any]: ...
    @property
    def columns(self) -> _Columns: ...
    @property
    def striking(self) -> _Columns | None: ...
    @property
    def recorded(self) -> _Columns | None: ...

@final
class Forecast:
    @property
    def report(self) -> dict[str, Any]: ...
    @property
    def bands(self) -> _Columns: ...
    @property
    def paths(self) -> _Columns: ...
    @property
    def striking_bands(self) -> _Columns | None: ...
    @property
    def striking_paths(self) -> _Columns | None: ...

@final
class Reconstruction:
    @property
    def report(self) -> dict[str, Any]: ...
    @property
    def particles(self) -> _Columns: ...

def ask(request: _Question, folder: _Path | None = None) -> dict[str, Any]: ...
def simulate(request: _Question, folder: _Path | None = None) -> Motion: ...
def predict(request: _Question, folder: _Path | None = None) -> Forecast: ...
def reconstruct(request: _Question, folder: _Path | None = None) -> Reconstruction: ...
def plan_sweep(plan: _Path, out: _Path) -> int: ...
def run_chunk(plan: _Path, i: int, out: _Path | None = None) -> str: ...
def schema() -> dict[str, Any]: ...

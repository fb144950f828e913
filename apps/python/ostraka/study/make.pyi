# Generated from the table of operations: python3 -m ostraka stubs
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Literal

from ..._objects import Annotations, Array, Bytes, Document, Folder, Mesh, Object, Template
from ..._report import Result
from ..._types import AnnotationsLike, ArrayLike, FileName, Input, MeshLike, Text

class _ProportionsResult(Result):
    folder: Folder | Path | None
def proportions(
    folder: FileName | bool | None = None,
    *,
    fixed: Literal["total height", "base diameter", "arm length", "head height"] | Sequence[Literal["total height", "base diameter", "arm length", "head height"]] | None = ('arm length; base diameter',),
    none: bool | None = False,
    objects: int | None = 40,
    size_deviation: float | None = 0.12,
    ratio_deviation: float | None = 0.15,
    planted_deviation: float | None = 0.03,
    scan_noise: float | None = 0.05,
    seed: int | None = 1,
    vertices: int | None = 10000,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _ProportionsResult:
    """Make synthetic statuettes with annotations, some of whose proportions are fixed, and their measure definitions."""

class _MouldsResult(Result):
    folder: Folder | Path | None
def moulds(
    folder: FileName | bool | None = None,
    *,
    objects: int | None = 40,
    moulds: int | None = 4,
    hand_made: int | None = 0,
    difference: float | None = 1.0,
    seed: int | None = 1,
    wear: float | None = 0.0,
    pressure: float | None = 0.0,
    shrinkage: float | None = 0.0,
    noise: float | None = 0.0,
    beard: float | None = 0.0,
    chunk: float | None = 0.0,
    dents: int | None = 0,
    body: bool | None = False,
    keep_pose: bool | None = False,
    vertices: int | None = 10000,
    cast_seed: int | None = 1,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _MouldsResult:
    """Make synthetic heads of figurines cast from a few moulds, each worn, deformed and scanned separately."""

class _TechniqueResult(Result):
    folder: Folder | Path | None
def technique(
    folder: FileName | bool | None = None,
    *,
    objects: int | None = 100,
    level: int | None = 1,
    seed: int | None = 1,
    vertices: int | None = 10000,
    scan_noise: float | None = 0.05,
    interior: Literal["mixed", "closed", "open"] | None = 'mixed',
    cavity_seen: float | None = 0.35,
    holes: int | None = 0,
    size_spread: float | None = 0.07,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _TechniqueResult:
    """Make synthetic statuettes, wheel-made and hand-made, with their annotations."""

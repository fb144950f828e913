# Generated from the table of operations: python3 -m ostraka stubs
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Literal

from .._objects import Annotations, Array, Bytes, Document, Folder, Mesh, Object, Template
from .._report import Result
from .._types import AnnotationsLike, ArrayLike, FileName, Input, MeshLike, Text

class _TakeResult(Result):
    output: Annotations | Path | None
def take(
    mesh: MeshLike,
    *,
    annotations: AnnotationsLike | None = None,
    output: FileName | bool | None = None,
    force_mesh: bool | None = False,
    unit: Text | None = None,
    tool: Literal["ruler", "tape", "bounding"],
    points: int | Sequence[int] | None = None,
    at: Text | Sequence[Text] | None = None,
    direction: Text | None = None,
    geodesic: Literal["edges", "exact"] | None = 'edges',
    repeat: Text | Sequence[Text] | None = None,
    annotation: Text | None = None,
    name: Text | None = None,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _TakeResult:
    """Take a measure with a ruler, a tape or bounding planes."""

class _DescribeResult(Result):
    output: Annotations | Path | None
def describe(
    mesh: MeshLike,
    *,
    annotations: AnnotationsLike | None = None,
    map: dict[str, ArrayLike] | FileName | None = None,
    output: FileName | bool | None = None,
    force_mesh: bool | None = False,
    unit: Text | None = None,
    annotation: Text | Sequence[Text] | None = None,
    curvature: bool | None = False,
    thickness: bool | None = False,
    scale: float | None = 0.0,
    rays: int | None = 30,
    cone: float | None = 60.0,
    thickness_scale: float | None = 0.01,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _DescribeResult:
    """Describe annotations: sizes, box, centroid, volume, curvature, thickness, and statistics of maps."""

class _RefreshResult(Result):
    output: Annotations | Path | None
def refresh(
    mesh: MeshLike,
    *,
    annotations: AnnotationsLike,
    output: FileName | bool | None = None,
    force_mesh: bool | None = False,
    unit: Text | None = None,
    merge_pickings: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _RefreshResult:
    """Recompute all measures and descriptors, with uncertainties; exit code 3 if some cannot be computed."""

class _MapResult(Result):
    output: Array | Path | None
    annotations_out: Annotations | Path | None
def map(
    mesh: MeshLike,
    output: FileName | bool | None = None,
    *,
    annotations: AnnotationsLike | None = None,
    annotations_out: FileName | bool | None = None,
    of: Literal["mean-curvature", "gaussian-curvature", "thickness", "geodesic"],
    on: Literal["vertex", "face"] | None = 'vertex',
    from_: int | Sequence[int] | None = None,
    force_mesh: bool | None = False,
    name: Text | None = None,
    annotation: Text | None = None,
    unit: Text | None = None,
    scale: float | None = 0.0,
    rays: int | None = 30,
    cone: float | None = 60.0,
    thickness_scale: float | None = 0.01,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _MapResult:
    """Write a map of curvature, thickness or distance."""

def clay(
    mesh: MeshLike,
    annotations: AnnotationsLike | None = None,
    *,
    force_mesh: bool | None = False,
    up: Text | None = None,
    unit: Text | None = None,
    slices: int | None = 400,
    wall: float | None = 0.0,
    progress: Callable[[str, float], object] | bool | None = None,
) -> Result:
    """Compute bounds of the volume of clay: with the unseen interior solid, and hollow."""

# Generated from the table of operations: python3 -m ostraka stubs
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Literal

from .._objects import Annotations, Array, Bytes, Document, Folder, Mesh, Object, Template
from .._report import Result
from .._types import AnnotationsLike, ArrayLike, FileName, Input, MeshLike, Text

class _MakeResult(Result):
    output: Mesh | Path | None
def make(
    mesh: MeshLike,
    output: FileName | bool | None = None,
    *,
    annotations: AnnotationsLike | None = None,
    graph: Input | None = None,
    for_: Input | None = None,
    vocabulary: Input | None = None,
    force_mesh: bool | None = False,
    vertices: int | None = 200,
    alpha: float | None = 0.0,
    offset: float | None = 0.0167,
    genus: Literal["follow", "fill"] | None = 'follow',
    levels: int | Sequence[int] | None = None,
    together: bool | None = False,
    parts: Text | Sequence[Text] | None = None,
    part_vertices: int | None = 40,
    mirror: Text | None = None,
    detail: Text | Sequence[Text] | None = None,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _MakeResult:
    """Make a closed coarse mesh strictly around a mesh."""

class _EditResult(Result):
    output: Mesh | Path | None
def edit(
    cage: MeshLike,
    edit: Input,
    output: FileName | bool | None = None,
    *,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _EditResult:
    """Move the vertices of a cage by an edit file."""

def check(
    mesh: MeshLike,
    cage: MeshLike,
    *,
    annotations: AnnotationsLike | None = None,
    graph: Input | None = None,
    weights: Input | None = None,
    edit: Input | None = None,
    force_mesh: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> Result:
    """Check whether a mesh is a sound cage of another (exit code 3: no)."""

class _WeightsResult(Result):
    output: Array | Path | None
def weights(
    mesh: MeshLike,
    cage: MeshLike,
    output: FileName | bool | None = None,
    *,
    kind: Literal["mean-value", "green", "harmonic", "local", "positive-mean-value"] | None = 'mean-value',
    snap: float | None = 4e-15,
    nodes: int | None = 20000,
    drop: float | None = 0.0001,
    iterations: int | None = 300,
    tolerance: float | None = 0.0001,
    fade: float | None = 0.15,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _WeightsResult:
    """Compute coordinates of a mesh in a cage, with a certificate."""

class _InfluenceResult(Result):
    output: Mesh | Sequence[Mesh] | Path | None
def influence(
    mesh: MeshLike,
    cage: MeshLike,
    weights: Input,
    output: FileName | bool | None = None,
    *,
    annotations: AnnotationsLike | None = None,
    force_mesh: bool | None = False,
    cage_vertex: int | None = None,
    annotation: Text | None = None,
    by: Literal["max", "sum"] | None = 'max',
    threshold: float | None = None,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _InfluenceResult:
    """Colour a mesh or its cage by the weights of cage vertices."""

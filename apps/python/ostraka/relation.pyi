# Generated from the table of operations: python3 -m ostraka stubs
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Literal

from .._objects import Annotations, Array, Bytes, Document, Folder, Mesh, Object, Template
from .._report import Result
from .._types import AnnotationsLike, ArrayLike, FileName, Input, MeshLike, Text

class _ExtractResult(Result):
    output: Document | Path | None
def extract(
    mesh: MeshLike,
    annotations: AnnotationsLike,
    output: FileName | bool | None = None,
    *,
    graph: Input | None = None,
    vocabulary: Input | None = None,
    force_mesh: bool | None = False,
    type: Text | Sequence[Text] | None = None,
    distance: float | None = 0.01,
    angle: float | None = 5.0,
    tilt: float | None = 20.0,
    ratio: float | None = 10.0,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _ExtractResult:
    """Find relationships among annotations."""

class _AddResult(Result):
    output: Document | Path | None
def add(
    mesh: MeshLike,
    annotations: AnnotationsLike,
    output: FileName | bool | None = None,
    *,
    graph: Input | None = None,
    force_mesh: bool | None = False,
    type: Text | None = None,
    annotation: Text | Sequence[Text] | None = None,
    relation: Text | Sequence[Text] | None = None,
    own_type: bool | None = False,
    directed: bool | None = False,
    constraint: bool | None = False,
    parameters: Text | None = None,
    weight: float | None = 1.0,
    tolerance: Text | Sequence[Text] | None = None,
    attribute: Text | None = None,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _AddResult:
    """Add a user-specified relationship."""

class _RemoveResult(Result):
    output: Document | Path | None
def remove(
    mesh: MeshLike,
    annotations: AnnotationsLike,
    graph: Input,
    output: FileName | bool | None = None,
    *,
    force_mesh: bool | None = False,
    id: int | Sequence[int],
    progress: Callable[[str, float], object] | bool | None = None,
) -> _RemoveResult:
    """Remove relationships from a graph."""

class _EditResult(Result):
    output: Document | Path | None
def edit(
    mesh: MeshLike,
    annotations: AnnotationsLike,
    graph: Input,
    output: FileName | bool | None = None,
    *,
    force_mesh: bool | None = False,
    id: int,
    weight: float | None = None,
    range: Text | None = None,
    parameters: Text | None = None,
    constraint: Literal["unchanged", "yes", "no"] | None = 'unchanged',
    progress: Callable[[str, float], object] | bool | None = None,
) -> _EditResult:
    """Change weight, range and parameters of a relationship in place."""

def list(
    mesh: MeshLike,
    annotations: AnnotationsLike,
    graph: Input,
    *,
    force_mesh: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> Result:
    """List the relationships of a graph."""

def check(
    mesh: MeshLike,
    annotations: AnnotationsLike,
    graph: Input,
    *,
    rest: MeshLike | None = None,
    rules: Input | None = None,
    vocabulary: Input | None = None,
    force_mesh: bool | None = False,
    distance: float | None = 0.01,
    angle: float | None = 5.0,
    tilt: float | None = 20.0,
    ratio: float | None = 10.0,
    progress: Callable[[str, float], object] | bool | None = None,
) -> Result:
    """Check which relationships hold on a mesh; exit code 3 if one fails."""

class _ExportResult(Result):
    output: Document | Bytes | Path | None
def export(
    mesh: MeshLike,
    annotations: AnnotationsLike,
    graph: Input,
    output: FileName | bool | None = None,
    *,
    force_mesh: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _ExportResult:
    """Draw a graph, or write it for Graphviz."""

# Generated from the table of operations: python3 -m ostraka stubs
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Literal

from .._objects import Annotations, Array, Bytes, Document, Folder, Mesh, Object, Template
from .._report import Result
from .._types import AnnotationsLike, ArrayLike, FileName, Input, MeshLike, Text

def info(
    input: MeshLike,
    *,
    skip_self_intersections: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> Result:
    """Count, measure and examine a mesh; exit code 3 if it is not closed, oriented, manifold and free of self-intersections."""

class _ConvertResult(Result):
    output: Mesh | Sequence[Mesh] | Path | None
    map: Array | Path | None
def convert(
    input: MeshLike,
    output: FileName | bool | None = None,
    *,
    polygons_of: MeshLike | None = None,
    map: FileName | bool | None = None,
    ascii: bool | None = False,
    binary: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _ConvertResult:
    """Write a mesh in another format, with polygons triangulated and the vertex order kept."""

class _RepairResult(Result):
    output: Mesh | Sequence[Mesh] | Path | None
    vertex_map: Array | Path | None
    face_map: Array | Path | None
    report_: Document | Bytes | Path | None
def repair(
    input: MeshLike,
    output: FileName | bool | None = None,
    *,
    vertex_map: FileName | bool | None = None,
    face_map: FileName | bool | None = None,
    report: FileName | bool | None = None,
    merge_distance: float | None = 0.0,
    merge_gap: float | None = 0.25,
    keep_isolated: bool | None = False,
    keep_largest: bool | None = False,
    min_component_share: float | None = 0.0,
    fill_holes: int | None = 500,
    fill_holes_size: float | None = 0.3,
    remove_self_intersections: bool | None = False,
    wrap: bool | None = False,
    wrap_alpha: float | None = 0.02,
    wrap_offset: float | None = 0.002,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _RepairResult:
    """Repair a mesh to an oriented manifold; exit code 3 if it is still open or intersects itself."""

class _SimplifyResult(Result):
    output: Mesh | Sequence[Mesh] | Path | None
    annotations_out: Annotations | Path | None
    labels_out: Document | Bytes | Path | None
    vertex_map: Array | Path | None
    face_map: Array | Path | None
def simplify(
    input: MeshLike,
    output: FileName | bool | None = None,
    *,
    annotations: AnnotationsLike | None = None,
    annotations_out: FileName | bool | None = None,
    labels_out: FileName | bool | None = None,
    vertex_map: FileName | bool | None = None,
    face_map: FileName | bool | None = None,
    ascii: bool | None = False,
    force_mesh: bool | None = False,
    vertices: int,
    method: Literal["qem", "lindstrom-turk"] | None = 'qem',
    outlines: Literal["follow", "protect", "ignore"] | None = 'follow',
    max_normal_change: float | None = 60.0,
    outline_weight: float | None = 1.0,
    border_weight: float | None = 1.0,
    protect_outlines: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _SimplifyResult:
    """Reduce the number of vertices, with annotations, labels and colours transferred."""

class _RefineResult(Result):
    output: Mesh | Sequence[Mesh] | Path | None
    annotations_out: Annotations | Path | None
    labels_out: Document | Bytes | Path | None
def refine(
    input: MeshLike,
    output: FileName | bool | None = None,
    *,
    annotations: AnnotationsLike | None = None,
    annotations_out: FileName | bool | None = None,
    labels_out: FileName | bool | None = None,
    ascii: bool | None = False,
    force_mesh: bool | None = False,
    vertices: int | None = 0,
    levels: int | None = 0,
    scheme: Literal["midpoint", "loop", "longest-edge"] | None = 'midpoint',
    progress: Callable[[str, float], object] | bool | None = None,
) -> _RefineResult:
    """Increase the number of vertices, with annotations, labels and colours transferred."""

class _RemeshResult(Result):
    output: Mesh | Sequence[Mesh] | Path | None
def remesh(
    input: MeshLike,
    output: FileName | bool | None = None,
    *,
    ascii: bool | None = False,
    vertices: int,
    iterations: int | None = 3,
    feature_angle: float | None = 0.0,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _RemeshResult:
    """Remesh the surface, independently of the old mesh."""

class _RegisterResult(Result):
    output: Mesh | Sequence[Mesh] | Path | None
    matrix: Document | Bytes | Path | None
def register(
    source: MeshLike,
    target: MeshLike,
    output: FileName | bool | None = None,
    *,
    matrix: FileName | bool | None = None,
    ascii: bool | None = False,
    scale: bool | None = True,
    tolerance: float | None = 0.0,
    samples: int | None = 4000,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _RegisterResult:
    """Register a mesh to another of the same object: rotation, translation and scale; exit code 3, and nothing written, if it is not the same object."""

class _ExtractResult(Result):
    output: Mesh | Sequence[Mesh] | Path | None
    annotations_out: Annotations | Path | None
def extract(
    mesh: MeshLike,
    annotations: AnnotationsLike,
    output: FileName | bool | None = None,
    *,
    vocabulary: Input | None = None,
    annotations_out: FileName | bool | None = None,
    force_mesh: bool | None = False,
    annotation: Text | Sequence[Text] | None = None,
    without: Text | Sequence[Text] | None = None,
    closed: bool | None = False,
    labels: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _ExtractResult:
    """Cut annotated parts out of an object, with the annotations on them."""

class _BreakResult(Result):
    output: Mesh | Sequence[Mesh] | Path | None
    annotations_out: Annotations | Path | None
    pose_out: Document | Bytes | Path | None
def break_(
    input: MeshLike,
    output: FileName | bool | None = None,
    *,
    annotations: AnnotationsLike | None = None,
    annotations_out: FileName | bool | None = None,
    pose_out: FileName | bool | None = None,
    force_mesh: bool | None = False,
    share: float | None = 0.25,
    roughness: float | None = 0.1,
    noise: float | None = 0.0,
    erosion: float | None = 0.0,
    moved: bool | None = True,
    seed: int | None = 1,
    at: Text,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _BreakResult:
    """Break a piece off an object: a fragment with known pose."""

class _MakeResult(Result):
    output: Mesh | Sequence[Mesh] | Path | None
    labels: Document | Bytes | Path | None
def make(
    object: Text | None = None,
    output: FileName | bool | None = None,
    *,
    labels: FileName | bool | None = None,
    list: bool | None = False,
    vertices: int | None = 10000,
    seed: int | None = 1,
    noise: float | None = 0.0,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _MakeResult:
    """Make a closed synthetic mesh whose parts are known exactly."""

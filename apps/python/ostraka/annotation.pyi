# Generated from the table of operations: python3 -m ostraka stubs
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Literal

from .._objects import Annotations, Array, Bytes, Document, Folder, Mesh, Object, Template
from .._report import Result
from .._types import AnnotationsLike, ArrayLike, FileName, Input, MeshLike, Text

class _ApplyResult(Result):
    output: Annotations | Path | None
    ply: Mesh | Sequence[Mesh] | Path | None
    labels_out: Document | Bytes | Path | None
def apply(
    mesh: MeshLike,
    recipe: Input | ArrayLike | None = None,
    output: FileName | bool | None = None,
    *,
    names: Input | None = None,
    edit: AnnotationsLike | None = None,
    vocabulary: Input | None = None,
    ply: FileName | bool | None = None,
    labels_out: FileName | bool | None = None,
    from_ply_labels: bool | None = False,
    force_mesh: bool | None = False,
    strict: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _ApplyResult:
    """Annotate a mesh from a recipe or from labels."""

def list(
    mesh: MeshLike,
    annotations: AnnotationsLike,
    *,
    force_mesh: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> Result:
    """List the annotations of a mesh."""

def check(
    mesh: MeshLike,
    annotations: AnnotationsLike,
    *,
    vocabulary: Input | None = None,
    rules: Input | None = None,
    graph: Input | None = None,
    force_mesh: bool | None = False,
    strict: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> Result:
    """Look for defects in annotations; exit code 3 if there are any."""

class _RemapResult(Result):
    output: Annotations | Path | None
    ply: Mesh | Sequence[Mesh] | Path | None
    labels_out: Document | Bytes | Path | None
def remap(
    before: MeshLike,
    annotations: AnnotationsLike,
    after: MeshLike,
    output: FileName | bool | None = None,
    *,
    vertex_map: Input | None = None,
    face_map: Input | None = None,
    ply: FileName | bool | None = None,
    labels_out: FileName | bool | None = None,
    force_mesh: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _RemapResult:
    """Transfer annotations or labels with the index maps of 'mesh repair'."""

class _SelectResult(Result):
    output: Annotations | Path | None
    recipe: Document | Bytes | Path | None
def select(
    mesh: MeshLike,
    annotations: AnnotationsLike | None = None,
    expression: Text | None = None,
    *,
    record: Input | ArrayLike | None = None,
    output: FileName | bool | None = None,
    recipe: FileName | bool | None = None,
    force_mesh: bool | None = False,
    all: bool | None = False,
    rectangle: float | Sequence[float] | None = None,
    polygon: float | Sequence[float] | None = None,
    box: float | Sequence[float] | None = None,
    sphere: float | Sequence[float] | None = None,
    halfspace: float | Sequence[float] | None = None,
    nearest: float | Sequence[float] | None = None,
    threshold: Text | None = None,
    segment: int | None = None,
    path: Text | Sequence[Text] | None = None,
    lasso: Text | Sequence[Text] | None = None,
    brush: Text | Sequence[Text] | None = None,
    vertices: Text | Sequence[Text] | None = None,
    component: Text | None = None,
    faces: int | Sequence[int] | None = None,
    labels: int | Sequence[int] | None = None,
    through: bool | None = False,
    closed: bool | None = False,
    metric: Literal["euclidean", "segment", "combined"] | None = 'euclidean',
    seed: Text | None = None,
    radius: float | None = None,
    stroke: bool | None = False,
    above: float | None = None,
    below: float | None = None,
    quantiles: bool | None = False,
    scale: float | None = 0.0,
    smoothing: float | None = 0.26,
    grow: int | None = 0,
    shrink: int | None = 0,
    invert: bool | None = False,
    frame: Literal["mesh", "box"] | None = 'mesh',
    camera: Text | None = None,
    view: Text | None = '30,20',
    up: Text | None = None,
    projection: Literal["orthographic", "perspective"] | None = 'orthographic',
    zoom: float | None = 1.0,
    size: Text | None = '1200x900',
    tag: Text | None = None,
    id: int | None = None,
    type: Literal["point", "line", "region"] | None = None,
    outline: Literal["edges", "free"] | None = None,
    colour: int | Sequence[int] | None = None,
    action: Literal["make", "add to", "remove from", "replace", "delete", "retag"] | None = 'make',
    class_: Text | None = None,
    unit: Text | None = None,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _SelectResult:
    """Select a part by one tool and annotate it, or edit an annotation."""

class _CreasesResult(Result):
    output: Annotations | Path | None
def creases(
    mesh: MeshLike,
    output: FileName | bool | None = None,
    *,
    regions: bool | None = False,
    unit: Text | None = None,
    kind: Literal["ridge", "hollow", "both"] | None = 'both',
    scale: float | None = 0.01,
    wide: float | None = 3.0,
    weak: float | None = 3.0,
    strong: float | None = 6.0,
    floor: float | None = 0.03,
    shortest: float | None = 0.05,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _CreasesResult:
    """Find ridges and hollows of the surface, such as those that clay leaves at joints; exit code 3 if there is none."""

class _FacetsResult(Result):
    output: Annotations | Path | None
    probability: Array | Path | None
def facets(
    mesh: MeshLike,
    annotations: AnnotationsLike | None = None,
    *,
    output: FileName | bool | None = None,
    probability: FileName | bool | None = None,
    force_mesh: bool | None = False,
    unit: Text | None = None,
    facet_edge: float | None = 40.0,
    facet_wall: float | None = 0.25,
    facet_coherence: float | None = 0.3,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _FacetsResult:
    """Classify the surface of a fragment as outer, inner and fracture surface; exit code 3 if there is no fracture."""

class _SegmentResult(Result):
    output: Annotations | Path | None
    labels_out: Document | Bytes | Path | None
def segment(
    mesh: MeshLike,
    output: FileName | bool | None = None,
    *,
    labels_out: FileName | bool | None = None,
    clusters: int | None = 5,
    smoothing: float | None = 0.26,
    rays: int | None = 30,
    cone: float | None = 60.0,
    thickness_scale: float | None = 0.01,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _SegmentResult:
    """Segment a mesh by thickness; each segment becomes an annotation."""

class _SmoothResult(Result):
    output: Annotations | Path | None
def smooth(
    mesh: MeshLike,
    annotations: AnnotationsLike,
    output: FileName | bool | None = None,
    *,
    force_mesh: bool | None = False,
    annotation: Text | Sequence[Text] | None = None,
    distance: float | None = 0.0,
    let_area_change: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _SmoothResult:
    """Replace outlines and lines along edges by fair curves through the faces."""

class _TransferResult(Result):
    output: Annotations | Path | None
    back: Annotations | Path | None
    ply: Mesh | Sequence[Mesh] | Path | None
    refined_mesh: Mesh | Sequence[Mesh] | Path | None
    map: Array | Path | None
def transfer(
    source: MeshLike,
    annotations: AnnotationsLike,
    target: MeshLike,
    output: FileName | bool | None = None,
    *,
    back: FileName | bool | None = None,
    ply: FileName | bool | None = None,
    refined_mesh: FileName | bool | None = None,
    map: FileName | bool | None = None,
    force_mesh: bool | None = False,
    max_distance: float | None = 0.02,
    max_angle: float | None = 90.0,
    vertex: Literal["projection", "source"] | None = 'projection',
    metric: Literal["euclidean", "segment", "combined"] | None = 'euclidean',
    spikes: Literal["prune", "avoid", "keep"] | None = 'prune',
    outlines: Literal["partitions", "kept", "free", "edges"] | None = 'partitions',
    rounding: Literal["path", "area", "balanced"] | None = 'balanced',
    cover: Literal["overlapping", "enclosing", "enclosed"] | None = 'overlapping',
    refine: bool | None = False,
    overlap: bool | None = True,
    force: bool | None = False,
    register: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _TransferResult:
    """Transfer annotations to another resolution of the same object, and report the fidelity."""

def survival(
    mesh: MeshLike,
    annotations: AnnotationsLike,
    *,
    force_mesh: bool | None = False,
    ratio: float | None = 0.7,
    area_error: float | None = 0.25,
    least: int | None = 20,
    progress: Callable[[str, float], object] | bool | None = None,
) -> Result:
    """Find the smallest resolution at which each annotation survives."""

class _ExportResult(Result):
    output: Document | Bytes | Path | None
def export(
    mesh: MeshLike,
    annotations: AnnotationsLike,
    output: FileName | bool | None = None,
    *,
    force_mesh: bool | None = False,
    format: Literal["attributes-csv", "landmarks-csv", "tps", "pp", "mrk", "fcsv", "web", "glb", "ant", "fct"] | None = None,
    mesh_space: Literal["LPS", "RAS"] | None = 'LPS',
    specimen: Text | None = None,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _ExportResult:
    """Write annotations in the formats of other tools."""

class _ImportResult(Result):
    output: Annotations | Path | None
def import_(
    mesh: MeshLike,
    input: Input,
    output: FileName | bool | None = None,
    *,
    onto: AnnotationsLike | None = None,
    format: Literal["attributes-csv", "landmarks-csv", "tps", "pp", "mrk", "fcsv", "web", "glb", "ant", "fct"] | None = None,
    force_mesh: bool | None = False,
    mesh_space: Literal["LPS", "RAS"] | None = 'LPS',
    specimen: Text | None = None,
    tolerance: float | None = 0.02,
    skip_far: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _ImportResult:
    """Read annotations from the formats of other tools."""

class _EditResult(Result):
    output: Annotations | Path | None
def edit(
    mesh: MeshLike,
    annotations: AnnotationsLike,
    output: FileName | bool | None = None,
    *,
    edits: Input | None = None,
    force_mesh: bool | None = False,
    annotation: Text | None = None,
    merge: Text | Sequence[Text] | None = None,
    tag: Text | None = None,
    note: Text | None = None,
    colour: Text | None = None,
    id: int | None = None,
    remove_attribute: Text | Sequence[Text] | None = None,
    attribute: Text | Sequence[Text] | None = None,
    information: Text | Sequence[Text] | None = None,
    remove_information: Text | Sequence[Text] | None = None,
    set_class: Text | None = None,
    set_unit: Text | None = None,
    set_up: Text | None = None,
    duplicate: bool | None = False,
    split: bool | None = False,
    remove: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _EditResult:
    """Change tags, colours, ids, attributes, the file's class, unit and up; remove, duplicate, merge, split."""

def find(
    query: Text,
    objects: Input | Sequence[Input],
    *,
    vocabulary: Input | None = None,
    progress: Callable[[str, float], object] | bool | None = None,
) -> Result:
    """Find objects by their parts, attributes and relationships; exit code 3 if there is none."""

def diff(
    mesh: MeshLike,
    before: AnnotationsLike,
    after: AnnotationsLike,
    *,
    force_mesh: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> Result:
    """List the differences between two sets of annotations; exit code 3 if there are any."""

class _MergeResult(Result):
    output: Annotations | Path | None
def merge(
    mesh: MeshLike,
    base: AnnotationsLike,
    ours: AnnotationsLike,
    theirs: AnnotationsLike,
    output: FileName | bool | None = None,
    *,
    force_mesh: bool | None = False,
    prefer: Literal["none", "ours", "theirs"] | None = 'none',
    merge_faces: bool | None = False,
    renumber: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _MergeResult:
    """Merge two changed versions of one set of annotations; exit code 3 and no output if there are conflicts."""

class _InferResult(Result):
    output: Annotations | Path | None
def infer(
    mesh: MeshLike,
    annotations: AnnotationsLike,
    vocabulary: Input,
    output: FileName | bool | None = None,
    *,
    force_mesh: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _InferResult:
    """Derive qualitative attributes from quantities by the rules of a vocabulary; exit code 3 if rules contradict each other."""

# Generated from the table of operations: python3 -m ostraka stubs
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Literal

from . import annotation as annotation
from . import cage as cage
from . import conformance as conformance
from . import measure as measure
from . import mesh as mesh
from . import relation as relation
from . import study as study
from . import template as template
from . import vocabulary as vocabulary
from ._errors import ArgumentError as ArgumentError
from ._errors import Error as Error
from ._errors import InputError as InputError
from ._errors import UsageError as UsageError
from ._errors import WorkError as WorkError
from ._objects import Annotations as Annotations
from ._objects import Array as Array
from ._objects import Bytes as Bytes
from ._objects import Document as Document
from ._objects import Folder as Folder
from ._objects import Mesh as Mesh
from ._objects import Object as Object
from ._objects import Template as Template
from ._report import Report as Report
from ._report import Result as Result
from ._report import Table as Table
from ._types import AnnotationsLike, ArrayLike, FileName, Input, MeshLike, Text

__version__: str

def threads() -> int: ...
def set_threads(count: int) -> None: ...
def memory_limit() -> float: ...
def set_memory_limit(gigabytes: float) -> None: ...

class _AxisResult(Result):
    output: Document | Bytes | Path | None
    annotations_out: Annotations | Path | None
def axis(
    mesh: MeshLike,
    annotations: AnnotationsLike | None = None,
    *,
    output: FileName | bool | None = None,
    annotations_out: FileName | bool | None = None,
    force_mesh: bool | None = False,
    annotation: Text | Sequence[Text] | None = None,
    name: Text | None = None,
    method: Literal["rotation", "slices", "skeleton", "principal"] | None = 'rotation',
    tolerance: float | None = 0.02,
    min_quality: float | None = 0.7,
    slices: int | None = 24,
    trials: int | None = 300,
    smoothing: int | None = 2,
    seed: int | None = 1,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _AxisResult:
    """Compute the axis of an object or of an annotated part; exit code 3 if it has none."""

class _SliceResult(Result):
    output: Folder | Path | None
    profile: Bytes | Path | None
def slice(
    mesh: MeshLike,
    annotations: AnnotationsLike | None = None,
    *,
    output: FileName | bool | None = None,
    profile: FileName | bool | None = None,
    force_mesh: bool | None = False,
    annotation: Text | Sequence[Text] | None = None,
    direction: Text | None = 'up',
    up: Text | None = None,
    count: int | None = None,
    spacing: float | None = None,
    heights: float | Sequence[float] | None = None,
    range: float | Sequence[float] | None = (0.0, 1.0),
    plane: float | Sequence[float] | None = None,
    medial_axis: float | Sequence[float] | None = None,
    axes: bool | None = False,
    unit: Text | None = None,
    title: Text | None = None,
    profile_angle: float | None = None,
    drawn: int | None = 24,
    colour_by: Literal["height", "area", "perimeter", "hole_area", "barycentre_x", "barycentre_y", "outline_area", "outline_perimeter", "outline_barycentre_x", "outline_barycentre_y", "box_length", "box_breadth", "elongation", "eccentricity", "solidity", "compactness", "circular_variance", "rectangular_variance", "components", "holes", "euler_number", "hole_area_ratio", "equivalent_radius", "roundness_equivalent", "roundness_equivalent_relative", "fitted_radius", "fitted_radius_low", "fitted_radius_high", "fitted_centre_x", "fitted_centre_y", "roundness_fitted", "roundness_fitted_relative", "thickness_mean", "thickness_variance", "thickness_least", "thickness_most", "closed_length", "open_length"] | None = 'height',
    min_eccentricity: float | None = 0.7,
    max_roundness: float | None = 0.1,
    similarity: float | None = 0.1,
    tube_seed: int | None = 1,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _SliceResult:
    """Slice an object with planes, describe and draw the slices; exit code 3 if no plane intersects it."""

class _DeformResult(Result):
    output: Mesh | Sequence[Mesh] | Path | None
    annotations_out: Annotations | Path | None
    cage_out: Mesh | Path | None
def deform(
    mesh: MeshLike | None = None,
    annotations: AnnotationsLike | None = None,
    edit: Input | None = None,
    output: FileName | bool | None = None,
    *,
    template: Input | None = None,
    graph: Input | None = None,
    cage: MeshLike | None = None,
    weights: Input | None = None,
    deformed_cage: MeshLike | None = None,
    annotations_out: FileName | bool | None = None,
    cage_out: FileName | bool | None = None,
    allow_outside: bool | None = False,
    force_mesh: bool | None = False,
    states: bool | None = False,
    stretch: Text | Sequence[Text] | None = None,
    raise_: Text | Sequence[Text] | None = None,
    rotate: Text | Sequence[Text] | None = None,
    keep: Text | Sequence[Text] | None = None,
    level: Text | Sequence[Text] | None = None,
    space: Literal["mesh", "cage", "auto"] | None = 'mesh',
    details: Literal["edited", "rest"] | None = 'edited',
    spread: float | None = 0.1,
    laplacian: float | None = 2.0,
    handles: float | None = 100.0,
    followed: float | None = 0.9,
    distortion: float | None = 0.005,
    iterations: int | None = 100,
    tolerance: float | None = 1e-06,
    residual: float | None = 0.0,
    window: int | None = 5,
    rounds: int | None = 100,
    passes: int | None = 5,
    conflicts: int | None = 8,
    distance: float | None = 0.002,
    angle: float | None = 1.0,
    tilt: float | None = 20.0,
    ratio: float | None = 10.0,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _DeformResult:
    """Edit a shape and preserve its semantics (exit code 3: a constraint does not hold)."""

class _FitResult(Result):
    output: Folder | Path | None
def fit(
    template: Input,
    fragments: MeshLike | Sequence[MeshLike],
    *,
    assembly: Input | None = None,
    class_: Input | None = None,
    vocabulary: Input | None = None,
    output: FileName | bool | None = None,
    allow_outside: bool | None = False,
    force_mesh: bool | None = False,
    fresh: bool | None = False,
    placed: bool | None = False,
    outlier: float | None = 0.25,
    unit_ratio: float | None = 3.0,
    collinear: float | None = 0.03,
    search: Literal["auto", "always", "never"] | None = 'auto',
    search_min_scale: float | None = 1.0,
    search_max_scale: float | None = 1.0,
    search_tolerance: float | None = 0.02,
    min_confidence: float | None = 0.5,
    search_points: int | None = 2000,
    search_references: int | None = 120,
    search_partners: int | None = 300,
    search_candidates: int | None = 10,
    search_seed: int | None = 1,
    refine: bool | None = True,
    icp_trim: float | None = 0.8,
    icp_reach: float | None = 0.1,
    icp_angle: float | None = 60.0,
    icp_landmarks: float | None = 1.0,
    icp_samples: int | None = 3000,
    icp_iterations: int | None = 60,
    turns: Literal["auto", "never"] | None = 'auto',
    turn_frames: int | None = 200,
    turn_samples: int | None = 2000,
    turn_candidates: int | None = 16,
    turn_beam: int | None = 64,
    turn_hold: float | None = 0.5,
    min_joint: float | None = 0.5,
    min_score: float | None = 0.4,
    class_iterations: int | None = 40,
    class_limit: float | None = 3.0,
    class_samples: float | None = 20.0,
    space: Literal["mesh", "cage", "both"] | None = 'mesh',
    smoothing: float | None = 0.3,
    detail: float | None = 0.01,
    levels: int | None = 6,
    steps: int | None = 3,
    transition: float | None = 0.5,
    fade: float | None = 3.0,
    reach: float | None = 0.1,
    last_reach: float | None = 0.02,
    match_angle: float | None = 60.0,
    counterparts: Literal["sliding", "surface", "best", "one-to-one"] | None = 'sliding',
    boundary_weight: float | None = 1.0,
    distance_weight: float | None = 1.0,
    outline_weight: float | None = 1.0,
    guides: float | None = 1.0,
    outlines: bool | None = True,
    seam_angle: float | None = 60.0,
    seam_width: float | None = 0.03,
    confidence_length: float | None = 0.1,
    join: bool | None = True,
    min_piece: float | None = 0.01,
    observed: float | None = 0.02,
    scale_tolerance: float | None = 10.0,
    slack: float | None = 3.0,
    residual: float | None = 0.25,
    lying: float | None = 50.0,
    overlap: float | None = 20.0,
    restore: bool | None = True,
    facets: Literal["either", "annotated", "auto", "none"] | None = 'either',
    facet_edge: float | None = 40.0,
    facet_wall: float | None = 0.25,
    facet_coherence: float | None = 0.3,
    cloud_neighbours: int | None = 18,
    cloud_edge: float | None = 8.0,
    cloud_holes: float | None = 1.0,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _FitResult:
    """Complete an object from fragments by a template of its class, and report whether the fragments are compatible (exit code 3: they are not, or there is no answer)."""

class _PairResult(Result):
    output: Folder | Path | None
def pair(
    first: MeshLike,
    second: MeshLike,
    *,
    output: FileName | bool | None = None,
    frames: int | None = 160,
    samples: int | None = 2000,
    starts: int | None = 200,
    refined: int | None = 32,
    reach: float | None = 0.05,
    last_reach: float | None = 0.025,
    edges: float | None = 1.0,
    min_confidence: float | None = 0.5,
    candidates: int | None = 5,
    facets: Literal["either", "annotated", "auto", "none"] | None = 'either',
    facet_edge: float | None = 40.0,
    facet_wall: float | None = 0.25,
    facet_coherence: float | None = 0.3,
    cloud_neighbours: int | None = 18,
    cloud_edge: float | None = 8.0,
    cloud_holes: float | None = 1.0,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _PairResult:
    """Register two fragments along their common fracture surface; exit code 3 if there is no answer."""

class _AssembleResult(Result):
    output: Folder | Path | None
def assemble(
    fragments: Input | Sequence[Input],
    *,
    template: Input | None = None,
    class_: Input | None = None,
    output: FileName | bool | None = None,
    allow_outside: bool | None = False,
    force_mesh: bool | None = False,
    no_pictures: bool | None = False,
    fresh: bool | None = False,
    min_join: float | None = 0.8,
    partners: int | None = 24,
    min_faces: int | None = 100,
    frames: int | None = 160,
    samples: int | None = 2000,
    starts: int | None = 200,
    refined: int | None = 32,
    reach: float | None = 0.05,
    last_reach: float | None = 0.025,
    edges: float | None = 1.0,
    min_confidence: float | None = 0.5,
    candidates: int | None = 5,
    facets: Literal["either", "annotated", "auto", "none"] | None = 'either',
    facet_edge: float | None = 40.0,
    facet_wall: float | None = 0.25,
    facet_coherence: float | None = 0.3,
    cloud_neighbours: int | None = 18,
    cloud_edge: float | None = 8.0,
    cloud_holes: float | None = 1.0,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _AssembleResult:
    """Join fragments along their fracture surfaces, leave out unrelated ones, and report the probability of each join; exit code 3 if nothing is joined."""

class _RenderResult(Result):
    picture: Bytes | Path | None
    turntable: Folder | Path | None
def render(
    meshes: MeshLike | Sequence[MeshLike],
    picture: FileName | bool | None = None,
    *,
    annotations: AnnotationsLike | None | Sequence[AnnotationsLike | None] | None = None,
    map: ArrayLike | None | Sequence[ArrayLike | None] | None = None,
    cage: MeshLike | None | Sequence[MeshLike | None] | None = None,
    turntable: FileName | bool | None = None,
    force_mesh: bool | None = False,
    measures: bool | None = False,
    outlines: Literal["exact", "smooth"] | None = 'exact',
    frames: int | None = 72,
    title: Text | Sequence[Text] | None = None,
    map_on: Literal["auto", "vertex", "face"] | None = 'auto',
    map_label: Text | None = None,
    map_range: float | Sequence[float] | None = None,
    colour_by: Literal["auto", "labels", "colours", "none"] | None = 'auto',
    unit: Text | None = None,
    size: Text | None = '1200x900',
    view: Text | None = '30,20',
    views: Text | None = None,
    up: Text | None = 'auto',
    projection: Literal["orthographic", "perspective"] | None = 'orthographic',
    zoom: float | None = 1.0,
    fit: Literal["all", "each"] | None = 'all',
    shading: Literal["smooth", "flat"] | None = 'smooth',
    crease: float | None = 40.0,
    ambient_occlusion: int | None = 0,
    samples: int | None = 8,
    edges: bool | None = False,
    drawing: Literal["surface", "lines", "wire", "points"] | None = 'surface',
    contours: bool | None = False,
    labels: bool | None = False,
    axes: bool | None = False,
    supersample: int | None = 0,
    deep: bool | None = False,
    theme: Literal["light", "dark"] | None = 'light',
    background: Text | None = 'auto',
    transparent: bool | None = False,
    no_scale_bar: bool | None = False,
    no_legend: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _RenderResult:
    """Make a picture of meshes, their annotations and maps."""

class _PublishResult(Result):
    folder: Folder | Path | None
def publish(
    mesh: MeshLike,
    annotations: AnnotationsLike,
    folder: FileName | bool | None = None,
    *,
    force_mesh: bool | None = False,
    address: Text | None = None,
    title: Text | None = None,
    rights: Text | None = None,
    credit: Text | None = None,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _PublishResult:
    """Write an annotated object as a folder that any web server serves: IIIF manifest, GLB with features, annotations, a page."""

class _ReportResult(Result):
    page: Document | Bytes | Path | None
    beside: Folder | Path | None
def report(
    results: Input | Sequence[Input],
    page: FileName | bool | None = None,
    *,
    beside: FileName | bool | None = None,
    title: Text | None = None,
    unit: Text | None = None,
    limit: int | None = 200000,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _ReportResult:
    """Make one HTML page of results that opens anywhere: objects in 3D, tables, drawings."""

class _RunResult(Result):
    output: Folder | Path | None
def run(
    study: Input,
    *,
    output: FileName | bool | None = None,
    quick: bool | None = False,
    set: Text | Sequence[Text] | None = None,
    only: Text | Sequence[Text] | None = None,
    dry_run: bool | None = False,
    explain: Text | None = None,
    again: bool | None = False,
    shard: Text | None = None,
    reads: Text | Sequence[Text] | None = None,
    allow_programs: bool | None = False,
    programs: Text | None = None,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _RunResult:
    """Run the steps of a study file; steps that have not changed are not run again (exit code 3: a step failed)."""

class _ReplayResult(Result):
    output: Folder | Path | None
def replay(
    crate: Input,
    *,
    output: FileName | bool | None = None,
    inputs: Text | None = None,
    reads: Text | Sequence[Text] | None = None,
    allow_programs: bool | None = False,
    programs: Text | None = None,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _ReplayResult:
    """Repeat a run of a study and compare all its outputs, to the bit; exit code 3 if something differs."""

class _OperationsResult(Result):
    pages: Folder | Path | None
    manuals: Folder | Path | None
    completions: Folder | Path | None
def operations(
    name: Text | None = None,
    *,
    pages: FileName | bool | None = None,
    manuals: FileName | bool | None = None,
    completions: FileName | bool | None = None,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _OperationsResult:
    """List every operation with its inputs, outputs, options, ranges, defaults and units."""

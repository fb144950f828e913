# Generated from the table of operations: python3 -m ostraka stubs
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Literal

from .._objects import Annotations, Array, Bytes, Document, Folder, Mesh, Object, Template
from .._report import Result
from .._types import AnnotationsLike, ArrayLike, FileName, Input, MeshLike, Text

class _PackResult(Result):
    output: Template | Path | None
def pack(
    output: FileName | bool | None = None,
    *,
    mesh: MeshLike,
    annotations: AnnotationsLike | None = None,
    graph: Input | None = None,
    cage: MeshLike | Sequence[MeshLike] | None = None,
    coordinates: Input | Sequence[Input] | None = None,
    vocabulary: Input | None = None,
    rules: Input | None = None,
    ranges: Input | None = None,
    landmarks: Input | None = None,
    class_: Text | None = None,
    unit: Text | None = None,
    up: Text | None = None,
    copy: bool | None = False,
    allow_outside: bool | None = False,
    force_mesh: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _PackResult:
    """Write one file that lists the files of a template, checked as a whole; exit code 3, and nothing written, if they are inconsistent."""

def check(
    template: Input,
    *,
    allow_outside: bool | None = False,
    force_mesh: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> Result:
    """Check a template as a whole; exit code 3 if there are defects."""

def show(
    template: Input,
    *,
    allow_outside: bool | None = False,
    force_mesh: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> Result:
    """Show the contents of a template and its defects."""

class _LearnResult(Result):
    output: Folder | Path | None
def learn(
    template: Input,
    members: MeshLike | Sequence[MeshLike] | None = None,
    *,
    strangers: MeshLike | Sequence[MeshLike] | None = None,
    vocabulary: Input | None = None,
    output: FileName | bool | None = None,
    allow_outside: bool | None = False,
    force_mesh: bool | None = False,
    name: Text | None = None,
    given: bool | None = False,
    outlier: float | None = 0.25,
    unit_ratio: float | None = 3.0,
    collinear: float | None = 0.03,
    shrinkage: float | None = 0.3,
    trim: float | None = 0.8,
    pair_angle: float | None = 45.0,
    samples: int | None = 1000,
    iterations: int | None = 60,
    min_score: float | None = 0.4,
    space: Literal["mesh", "cage", "both"] | None = 'mesh',
    smoothing: float | None = 0.3,
    detail: float | None = 0.01,
    levels: int | None = 6,
    steps: int | None = 3,
    transition: float | None = 0.5,
    fade: float | None = 3.0,
    reach: float | None = 0.2,
    last_reach: float | None = 0.05,
    match_angle: float | None = 60.0,
    counterparts: Literal["sliding", "surface", "best", "one-to-one"] | None = 'surface',
    boundary_weight: float | None = 1.0,
    distance_weight: float | None = 1.0,
    outline_weight: float | None = 1.0,
    guides: float | None = 1.0,
    outlines: bool | None = True,
    ignore_landmarks: bool | None = False,
    tries: int | None = 1,
    observed: float | None = 0.02,
    max_off: float | None = 0.125,
    sizes: bool | None = False,
    modes: int | None = 1000,
    variance: float | None = 1.0,
    correspondence: Literal["auto", "given", "fitted"] | None = 'auto',
    false_reject: float | None = 0.05,
    unsure: float | None = 0.15,
    accept: float | None = 0.05,
    resolution: float | None = 0.02,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _LearnResult:
    """Learn a class from members of it: ranges of measures, mean shape, modes of variation, archetype, thresholds."""

class _ClassifyResult(Result):
    report_: Document | Bytes | Path | None
def classify(
    files: Input | Sequence[Input],
    *,
    vocabulary: Input | None = None,
    report: FileName | bool | None = None,
    outlier: float | None = 0.25,
    unit_ratio: float | None = 3.0,
    collinear: float | None = 0.03,
    shrinkage: float | None = 0.3,
    trim: float | None = 0.8,
    pair_angle: float | None = 45.0,
    samples: int | None = 1000,
    iterations: int | None = 60,
    min_score: float | None = 0.4,
    space: Literal["mesh", "cage", "both"] | None = 'mesh',
    smoothing: float | None = 0.3,
    detail: float | None = 0.01,
    levels: int | None = 6,
    steps: int | None = 3,
    transition: float | None = 0.5,
    fade: float | None = 3.0,
    reach: float | None = 0.2,
    last_reach: float | None = 0.05,
    match_angle: float | None = 60.0,
    counterparts: Literal["sliding", "surface", "best", "one-to-one"] | None = 'surface',
    boundary_weight: float | None = 1.0,
    distance_weight: float | None = 1.0,
    outline_weight: float | None = 1.0,
    guides: float | None = 1.0,
    outlines: bool | None = True,
    ignore_landmarks: bool | None = False,
    tries: int | None = 1,
    observed: float | None = 0.02,
    max_off: float | None = 0.125,
    correspondence: Literal["auto", "given", "fitted"] | None = 'auto',
    strict: bool | None = False,
    attributes: bool | None = False,
    close: float | None = 0.05,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _ClassifyResult:
    """Report the class of objects, and which proportion, relation or distance contradicts it (exit code 3: an object belongs to no class, or there is no answer)."""

class _SampleResult(Result):
    output: Folder | Path | None
def sample(
    class_: Input,
    *,
    output: FileName | bool | None = None,
    count: int | None = 10,
    seed: int | None = 1,
    by: Literal["modes", "edits"] | None = 'modes',
    spread: float | None = 1.0,
    edit: float | None = 0.2,
    attempts: int | None = 20,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _SampleResult:
    """Sample new members of a class that satisfy its constraints (exit code 3: fewer than requested)."""

class _PropagateResult(Result):
    output: Folder | Path | None
def propagate(
    template: Input,
    members: MeshLike | Sequence[MeshLike],
    *,
    vocabulary: Input | None = None,
    output: FileName | bool | None = None,
    allow_outside: bool | None = False,
    force_mesh: bool | None = False,
    given: bool | None = False,
    correspondence: Literal["auto", "given", "fitted"] | None = 'auto',
    outlier: float | None = 0.25,
    unit_ratio: float | None = 3.0,
    collinear: float | None = 0.03,
    shrinkage: float | None = 0.3,
    trim: float | None = 0.8,
    pair_angle: float | None = 45.0,
    samples: int | None = 1000,
    iterations: int | None = 60,
    min_score: float | None = 0.4,
    space: Literal["mesh", "cage", "both"] | None = 'mesh',
    smoothing: float | None = 0.3,
    detail: float | None = 0.01,
    levels: int | None = 6,
    steps: int | None = 3,
    transition: float | None = 0.5,
    fade: float | None = 3.0,
    reach: float | None = 0.2,
    last_reach: float | None = 0.05,
    match_angle: float | None = 60.0,
    counterparts: Literal["sliding", "surface", "best", "one-to-one"] | None = 'surface',
    boundary_weight: float | None = 1.0,
    distance_weight: float | None = 1.0,
    outline_weight: float | None = 1.0,
    guides: float | None = 1.0,
    outlines: bool | None = True,
    ignore_landmarks: bool | None = False,
    tries: int | None = 1,
    observed: float | None = 0.02,
    max_off: float | None = 0.125,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _PropagateResult:
    """Fit a template to members of its class and transfer its annotations to them (exit code 3: some are lost, or the template does not fit a member)."""

class _TurnResult(Result):
    output: Folder | Path | None
def turn(
    sherds: MeshLike | Sequence[MeshLike],
    *,
    output: FileName | bool | None = None,
    unit: Text | None = None,
    rows: int | None = 400,
    columns: int | None = 360,
    presence: float | None = 3.0,
    profile_smoothing: float | None = 1.5,
    layout_angle: float | None = 2.0,
    layout_shift: float | None = 0.02,
    vertices: int | None = 25000,
    method: Literal["rotation", "slices", "skeleton", "principal"] | None = 'rotation',
    tolerance: float | None = 0.02,
    min_quality: float | None = 0.7,
    slices: int | None = 24,
    trials: int | None = 300,
    smoothing: int | None = 2,
    seed: int | None = 1,
    facets: Literal["either", "annotated", "auto", "none"] | None = 'either',
    facet_edge: float | None = 40.0,
    facet_wall: float | None = 0.25,
    facet_coherence: float | None = 0.3,
    cloud_neighbours: int | None = 18,
    cloud_edge: float | None = 8.0,
    cloud_holes: float | None = 1.0,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _TurnResult:
    """Reconstruct a whole vessel from its sherds as a surface of revolution, with its profile."""

# Generated from the table of operations: python3 -m ostraka stubs
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Literal

from . import make as make
from .._objects import Annotations, Array, Bytes, Document, Folder, Mesh, Object, Template
from .._report import Result
from .._types import AnnotationsLike, ArrayLike, FileName, Input, MeshLike, Text

class _LandmarksResult(Result):
    output: Folder | Path | None
def landmarks(
    collection: Input,
    *,
    truth: Input | None = None,
    output: FileName | bool | None = None,
    plots: Literal["svg", "pdf", "png"] | None = 'svg',
    shard: Text | None = None,
    own_truth: bool | None = False,
    truth_column: Text | None = None,
    components: int | None = 5,
    scaling: bool | None = False,
    reflection: bool | None = False,
    leave_odd_out: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _LandmarksResult:
    """Generalised Procrustes analysis of the landmarks of a collection: mean shape, sizes, principal components."""

class _ProportionsResult(Result):
    output: Folder | Path | None
    graph: Document | Path | None
    annotations_out: Annotations | Path | None
def proportions(
    collection: Input,
    *,
    vocabulary: Input | None = None,
    measures: Input | None = None,
    template_mesh: MeshLike | None = None,
    template_annotations: AnnotationsLike | None = None,
    template_graph: Input | None = None,
    output: FileName | bool | None = None,
    graph: FileName | bool | None = None,
    annotations_out: FileName | bool | None = None,
    plots: Literal["svg", "pdf", "png"] | None = 'svg',
    shard: Text | None = None,
    force_mesh: bool | None = False,
    false_discoveries: float | None = 0.05,
    correction: Literal["bh", "by"] | None = 'bh',
    permutations: int | None = 4999,
    range: float | None = 0.9,
    confidence: float | None = 0.95,
    seed: int | None = 1,
    stable: bool | None = False,
    weight: float | None = 1.0,
    hard: bool | None = False,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _ProportionsResult:
    """Find ratios of measures that are fixed in a collection (or a table of measures, .csv); exit code 3 if there is none."""

class _MouldsResult(Result):
    output: Folder | Path | None
def moulds(
    collection: Input,
    *,
    truth: Input | None = None,
    vocabulary: Input | None = None,
    output: FileName | bool | None = None,
    plots: Literal["svg", "pdf", "png"] | None = 'svg',
    shard: Text | None = None,
    own_truth: bool | None = False,
    truth_column: Text | None = None,
    annotation: Text | Sequence[Text] | None = None,
    without: Text | Sequence[Text] | None = None,
    proposed: Literal["none", "tube", "top", "segment"] | None = 'none',
    similarity: Literal["matches", "consistent", "registration", "combined"] | None = 'combined',
    leave_out: int | Sequence[int] | None = None,
    choices: bool | None = False,
    feature_size: float | None = 0.0,
    first_scale: float | None = 0.015,
    scales: int | None = 7,
    scales_per_octave: int | None = 3,
    border: float | None = 1.0,
    contrast: float | None = 0.01,
    second_direction: float | None = 0.8,
    ratio: float | None = 0.8,
    loose_ratio: float | None = 0.9,
    tolerance: float | None = 0.02,
    normal_angle: float | None = 30.0,
    shrinkage: float | None = 0.0,
    trim: float | None = 0.8,
    samples: int | None = 1000,
    method: Literal["linkage", "dbscan", "embedding"] | None = 'linkage',
    epsilon: Text | None = 'nested',
    expected_size: int | None = 0,
    dimensions: int | None = 3,
    stability_resamples: int | None = 100,
    stability_share: float | None = 0.8,
    seed: int | None = 1,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _MouldsResult:
    """Group heads by the mould from which they were cast."""

class _TechniqueResult(Result):
    output: Folder | Path | None
def technique(
    collection: Input,
    *,
    truth: Input | None = None,
    vocabulary: Input | None = None,
    output: FileName | bool | None = None,
    plots: Literal["svg", "pdf", "png"] | None = 'svg',
    shard: Text | None = None,
    own_truth: bool | None = False,
    truth_column: Text | None = None,
    annotation: Text | Sequence[Text] | None = None,
    without: Text | Sequence[Text] | None = None,
    proposed: Literal["none", "tube", "top", "segment"] | None = 'none',
    up: Text | None = None,
    slices: int | None = 100,
    from_: float | None = 0.02,
    to: float | None = 0.4,
    min_turn: float | None = 0.8,
    min_slices: int | None = 20,
    positive: Text | None = None,
    answer_by: Literal["roundness", "roundness variance", "roundness mean and variance", "eccentricity", "eccentricity variance", "eccentricity mean and variance", "both means", "both", "equivalent roundness", "ovality", "marks", "coherence", "straightness", "upright straightness", "wall variation", "outside", "outside and wall"] | None = 'both',
    folds: int | None = 10,
    repeats: int | None = 10,
    resamples: int | None = 300,
    simulations: int | None = 999,
    unlike_from: float | None = 6.0,
    seed: int | None = 1,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _TechniqueResult:
    """Classify bodies as wheel-made or hand-made from their lower slices."""

class _SegmentsResult(Result):
    output: Annotations | Path | None
    curve: Bytes | Path | None
def segments(
    mesh: MeshLike,
    output: FileName | bool | None = None,
    *,
    compare: AnnotationsLike | None = None,
    curve: FileName | bool | None = None,
    force_mesh: bool | None = False,
    up: Text | None = None,
    unit: Text | None = None,
    slices: int | None = 100,
    clusters: int | None = 0,
    min_run: int | None = 3,
    size: bool | None = False,
    max_clusters: int | None = 10,
    criterion: Literal["silhouette", "gap"] | None = 'silhouette',
    references: int | None = 50,
    restarts: int | None = 20,
    iterations: int | None = 300,
    seed: int | None = 1,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _SegmentsResult:
    """Segment an object along its height by clustering its slices."""

"""Types of the parameters of functions, for type checkers."""

import os
from collections.abc import Mapping, Sequence
from typing import Any, Protocol, Union

import numpy

from ._objects import Annotations, Mesh, Object


class HasVertices(Protocol):
    """A mesh of trimesh."""

    @property
    def vertices(self) -> Any: ...
    @property
    def faces(self) -> Any: ...


class HasPoints(Protocol):
    """A mesh of PyVista."""

    @property
    def points(self) -> Any: ...
    @property
    def faces(self) -> Any: ...


FileName = Union[str, "os.PathLike[str]"]
Text = Union[str, "os.PathLike[str]", Sequence[float], numpy.ndarray]
Input = Union[FileName, Object, bytes, Mapping[str, Any], Sequence[Any]]
MeshLike = Union[FileName, Mesh, Object, bytes, HasVertices, HasPoints]
AnnotationsLike = Union[FileName, Annotations, Object, bytes, Mapping[str, Any]]
ArrayLike = Union[FileName, Object, bytes, numpy.ndarray, Sequence[float]]

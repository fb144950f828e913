# Generated from the table of operations: python3 -m ostraka stubs
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Literal

from .._objects import Annotations, Array, Bytes, Document, Folder, Mesh, Object, Template
from .._report import Result
from .._types import AnnotationsLike, ArrayLike, FileName, Input, MeshLike, Text

def check(
    vocabulary: Input,
    *,
    scheme: Text | None = None,
    progress: Callable[[str, float], object] | bool | None = None,
) -> Result:
    """Look for defects in a vocabulary; exit code 3 if there are any."""

def show(
    vocabulary: Input,
    *,
    language: Text | None = 'en',
    under: Text | None = None,
    progress: Callable[[str, float], object] | bool | None = None,
) -> Result:
    """Show concepts as a tree, with the attributes that each may have."""

class _ConvertResult(Result):
    output: Document | Bytes | Path | None
def convert(
    input: Input,
    output: FileName | bool | None = None,
    *,
    scheme: Text | None = None,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _ConvertResult:
    """Convert vocabularies between Ostraka's format and SKOS."""

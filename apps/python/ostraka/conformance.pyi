# Made from the table of operations: python3 -m ostraka stubs
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Literal

from .._objects import Annotations, Array, Bytes, Document, Folder, Mesh, Object, Template
from .._report import Result
from .._types import AnnotationsLike, ArrayLike, FileName, Input, MeshLike, Text

class _RunResult(Result):
    junit: Document | Bytes | Path | None
def run(
    command: Text | Sequence[Text] | None = None,
    *,
    kit: Input | None = None,
    junit: FileName | bool | None = None,
    lines: bool | None = False,
    only: Text | Sequence[Text] | None = None,
    time_limit: float | None = 120.0,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _RunResult:
    """Give the golden cases to another program, and say where it agrees (exit code 3: somewhere it does not)."""

class _SelfResult(Result):
    junit: Document | Bytes | Path | None
def self(
    *,
    kit: Input | None = None,
    junit: FileName | bool | None = None,
    record: bool | None = False,
    only: Text | Sequence[Text] | None = None,
    time_limit: float | None = 120.0,
    progress: Callable[[str, float], object] | bool | None = None,
) -> _SelfResult:
    """The golden cases by this command; exit code 3 if one differs."""

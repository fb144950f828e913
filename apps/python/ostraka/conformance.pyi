# Generated from the table of operations: python3 -m ostraka stubs
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
    """Run the golden cases with another program, and report where it agrees (exit code 3: it differs somewhere)."""

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
    """Run the golden cases with this command; exit code 3 if one differs."""

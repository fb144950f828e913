"""Type stubs of the package, made from the table: `python3 -m ostraka stubs FOLDER` writes them."""

from __future__ import annotations

import pathlib
from typing import Any

from . import _functions, _ostraka
from ._report import attribute_name

_inputs = {"mesh": "MeshLike", "cage": "MeshLike", "annotations": "AnnotationsLike", "values": "ArrayLike",
           "labels": "ArrayLike", "coordinates": "Input", "recipe": "Input | ArrayLike"}
_outputs = {"mesh": "Mesh", "cage": "Mesh", "annotations": "Annotations", "graph": "Document", "values": "Array",
            "coordinates": "Array", "index map": "Array", "template": "Template", "folder": "Folder", "collection": "Folder",
            "picture": "Bytes"}
_options = {"boolean": "bool", "integer": "int", "number": "float", "text": "Text", "choice": "str",
            "texts": "Text | Sequence[Text]", "numbers": "float | Sequence[float]", "integers": "int | Sequence[int]"}

_head = '''# Made from the table of operations: python3 -m ostraka stubs
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Literal

{imports}
'''


_own = '''
__version__: str

def threads() -> int: ...
def set_threads(count: int) -> None: ...
def memory_limit() -> float: ...
def set_memory_limit(gigabytes: float) -> None: ...
'''


def _type_of(one: _functions.Parameter) -> str:
    declared = one.declared
    if one.role == "output":
        return "FileName | bool"
    if one.role == "option":
        if "choices" in declared:
            names = "Literal[" + ", ".join(f'"{name}"' for name in declared["choices"]) + "]"
            return f"{names} | Sequence[{names}]" if one.is_list else names
        return _options[declared["type"]]
    kind = _inputs.get(declared["kind"], "Input")
    if declared["named"]:
        return f"dict[str, {kind}] | FileName"
    if declared["repeated"]:
        each = f"{kind} | None" if declared["none"] else kind
        return f"{each} | Sequence[{each}]"
    return kind


def _stub_of(name: str, declared: dict[str, Any]) -> str:
    """A class for what the function returns, where it has outputs, and the function."""
    parameters = _functions.parameters_of(declared)
    outputs = [one for one in parameters if one.role == "output"]
    text, result = "", "Result"
    if outputs:
        result = "_" + name.rstrip("_").title().replace("_", "") + "Result"
        text += f"class {result}(Result):\n"
        for one in outputs:
            kind = _outputs.get(one.declared["kind"], "Document | Bytes")
            many = f"Sequence[{kind}] | " if one.declared["kind"] == "mesh" else ""
            text += f"    {attribute_name(one.python_name)}: {kind} | {many}Path | None\n"
    text += f"def {name}(\n"
    keyword_only = False
    for one in parameters:
        if not one.has_place and not keyword_only:
            keyword_only = True
            text += "    *,\n"
        text += f"    {one.python_name}: {_type_of(one)}" + (",\n" if one.needed else f" | None = {one.default!r},\n")
    text += "" if keyword_only else "    *,\n"
    text += f"    progress: Callable[[str, float], object] | bool | None = None,\n) -> {result}:\n"
    return text + f'    """{_functions.sentence(declared["help"])}"""\n'


def stubs() -> dict[str, str]:
    """The text of each file, by its name within the package."""
    groups = [name for name, _ in _ostraka.groups()]
    bodies: dict[str, list[str]] = {name: [] for name in ["", *groups]}
    names: dict[str, set[str]] = {name: set() for name in bodies}
    for name in groups:
        outer, _, word = name.rpartition(" ")
        names[outer].add(_functions.python_name(word))
    for declared in _functions.declarations():
        group, _, word = declared["name"].rpartition(" ")
        name = _functions.free_name(word, names[group])
        names[group].add(name)
        bodies[group].append(_stub_of(name, declared))
    files = {}
    for group, parts in bodies.items():
        folder = "".join(_functions.python_name(word) + "/" for word in group.split())
        inner = sorted(_functions.python_name(one.rpartition(" ")[2]) for one in groups if one.rpartition(" ")[0] == group)
        dots = "." * (group.count(" ") + 2 if group else 1)
        imports = "".join(f"from {'.' if group else dots} import {name} as {name}\n" for name in inner)
        classes = "Annotations, Array, Bytes, Document, Folder, Mesh, Object, Template"
        if group:
            imports += f"from {dots}_objects import {classes}\nfrom {dots}_report import Result\n"
        else:
            imports += "".join(f"from .{module} import {name} as {name}\n" for module, listed in
                               (("_errors", "ArgumentError, Error, InputError, UsageError, WorkError"), ("_objects", classes),
                                ("_report", "Report, Result, Table")) for name in listed.split(", "))
        imports += f"from {dots}_types import AnnotationsLike, ArrayLike, FileName, Input, MeshLike, Text\n"
        own = "" if group else _own
        file = (folder + "__init__.pyi") if inner or not group else folder.rstrip("/") + ".pyi"
        files[file] = _head.format(imports=imports.rstrip("\n")) + own + "".join("\n" + part for part in parts)
    return files


def write_stubs(folder: pathlib.Path) -> None:
    for name, text in stubs().items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")

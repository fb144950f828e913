"""Type stubs of the package, generated from the table: `python3 -m ostraka stubs FOLDER` writes them."""

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

_head = '''# Generated from the table of operations: python3 -m ostraka stubs
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Literal

{imports}
'''


_top_level = '''
__version__: str

def threads() -> int: ...
def set_threads(count: int) -> None: ...
def memory_limit() -> float: ...
def set_memory_limit(gigabytes: float) -> None: ...
'''


def _type_of(parameter: _functions.Parameter) -> str:
    declaration = parameter.declaration
    if parameter.role == "output":
        return "FileName | bool"
    if parameter.role == "option":
        if "choices" in declaration:
            names = "Literal[" + ", ".join(f'"{name}"' for name in declaration["choices"]) + "]"
            return f"{names} | Sequence[{names}]" if parameter.is_list else names
        return _options[declaration["type"]]
    kind = _inputs.get(declaration["kind"], "Input")
    if declaration["named"]:
        return f"dict[str, {kind}] | FileName"
    if declaration["repeated"]:
        element_type = f"{kind} | None" if declaration["none"] else kind
        return f"{element_type} | Sequence[{element_type}]"
    return kind


def _stub_of(name: str, declaration: dict[str, Any]) -> str:
    """The function, and if it has outputs, a class for its result."""
    parameters = _functions.parameters_of(declaration)
    outputs = [parameter for parameter in parameters if parameter.role == "output"]
    text, result = "", "Result"
    if outputs:
        result = "_" + name.rstrip("_").title().replace("_", "") + "Result"
        text += f"class {result}(Result):\n"
        for parameter in outputs:
            kind = _outputs.get(parameter.declaration["kind"], "Document | Bytes")
            many = f"Sequence[{kind}] | " if parameter.declaration["kind"] == "mesh" else ""
            text += f"    {attribute_name(parameter.python_name)}: {kind} | {many}Path | None\n"
    text += f"def {name}(\n"
    keyword_only = False
    for parameter in parameters:
        if not parameter.has_place and not keyword_only:
            keyword_only = True
            text += "    *,\n"
        default = "" if parameter.needed else f" | None = {parameter.default!r}"
        text += f"    {parameter.python_name}: {_type_of(parameter)}{default},\n"
    text += "" if keyword_only else "    *,\n"
    text += f"    progress: Callable[[str, float], object] | bool | None = None,\n) -> {result}:\n"
    return text + f'    """{_functions.sentence(declaration["help"])}"""\n'


def stubs() -> dict[str, str]:
    """The text of each stub file, by its path in the package."""
    groups = [name for name, _ in _ostraka.groups()]
    bodies: dict[str, list[str]] = {name: [] for name in ["", *groups]}
    names: dict[str, set[str]] = {name: set() for name in bodies}
    for name in groups:
        outer, _, word = name.rpartition(" ")
        names[outer].add(_functions.python_name(word))
    for declaration in _functions.declarations():
        group, _, word = declaration["name"].rpartition(" ")
        name = _functions.free_name(word, names[group])
        names[group].add(name)
        bodies[group].append(_stub_of(name, declaration))
    files = {}
    for group, parts in bodies.items():
        folder = "".join(_functions.python_name(word) + "/" for word in group.split())
        inner = sorted(_functions.python_name(group_name.rpartition(" ")[2]) for group_name in groups
                       if group_name.rpartition(" ")[0] == group)
        dots = "." * (group.count(" ") + 2 if group else 1)
        imports = "".join(f"from {'.' if group else dots} import {name} as {name}\n" for name in inner)
        classes = "Annotations, Array, Bytes, Document, Folder, Mesh, Object, Template"
        if group:
            imports += f"from {dots}_objects import {classes}\nfrom {dots}_report import Result\n"
        else:
            imports += "".join(f"from .{module} import {name} as {name}\n" for module, class_names in
                               (("_errors", "ArgumentError, Error, InputError, UsageError, WorkError"), ("_objects", classes),
                                ("_report", "Report, Result, Table")) for name in class_names.split(", "))
        imports += f"from {dots}_types import AnnotationsLike, ArrayLike, FileName, Input, MeshLike, Text\n"
        top_level = "" if group else _top_level
        file = (folder + "__init__.pyi") if inner or not group else folder.rstrip("/") + ".pyi"
        files[file] = _head.format(imports=imports.rstrip("\n")) + top_level + "".join("\n" + part for part in parts)
    return files


def write_stubs(folder: pathlib.Path) -> None:
    for name, text in stubs().items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")

"""A function for each operation, generated from the declarations of the table."""

from __future__ import annotations

import inspect
import json
import keyword
import os
import pathlib
import re
import sys
import textwrap
from typing import Any, Callable, Container

from . import _ostraka
from ._errors import ArgumentError, UsageError, WorkError
from ._objects import Object, as_given, from_native, refuse_masks
from ._report import Report, Result


def python_name(name: str) -> str:
    """Python name of an operation, a parameter or an output: "-" and " " become "_", and "_" is appended to keywords."""
    word = name.replace("-", "_").replace(" ", "_")
    return word + "_" if keyword.iskeyword(word) else word


def free_name(word: str, taken: Container[str]) -> str:
    """Python name of an operation; "_" is appended if the group has the name already."""
    name = python_name(word)
    while name in taken:
        name += "_"
    return name


class Parameter:
    """An input, an output or an option of an operation."""

    def __init__(self, role: str, declaration: dict[str, Any], has_place: bool) -> None:
        self.role = role  # "input", "output" or "option"
        self.declaration = declaration
        self.name: str = declaration["name"]
        self.python_name = python_name(self.name)
        self.has_place = has_place
        self.needed = role != "output" and declaration["required"] and not declaration.get("new", False)
        self.default = _default(declaration) if role == "option" else None

    @property
    def is_list(self) -> bool:
        return self.declaration.get("repeated", False) or self.declaration.get("type") in ("texts", "numbers", "integers")


def _default(declaration: dict[str, Any]) -> Any:
    """Default value of an option; for lists a tuple."""
    value = declaration.get("default")
    kind = declaration["type"]
    if value is None or kind not in ("texts", "numbers", "integers"):
        return value
    words = value.split("; " if kind == "texts" and "choices" not in declaration else ",")
    if kind == "texts":
        return tuple(words)
    return tuple(int(word) if kind == "integers" else float(word) for word in words)


def parameters_of(declaration: dict[str, Any]) -> list[Parameter]:
    """Parameters in the order of the function: required positional ones, other positional ones, then the rest."""
    order = declaration["arguments"][0] if declaration["arguments"] else []
    parameters = []
    for role in ("input", "output", "option"):
        parameters += [Parameter(role, parameter, parameter["name"] in order) for parameter in declaration[role + "s"]]
    placed = [parameter for parameter in parameters if parameter.has_place]
    placed.sort(key=lambda parameter: (not parameter.needed, order.index(parameter.name)))
    return placed + [parameter for parameter in parameters if not parameter.has_place]


# ---- values ----


def _word(value: Any) -> str | None:
    """Text of an option: a text, a file name, or numbers joined by commas; None for other values."""
    if isinstance(value, str):
        return value
    if isinstance(value, os.PathLike):
        return os.fsdecode(value)
    if isinstance(value, (list, tuple)) and value and all(isinstance(number, (int, float)) for number in value):
        return ",".join(repr(int(number) if number == number and abs(number) < 1e15 and number == int(number) else number)
                        for number in value)
    return None


def _option_value(name: str, kind: str, value: Any) -> Any:
    """The value in the form of the native module, which checks it: a boolean, number, text, or list of numbers or texts."""
    refuse_masks(name, value)
    if hasattr(value, "tolist"):
        value = value.tolist()
    if kind == "texts":
        if isinstance(value, (str, os.PathLike)) or _word(value) is not None:
            return [_word(value)]
        if isinstance(value, (list, tuple)):
            words = [_word(element.tolist() if hasattr(element, "tolist") else element) for element in value]
            return [element if word is None else word for element, word in zip(value, words)]
        return [value]
    if kind in ("numbers", "integers"):
        elements = list(value) if isinstance(value, (list, tuple)) else [value]
        return [element.tolist() if hasattr(element, "tolist") else element for element in elements]
    if kind in ("text", "choice") and _word(value) is not None:
        return _word(value)
    return list(value) if isinstance(value, tuple) else value


def _given_inputs(slot: dict[str, Any], value: Any) -> list[tuple[str, Any, str]]:
    """Name, value and label of each value of an input."""
    name, kind = slot["name"], slot["kind"]

    def input_of(element: Any, label: str = "") -> tuple[str, Any, str]:
        if element is None and slot["none"]:
            return name, None, ""
        return name, as_given(element, kind, name, slot["called"]), label

    if slot["named"] and isinstance(value, dict):
        return [input_of(element, label) for label, element in value.items()]
    if slot["named"] and isinstance(value, (str, os.PathLike)):
        label, equals, file = os.fsdecode(value).partition("=")
        if not equals:
            raise UsageError(f"{name} is '{label}'", "", "give a dict of names and files")
        return [input_of(file, label)]
    if slot["repeated"] and isinstance(value, (list, tuple)):
        if not value:
            raise UsageError(f"{name} is an empty list", "", f"give {slot['help']}")
        return [entry for element in value
                for entry in (_given_inputs(slot, element) if slot["named"] else [input_of(element)])]
    return [input_of(value)]


def _given_output(name: str, value: Any) -> tuple[str, Any]:
    if value is True:
        return name, None
    if isinstance(value, str) and value.startswith("memory:"):
        if value == "memory:":
            raise UsageError(f"{name} is 'memory:' without a name", "", "give True, or a name after the colon")
        return name, value[len("memory:"):]
    if isinstance(value, (str, os.PathLike)):
        return name, os.fsencode(value)
    raise UsageError(f"{name} is of the type {type(value).__name__}", "", "give the name of a file, or True for an object")


def progress_bar(phase: str, share: float) -> None:
    sys.stderr.write(f"\r{phase} {int(100 * share):3d} %\033[K" if share < 1 else "\r\033[K")
    sys.stderr.flush()


# ---- functions ----


def make_function(declaration: dict[str, Any]) -> Callable[..., Result]:
    operation: str = declaration["name"]
    parameters = parameters_of(declaration)
    by_name = {parameter.python_name: parameter for parameter in parameters}
    positional = [parameter.python_name for parameter in parameters if parameter.has_place]

    def refuse(problem: str, remedy: str) -> None:
        raise ArgumentError(problem, operation, remedy)

    def function(*arguments: Any, progress: Any = None, **named: Any) -> Result:
        if len(arguments) > len(positional):
            refuse(f"{len(arguments)} arguments are given without a name, but at most {len(positional)} are allowed",
                   "name the others")
        for name, value in zip(positional, arguments):
            if name in named:
                refuse(f"{name} is given twice", "give it once")
            named[name] = value
        options: dict[str, Any] = {}
        inputs: list[tuple[str, Any, str]] = []
        outputs: list[tuple[str, Any]] = []
        files: dict[str, pathlib.Path] = {}
        for name, value in named.items():
            parameter = by_name.get(name)
            if parameter is None:
                nearest = _ostraka.nearest_name(name, [*by_name, "progress"])
                refuse(f"there is no parameter '{name}'", f"did you mean '{nearest}'?" if nearest else "help() shows them")
            if value is None or (value is False and parameter.role == "output"):
                continue
            if parameter.role == "option":
                options[parameter.name] = _option_value(name, parameter.declaration["type"], value)
                continue
            try:
                if parameter.role == "input":
                    inputs += _given_inputs(parameter.declaration, value)
                else:
                    outputs.append(_given_output(parameter.name, value))
                    if isinstance(outputs[-1][1], bytes):
                        files[parameter.name] = pathlib.Path(os.fsdecode(value))
            except UsageError as error:
                raise type(error)(error.problem, error.where or operation, error.remedy) from None
        for parameter in parameters:
            if parameter.needed and named.get(parameter.python_name) is None:
                refuse(f"{parameter.python_name} is missing", "give " + parameter.declaration["help"])
            if parameter.role == "output" and parameter.declaration["required"] and "updates" not in parameter.declaration and \
                    named.get(parameter.python_name) in (None, False):
                outputs.append((parameter.name, None))
        if progress is True:
            progress = progress_bar
        elif progress is False:
            progress = None
        if progress is not None and not callable(progress):
            refuse("progress cannot be called", "give True, or a function of a phase and the fraction done")
        try:
            report, kept_outputs = _ostraka.run(operation, options, inputs, outputs, progress)
        except WorkError as error:  # use the name of the limit in Python
            problem = error.problem.replace("(--memory)", "(ostraka.set_memory_limit)")
            raise WorkError(problem, error.where or operation, error.remedy) from None
        except UsageError as error:  # the message names the option as on the command line
            problem = re.sub("^option ([a-z0-9-]+) ", lambda match: f"option {python_name(match[1])} ", error.problem)
            raise UsageError(problem, error.where, error.remedy) from None
        results: dict[str, Any] = {}
        for parameter in parameters:
            if parameter.role == "output":
                objects: list[Object] = [from_native(native) for native in kept_outputs.get(parameter.name, [])]
                value = objects[0] if len(objects) == 1 else objects or files.get(parameter.name)
                results[parameter.python_name] = value if not isinstance(value, pathlib.Path) or value.exists() else None
        return Result(Report(report), results)

    function.__signature__ = signature_of(parameters)  # type: ignore[attr-defined]
    function.__doc__ = docstring_of(declaration, parameters)
    function.declaration = declaration  # type: ignore[attr-defined]
    return function


def signature_of(parameters: list[Parameter]) -> inspect.Signature:
    kinds = inspect.Parameter
    signature_parameters = []
    for parameter in parameters:
        kind = kinds.POSITIONAL_OR_KEYWORD if parameter.has_place else kinds.KEYWORD_ONLY
        default = kinds.empty if parameter.needed else parameter.default
        signature_parameters.append(kinds(parameter.python_name, kind, default=default))
    signature_parameters.append(kinds("progress", kinds.KEYWORD_ONLY, default=None))
    return inspect.Signature(signature_parameters, return_annotation=Result)


def _about(parameter: Parameter) -> str:
    """Description of the values: "number from 0 to 1 (fraction of the box diagonal)"."""
    declaration = parameter.declaration
    if parameter.role != "option":
        kind = declaration["kind"] + (", one or several" if declaration["repeated"] else "")
        if declaration.get("named"):
            kind += ", in a dict by their names"
        if parameter.role == "output":
            return kind + (", optional" if not declaration["required"] else "")
        return kind + ("" if parameter.needed else ", optional")
    kind = {"texts": "list of texts", "numbers": "list of numbers", "integers": "list of whole numbers",
            "integer": "whole number", "choice": "text"}.get(declaration["type"], declaration["type"])
    if "choices" in declaration:
        kind = "one of " + ", ".join(repr(name) for name in declaration["choices"])
    elif "words" in declaration:
        kind = ", ".join(repr(name) for name in declaration["words"])
        if declaration.get("others"):
            kind += " or " + declaration["others"]
    elif "minimum" in declaration:
        kind += f" from {declaration['minimum']:g} to {declaration['maximum']:g}"
    if declaration.get("unit"):
        kind += f" ({declaration['unit']})"
    return kind + ("" if parameter.needed or parameter.default is None else f", default {parameter.default!r}")


def docstring_of(declaration: dict[str, Any], parameters: list[Parameter]) -> str:
    lines = [sentence(declaration["help"]), "", "Parameters", "----------"]

    def add(name: str, about: str, text: str) -> None:
        lines.append(f"{name} : {about}")
        lines.extend(textwrap.wrap(text, 96, initial_indent="    ", subsequent_indent="    "))

    for parameter in parameters:
        about = ("output: " if parameter.role == "output" else "") + _about(parameter)
        add(parameter.python_name, about, parameter.declaration["help"])
    add("progress", "function or True, optional", "called with the current phase and the fraction done; True draws a bar")
    outputs = [parameter.python_name for parameter in parameters if parameter.role == "output"]
    lines += ["", "Returns", "-------", "ostraka.Result"]
    lines.extend(textwrap.wrap("the report" + (", and the outputs: " + ", ".join(outputs) if outputs else ""), 96,
                               initial_indent="    ", subsequent_indent="    "))
    return "\n".join(lines) + "\n"


def sentence(text: str) -> str:
    return text[:1].upper() + text[1:] + "."


def declarations() -> list[dict[str, Any]]:
    return json.loads(_ostraka.declarations())

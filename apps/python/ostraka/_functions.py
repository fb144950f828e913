"""A function for each operation, made from the declarations of the table."""

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
from ._objects import Object, as_given, refuse_masks, shown
from ._report import Report, Result


def python_name(name: str) -> str:
    """Of an operation, a parameter or an output: "-" and " " are "_", and a word that Python has for itself ends in "_"."""
    word = name.replace("-", "_").replace(" ", "_")
    return word + "_" if keyword.iskeyword(word) else word


def free_name(word: str, taken: Container[str]) -> str:
    """Of an operation beside others: where a group has it already, it ends in "_"."""
    name = python_name(word)
    while name in taken:
        name += "_"
    return name


class Parameter:
    """An input, an output or an option of an operation."""

    def __init__(self, role: str, declared: dict[str, Any], has_place: bool) -> None:
        self.role = role  # "input", "output" or "option"
        self.declared = declared
        self.name: str = declared["name"]
        self.python_name = python_name(self.name)
        self.has_place = has_place
        self.needed = role != "output" and declared["required"] and not declared.get("new", False)
        self.default = _default(declared) if role == "option" else None

    @property
    def is_list(self) -> bool:
        return self.declared.get("repeated", False) or self.declared.get("type") in ("texts", "numbers", "integers")


def _default(declared: dict[str, Any]) -> Any:
    """That of an option; of lists a tuple."""
    value = declared.get("default")
    kind = declared["type"]
    if value is None or kind not in ("texts", "numbers", "integers"):
        return value
    words = value.split("; " if kind == "texts" and "choices" not in declared else ",")
    if kind == "texts":
        return tuple(words)
    return tuple(int(word) if kind == "integers" else float(word) for word in words)


def parameters_of(declared: dict[str, Any]) -> list[Parameter]:
    """In the order of the function: what is needed stands first, then what the command takes by its place, then the rest."""
    order = declared["arguments"][0] if declared["arguments"] else []
    parameters = []
    for role in ("input", "output", "option"):
        parameters += [Parameter(role, one, one["name"] in order) for one in declared[role + "s"]]
    placed = [one for one in parameters if one.has_place]
    placed.sort(key=lambda one: (not one.needed, order.index(one.name)))
    return placed + [one for one in parameters if not one.has_place]


# ---- values ----


def _word(value: Any) -> str | None:
    """Text of an option: a text, a name of a file, or numbers with commas; None where it is none of these."""
    if isinstance(value, str):
        return value
    if isinstance(value, os.PathLike):
        return os.fsdecode(value)
    if isinstance(value, (list, tuple)) and value and all(isinstance(one, (int, float)) for one in value):
        return ",".join(repr(int(one) if one == one and abs(one) < 1e15 and one == int(one) else one) for one in value)
    return None


def _option_value(name: str, kind: str, value: Any) -> Any:
    """As the native module takes it: a boolean, number, text, or list of numbers or texts. It checks them."""
    refuse_masks(name, value)
    if hasattr(value, "tolist"):
        value = value.tolist()
    if kind == "texts":
        if isinstance(value, (str, os.PathLike)) or _word(value) is not None:
            return [_word(value)]
        if isinstance(value, (list, tuple)):
            words = [_word(one.tolist() if hasattr(one, "tolist") else one) for one in value]
            return [one if word is None else word for one, word in zip(value, words)]
        return [value]
    if kind in ("numbers", "integers"):
        listed = list(value) if isinstance(value, (list, tuple)) else [value]
        return [one.tolist() if hasattr(one, "tolist") else one for one in listed]
    if kind in ("text", "choice") and _word(value) is not None:
        return _word(value)
    return list(value) if isinstance(value, tuple) else value


def _given_inputs(slot: dict[str, Any], value: Any) -> list[tuple[str, Any, str]]:
    """An input's name, value and label, once for each of several."""
    name, kind = slot["name"], slot["kind"]

    def one(element: Any, label: str = "") -> tuple[str, Any, str]:
        if element is None and slot["none"]:
            return name, None, ""
        return name, as_given(element, kind, name, slot["called"]), label

    if slot["named"] and isinstance(value, dict):
        return [one(element, label) for label, element in value.items()]
    if slot["named"] and isinstance(value, (str, os.PathLike)):
        label, equals, file = os.fsdecode(value).partition("=")
        if not equals:
            raise UsageError(f"{name} is '{label}'", "", "give a dict of names and files")
        return [one(file, label)]
    if slot["repeated"] and isinstance(value, (list, tuple)):
        if not value:
            raise UsageError(f"{name} is an empty list", "", f"give {slot['help']}")
        return [entry for element in value for entry in (_given_inputs(slot, element) if slot["named"] else [one(element)])]
    return [one(value)]


def _given_output(name: str, value: Any) -> tuple[str, Any]:
    if value is True:
        return name, None
    if isinstance(value, str) and value.startswith("memory:"):
        if value == "memory:":
            raise UsageError(f"{name} is 'memory:' without a name", "", "give True, or a name behind it")
        return name, value[len("memory:"):]
    if isinstance(value, (str, os.PathLike)):
        return name, os.fsencode(value)
    raise UsageError(f"{name} is of the type {type(value).__name__}", "", "give the name of a file, or True for an object")


def progress_bar(phase: str, share: float) -> None:
    sys.stderr.write(f"\r{phase} {int(100 * share):3d} %\033[K" if share < 1 else "\r\033[K")
    sys.stderr.flush()


# ---- functions ----


def make_function(declared: dict[str, Any]) -> Callable[..., Result]:
    operation: str = declared["name"]
    parameters = parameters_of(declared)
    by_name = {one.python_name: one for one in parameters}
    placed = [one.python_name for one in parameters if one.has_place]

    def refuse(problem: str, remedy: str) -> None:
        raise ArgumentError(problem, operation, remedy)

    def function(*arguments: Any, progress: Any = None, **named: Any) -> Result:
        if len(arguments) > len(placed):
            refuse(f"{len(arguments)} arguments are given without a name, and it takes {len(placed)}", "name the others")
        for name, value in zip(placed, arguments):
            if name in named:
                refuse(f"{name} is given twice", "give it once")
            named[name] = value
        options: dict[str, Any] = {}
        inputs: list[tuple[str, Any, str]] = []
        outputs: list[tuple[str, Any]] = []
        files: dict[str, pathlib.Path] = {}
        for name, value in named.items():
            one = by_name.get(name)
            if one is None:
                near = _ostraka.nearest_name(name, [*by_name, "progress"])
                refuse(f"there is no parameter '{name}'", f"did you mean '{near}'?" if near else "help() shows them")
            if value is None or (value is False and one.role == "output"):
                continue
            if one.role == "option":
                options[one.name] = _option_value(name, one.declared["type"], value)
                continue
            try:
                if one.role == "input":
                    inputs += _given_inputs(one.declared, value)
                else:
                    outputs.append(_given_output(one.name, value))
                    if isinstance(outputs[-1][1], bytes):
                        files[one.name] = pathlib.Path(os.fsdecode(value))
            except UsageError as error:
                raise type(error)(error.problem, error.where or operation, error.remedy) from None
        for one in parameters:
            if one.needed and named.get(one.python_name) is None:
                refuse(f"{one.python_name} is missing", "give " + one.declared["help"])
            if one.role == "output" and one.declared["required"] and "updates" not in one.declared and \
                    named.get(one.python_name) in (None, False):
                outputs.append((one.name, None))
        if progress is True:
            progress = progress_bar
        elif progress is False:
            progress = None
        if progress is not None and not callable(progress):
            refuse("progress cannot be called", "give True, or a function of a phase and a share")
        try:
            report, made = _ostraka.run(operation, options, inputs, outputs, progress)
        except WorkError as error:  # use the name of the limit in Python
            problem = error.problem.replace("(--memory)", "(ostraka.set_memory_limit)")
            raise WorkError(problem, error.where or operation, error.remedy) from None
        except UsageError as error:  # the message names the option as on the command line
            problem = re.sub("^option ([a-z0-9-]+) ", lambda match: f"option {python_name(match[1])} ", error.problem)
            raise UsageError(problem, error.where, error.remedy) from None
        results: dict[str, Any] = {}
        for one in parameters:
            if one.role == "output":
                objects: list[Object] = [shown(native) for native in made.get(one.name, [])]
                value = objects[0] if len(objects) == 1 else objects or files.get(one.name)
                results[one.python_name] = value if not isinstance(value, pathlib.Path) or value.exists() else None
        return Result(Report(report), results)

    function.__signature__ = signature_of(parameters)  # type: ignore[attr-defined]
    function.__doc__ = docstring_of(declared, parameters)
    function.declaration = declared  # type: ignore[attr-defined]
    return function


def signature_of(parameters: list[Parameter]) -> inspect.Signature:
    kinds = inspect.Parameter
    listed = []
    for one in parameters:
        listed.append(kinds(one.python_name, kinds.POSITIONAL_OR_KEYWORD if one.has_place else kinds.KEYWORD_ONLY,
                            default=kinds.empty if one.needed else one.default))
    listed.append(kinds("progress", kinds.KEYWORD_ONLY, default=None))
    return inspect.Signature(listed, return_annotation=Result)


def _about(one: Parameter) -> str:
    """What kind of value: "number from 0 to 1, share of the box diagonal"."""
    declared = one.declared
    if one.role != "option":
        kind = declared["kind"] + (", one or several" if declared["repeated"] else "")
        if declared.get("named"):
            kind += ", in a dict by their names"
        if one.role == "output":
            return kind + (", optional" if not declared["required"] else "")
        return kind + ("" if one.needed else ", optional")
    kind = {"texts": "list of texts", "numbers": "list of numbers", "integers": "list of whole numbers",
            "integer": "whole number", "choice": "text"}.get(declared["type"], declared["type"])
    if "choices" in declared:
        kind = "one of " + ", ".join(repr(name) for name in declared["choices"])
    elif "words" in declared:
        kind = ", ".join(repr(name) for name in declared["words"])
        if declared.get("others"):
            kind += " or " + declared["others"]
    elif "minimum" in declared:
        kind += f" from {declared['minimum']:g} to {declared['maximum']:g}"
    if declared.get("unit"):
        kind += f" ({declared['unit']})"
    return kind + ("" if one.needed or one.default is None else f", default {one.default!r}")


def docstring_of(declared: dict[str, Any], parameters: list[Parameter]) -> str:
    lines = [sentence(declared["help"]), "", "Parameters", "----------"]

    def add(name: str, about: str, text: str) -> None:
        lines.append(f"{name} : {about}")
        lines.extend(textwrap.wrap(text, 96, initial_indent="    ", subsequent_indent="    "))

    for one in parameters:
        add(one.python_name, ("output: " if one.role == "output" else "") + _about(one), one.declared["help"])
    add("progress", "function or True, optional", "called with the phase under way and its share done; True draws a bar")
    outputs = [one.python_name for one in parameters if one.role == "output"]
    lines += ["", "Returns", "-------", "ostraka.Result"]
    lines.extend(textwrap.wrap("the report" + (", and the outputs: " + ", ".join(outputs) if outputs else ""), 96,
                               initial_indent="    ", subsequent_indent="    "))
    return "\n".join(lines) + "\n"


def sentence(text: str) -> str:
    return text[:1].upper() + text[1:] + "."


def declarations() -> list[dict[str, Any]]:
    return json.loads(_ostraka.declarations())

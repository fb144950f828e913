"""Laws of the whole table: every operation has a function with a signature, a docstring and a stub."""

import ast
import importlib
import inspect
import keyword
import pathlib

import pytest
from conftest import SOURCE

import ostraka
from ostraka import _functions, _stubs
from ostraka._report import attribute_name

DECLARED = _functions.declarations()


def function_of(name):
    group, _, word = name.rpartition(" ")
    module = importlib.import_module(".".join(["ostraka", *map(_functions.python_name, group.split())]))
    return getattr(module, _functions.python_name(word))


@pytest.mark.parametrize("declared", DECLARED, ids=lambda declared: declared["name"])
def test_every_operation_is_a_function(declared):
    function = function_of(declared["name"])
    signature = inspect.signature(function)
    names = [one["name"] for role in ("inputs", "outputs", "options") for one in declared[role]]
    assert {_functions.python_name(name) for name in names} | {"progress"} == set(signature.parameters)
    assert len(names) + 1 == len(signature.parameters), "two names become one"
    for parameter in signature.parameters.values():
        assert parameter.name.isidentifier() and not keyword.iskeyword(parameter.name)
    documentation = inspect.getdoc(function)
    for role in ("inputs", "outputs", "options"):
        for one in declared[role]:
            assert f"\n{_functions.python_name(one['name'])} : " in documentation
    assert " ".join(declared["help"][1:].split()) in " ".join(documentation.split())
    assert function.__module__ + "." + function.__name__ == "ostraka." + ".".join(
        map(_functions.python_name, declared["name"].split()))


@pytest.mark.parametrize("declared", DECLARED, ids=lambda declared: declared["name"])
def test_defaults_are_those_of_the_table(declared):
    signature = inspect.signature(function_of(declared["name"]))
    for one in declared["options"]:
        default = signature.parameters[_functions.python_name(one["name"])].default
        if one["required"]:
            assert default in (inspect.Parameter.empty, None) or one["name"] not in declared["arguments"][0]
        elif isinstance(default, tuple):
            assert one["type"] in ("texts", "numbers", "integers") and len(default) > 0
        else:
            assert default == one.get("default")


def test_names_of_results_are_not_hidden():
    for declared in DECLARED:
        names = [attribute_name(_functions.python_name(one["name"])) for one in declared["outputs"]]
        assert len(set(names)) == len(names) and not set(names) & {*dir(ostraka.Result), "report", "outputs"}


def test_names_that_python_has_for_itself():
    assert callable(ostraka.mesh.break_) and callable(ostraka.annotation.import_)
    assert "class_" in inspect.signature(ostraka.template.sample).parameters


def test_groups_can_be_imported():
    from ostraka.study.make import moulds
    assert moulds is ostraka.study.make.moulds
    import ostraka.annotation as annotation
    assert annotation.transfer is ostraka.annotation.transfer
    assert "between them" in annotation.__doc__


def test_stubs_are_beside_the_module():
    folder = pathlib.Path(ostraka._ostraka.__file__).parent
    expected = _stubs.stubs()
    assert {str(file.relative_to(folder)) for file in folder.rglob("*.pyi")} == set(expected)
    for name, text in expected.items():
        assert (folder / name).read_text(encoding="utf-8") == text, name


def test_stubs_declare_every_function():
    for declared in DECLARED:
        group, _, word = declared["name"].rpartition(" ")
        path = "/".join(map(_functions.python_name, group.split()))
        texts = _stubs.stubs()
        text = texts.get(path + ".pyi") or texts[(path + "/" if path else "") + "__init__.pyi"]
        tree = ast.parse(text)
        [found] = [one for one in tree.body if isinstance(one, ast.FunctionDef) and one.name == _functions.python_name(word)]
        signature = inspect.signature(function_of(declared["name"]))
        assert [one.arg for one in [*found.args.args, *found.args.kwonlyargs]] == list(signature.parameters)


def test_stubs_can_be_written(tmp_path):
    _stubs.write_stubs(pathlib.Path(tmp_path))
    assert (tmp_path / "study" / "make.pyi").read_text(encoding="utf-8").startswith("# Generated from the table")


def test_version_is_that_of_the_toolkit(command):
    assert command("--version").stdout.strip() == ostraka.__version__

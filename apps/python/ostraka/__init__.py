"""Ostraka: semantics-aware modelling of 3D shapes.

Every command of the toolkit is a function: `ostraka annotation transfer` is `ostraka.annotation.transfer`. In names "-" is "_",
and a word that Python has for itself ends in "_": `ostraka.mesh.break_`. `help()` of a function shows what it takes.

An input is a file, or an object: `Mesh`, `Annotations`, `Document`, `Array`, `Bytes`, arrays of NumPy, dicts, meshes of trimesh
and PyVista. An output is written to the file that is named for it. One that is needed and not named comes back as an object;
True asks for one that is optional, and "memory:NAME" for one that is called so. What a function returns is a `Result`.
"""

import sys as _sys
import types as _types

from . import _functions, _ostraka
from ._errors import ArgumentError, Error, InputError, UsageError, WorkError
from ._objects import Annotations, Array, Bytes, Document, Folder, Mesh, Object, Template
from ._report import Report, Result, Table

__version__: str = _ostraka.version()


def threads() -> int:
    """How many threads an operation may use. Results do not depend on it."""
    return _ostraka.threads()


def set_threads(count: int) -> None:
    """From here on so many; 0: all cores of the machine."""
    if not isinstance(count, int) or isinstance(count, bool) or not 0 <= count <= 1024:
        raise UsageError(f"the number of threads is {count!r}", "", "use 0 (all) to 1024")
    _ostraka.set_threads(count)


def _add_groups() -> dict[str, _types.ModuleType]:
    """A module for each group of operations, by its name in the table."""
    package = _sys.modules[__name__]
    modules = {"": package}
    for name, help_text in _ostraka.groups():
        outer, _, word = name.rpartition(" ")
        module = _types.ModuleType(f"{modules[outer].__name__}.{_functions.python_name(word)}", help_text.capitalize() + ".\n")
        module.__package__ = module.__name__
        module.__path__ = []  # so that those within it can be imported
        setattr(modules[outer], _functions.python_name(word), module)
        _sys.modules[module.__name__] = module
        modules[name] = module
    return modules


def _add_functions(modules: dict[str, _types.ModuleType]) -> None:
    for declared in _functions.declarations():
        group, _, word = declared["name"].rpartition(" ")
        function = _functions.make_function(declared)
        name = _functions.free_name(word, vars(modules[group]))
        function.__name__ = function.__qualname__ = name
        function.__module__ = modules[group].__name__
        setattr(modules[group], name, function)


_add_functions(_add_groups())
__all__ = sorted(name for name in globals() if not name.startswith("_"))

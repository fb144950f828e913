"""Ostraka: semantics-aware modelling of 3D shapes.

Every command of the toolkit is a function: `ostraka annotation transfer` is `ostraka.annotation.transfer`. In names, "-"
becomes "_", and "_" is appended to keywords of Python: `ostraka.mesh.break_`. `help()` of a function shows its parameters.

An input is a file or an object: `Mesh`, `Annotations`, `Document`, `Array`, `Bytes`, NumPy arrays, dicts, meshes of trimesh and
PyVista. An output is written to the file given for it. A required output without a file is returned as an object; True requests
an optional output as an object, and "memory:NAME" an object with this name. Functions return a `Result`.
"""

import os as _os
import sys as _sys
import types as _types



def _openmp_spins() -> bool:
    """Whether OpenMP is loaded already, without a setting of how its threads wait."""
    if "OMP_WAIT_POLICY" in _os.environ or "GOMP_SPINCOUNT" in _os.environ:
        return False
    try:
        with open("/proc/self/maps", encoding="utf-8", errors="replace") as maps:
            return any("/libgomp.so.1" in line for line in maps)
    except OSError:
        return False


# OpenMP reads this once, when it is loaded: idle threads then sleep instead of occupying cores.
_spins = _openmp_spins()
_os.environ.setdefault("OMP_WAIT_POLICY", "passive")

from . import _functions, _ostraka
from ._errors import ArgumentError, Error, InputError, UsageError, WorkError
from ._objects import Annotations, Array, Bytes, Document, Folder, Mesh, Object, Template
from ._report import Report, Result, Table

__version__: str = _ostraka.version()
if _spins:
    _ostraka.hold_spare_team()


def threads() -> int:
    """Number of threads that an operation may use. Results do not depend on it."""
    return _ostraka.threads()


def set_threads(count: int) -> None:
    """Sets the number of threads for later operations; 0: all cores of the machine."""
    if not isinstance(count, int) or isinstance(count, bool) or not 0 <= count <= 1024:
        raise UsageError(f"the number of threads is {count!r}", "", "use 0 (all) to 1024")
    _ostraka.set_threads(count)


def memory_limit() -> float:
    """Memory limit of the process during operations, in gigabytes (10^9 bytes): the limit set, or the memory of the machine."""
    return _ostraka.memory_limit() / 1e9


def set_memory_limit(gigabytes: float) -> None:
    """Sets the memory limit; 0: the memory of the machine. An operation that needs more raises a WorkError."""
    is_number = isinstance(gigabytes, (int, float)) and not isinstance(gigabytes, bool)
    if not is_number or not 0 <= gigabytes <= 1e9:
        raise UsageError(f"the memory limit is {gigabytes!r}", "", "use gigabytes, or 0 (the memory of the machine)")
    _ostraka.set_memory_limit(1e9 * gigabytes)


def _add_groups() -> dict[str, _types.ModuleType]:
    """Creates a module for each group of operations; returns them by their names in the table."""
    package = _sys.modules[__name__]
    modules = {"": package}
    for name, help_text in _ostraka.groups():
        outer, _, word = name.rpartition(" ")
        module = _types.ModuleType(f"{modules[outer].__name__}.{_functions.python_name(word)}", help_text.capitalize() + ".\n")
        module.__package__ = module.__name__
        module.__path__ = []  # makes submodules importable
        setattr(modules[outer], _functions.python_name(word), module)
        _sys.modules[module.__name__] = module
        modules[name] = module
    return modules


def _add_functions(modules: dict[str, _types.ModuleType]) -> None:
    for declaration in _functions.declarations():
        group, _, word = declaration["name"].rpartition(" ")
        function = _functions.make_function(declaration)
        name = _functions.free_name(word, vars(modules[group]))
        function.__name__ = function.__qualname__ = name
        function.__module__ = modules[group].__name__
        setattr(modules[group], name, function)


_add_functions(_add_groups())
__all__ = sorted(name for name in globals() if not name.startswith("_"))

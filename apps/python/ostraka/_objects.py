"""Inputs and outputs of operations: each object represents a file or data in memory."""

from __future__ import annotations

import copy
import json
import os
import pathlib
from collections.abc import Iterator, Mapping
from typing import Any

import numpy

from . import _ostraka
from ._errors import InputError, UsageError


def _is_file_name(value: Any) -> bool:
    return isinstance(value, (str, bytes, os.PathLike))


class Object:
    """An input or output of an operation. It can be saved, and passed to another operation.

    It can be pickled and copied: the result has the same arrays and writes the same bytes. Copies share immutable memory; each
    has a name of its own.
    """

    _cached = ("_native",)  # attributes that are not copied, but recomputed when needed

    def __init__(self, native: _ostraka.Object) -> None:
        self._native = native

    def _attributes(self) -> dict[str, Any]:
        """Attributes added by the user."""
        return {name: value for name, value in vars(self).items() if name not in self._cached}

    def __reduce_ex__(self, protocol: Any) -> tuple[Any, ...]:
        try:
            state = self._native.state()
        except UsageError as error:
            raise TypeError(f"{type(self).__name__} {self.name!r} cannot be pickled: {error}") from error
        return restored, (type(self), state), self._attributes() or None

    def __copy__(self) -> Object:
        copied = _object_of(type(self), self._native.copy())
        vars(copied).update(self._attributes())
        return copied

    def __deepcopy__(self, memo: dict[int, Any]) -> Object:
        copied = memo[id(self)] = _object_of(type(self), self._native.copy())
        vars(copied).update(copy.deepcopy(self._attributes(), memo))
        return copied

    @property
    def name(self) -> str:
        """Its file name in reports, provenance and other files."""
        return self._native.name

    @name.setter
    def name(self, name: str) -> None:
        if not isinstance(name, str) or not name:
            raise UsageError("the name of an object is not a text", "", "give a file name")
        self._native.name = name

    def save(self, file: str | os.PathLike[str]) -> pathlib.Path:
        """Writes the object to a file; an incomplete file is never left."""
        self._native.save(os.fsencode(file))
        return pathlib.Path(os.fsdecode(file))

    def to_bytes(self) -> bytes:
        """The content of its file."""
        return self._native.bytes()

    def __repr__(self) -> str:
        return f"<ostraka.{type(self).__name__} {self.name!r}>"


def refuse_masks(name: str, value: Any) -> None:
    """Raises InputError for masked arrays, or lists of them, that have masked elements, since these have no value."""
    if isinstance(value, numpy.ma.MaskedArray):
        count = int(numpy.ma.count_masked(value)) if value.dtype.names is None else int(numpy.any(value.mask.tolist()))
        if count:
            raise InputError(f"is a masked array, and {count} of its {max(value.size, 1)} elements are masked", name,
                             "fill them (numpy.ma.filled), or leave them out")
    elif isinstance(value, (list, tuple)):
        for element in value:
            if isinstance(element, (list, tuple, numpy.ndarray)):
                refuse_masks(name, element)


def _numbers(name: str, value: Any, kind: str) -> numpy.ndarray:
    """Converts to an array of whole numbers ("integers") or numbers; raises InputError for other values."""
    try:
        refuse_masks(name, value)
        array = numpy.asanyarray(value)  # keeps the mask of objects that convert to masked arrays
        refuse_masks(name, array)
        array = numpy.asarray(array)
    except (ValueError, TypeError, RecursionError) as error:
        raise InputError(f"cannot be converted to an array: {error}", name, f"give {kind}") from None
    if array.size == 0 and array.dtype == numpy.float64:
        array = array.astype(numpy.int64) if kind == "integers" else array
    if array.dtype.kind not in ("iu" if kind == "integers" else "iuf"):
        raise InputError(f"is an array of {array.dtype}", name, f"give {kind}")
    return array


_extras = {
    "vertex_colours": numpy.uint8,
    "face_colours": numpy.uint8,
    "vertex_labels": numpy.int32,
    "face_labels": numpy.int32,
}


def _extra(name: str, value: Any) -> numpy.ndarray:
    array = _numbers(name, value, "integers")
    limits = numpy.iinfo(_extras[name])
    if array.size and (array.min() < limits.min or array.max() > limits.max):
        raise InputError(f"holds numbers that are not from {limits.min} to {limits.max}", name, "give numbers in this range")
    if name.endswith("colours") and array.ndim == 2 and array.shape[1] == 3:
        array = numpy.column_stack([array, numpy.full(len(array), 255)])
    if array.ndim != (2 if name.endswith("colours") else 1) or array.shape[1:] not in ((), (4,)):
        raise InputError(f"is an array of the shape {array.shape}", name,
                         "give red, green, blue (and alpha) per element" if name.endswith("colours")
                         else "give one number per element")
    return array.astype(_extras[name])


def _polygons(faces: Any) -> tuple[numpy.ndarray, numpy.ndarray]:
    """Begin of each polygon among the corners, and the corners, from an array or from lists of any lengths."""
    if not isinstance(faces, numpy.ndarray) and hasattr(faces, "__len__"):
        lengths = [len(face) if hasattr(face, "__len__") else 0 for face in faces]
        if len(set(lengths)) > 1:
            corners = [_numbers("faces", face, "integers") for face in faces]
            return numpy.cumsum([0, *lengths]), numpy.concatenate(corners).astype(numpy.int64)
    array = _numbers("faces", faces, "integers")
    if array.size == 0:
        return numpy.zeros(1, numpy.int64), numpy.zeros(0, numpy.int64)
    if array.ndim != 2 or array.shape[1] < 3:
        raise InputError(f"is an array of the shape {array.shape}", "faces", "give the three vertices of each triangle")
    if array.dtype == numpy.uint64 and array.max() > numpy.iinfo(numpy.int64).max:
        raise InputError("names vertices that do not exist", "faces", "count vertices from 0")
    return numpy.arange(0, array.size + 1, array.shape[1]), array.astype(numpy.int64, copy=False).reshape(-1)


def _padded_polygons(faces: Any) -> tuple[numpy.ndarray, numpy.ndarray]:
    """The same from a list in the form of VTK: each polygon is its number of corners, followed by the corners."""
    array = _numbers("faces", faces, "integers").astype(numpy.int64).reshape(-1)
    if array.size % 4 == 0 and (array[::4] == 3).all():
        return _polygons(array.reshape(-1, 4)[:, 1:])
    begins, position = [], 0
    while position < array.size and array[position] >= 0:
        begins.append(position)
        position += int(array[position]) + 1
    if position != array.size:
        raise InputError("is not a list of polygons", "faces", "give the number of corners before the corners of each")
    is_corner = numpy.ones(array.size, bool)
    is_corner[begins] = False
    return numpy.concatenate([[0], numpy.cumsum(array[begins])]).astype(numpy.int64), array[is_corner]


class Mesh(Object):
    """A mesh: from a file, from arrays, or from an object of trimesh or PyVista.

    Mesh("pot.ply")
    Mesh(points, faces)            # n x 3 numbers; m x 3 whole numbers, or lists of corners
    Mesh(trimesh_or_pyvista_mesh)  # anything with .vertices and .faces, or with .points and .faces

    Points and faces are copied once, by the constructor; `points` and the other properties are views of the toolkit's memory. A
    mesh is immutable.

    Parameters
    ----------
    source : a file, an object with a mesh, or the points
    faces : the faces, if points are given
    name : its file name; the extension determines the format in which it is saved for operations that read files
    vertex_colours, face_colours : red, green, blue (and alpha) per element, 0 to 255
    vertex_labels, face_labels : one whole number per element
    """

    _cached = ("_native", "_faces")
    _faces: numpy.ndarray | None = None

    def __init__(self, source: Any, faces: Any = None, *, name: str | None = None, **extras: Any) -> None:
        if isinstance(source, _ostraka.Object):
            super().__init__(source)
            return
        for extra in extras:
            if extra not in _extras:
                nearest = _ostraka.nearest_name(extra, list(_extras))
                raise UsageError(f"a mesh has no '{extra}'", "Mesh",
                                 f"did you mean '{nearest}'?" if nearest else "there are " + ", ".join(_extras))
        if _is_file_name(source):
            if faces is not None or extras:
                raise UsageError("a file and arrays are given", "Mesh", "give one of them")
            super().__init__(_ostraka.read_mesh(os.fsencode(source)))
            if name is not None:
                self.name = name
            return
        if faces is not None:
            begin, corners = _polygons(faces)
            points = source
        elif hasattr(source, "vertices") and hasattr(source, "faces"):  # trimesh
            points = source.vertices
            begin, corners = _polygons(source.faces)
        elif hasattr(source, "points") and hasattr(source, "faces"):  # PyVista
            points = source.points
            refuse_masks("faces", source.faces)
            shape = numpy.asarray(source.faces)
            begin, corners = _polygons(shape) if shape.ndim == 2 else _padded_polygons(shape)
        else:
            raise UsageError(f"a mesh cannot be made from {type(source).__name__}", "Mesh",
                             "give a file, points and faces, or an object of trimesh or PyVista")
        points = _numbers("points", points, "numbers")
        if points.size == 0:
            points = points.reshape(0, 3)
        if points.ndim != 2 or points.shape[1] != 3:
            raise InputError(f"is an array of the shape {points.shape}", "points", "give x, y, z per point")
        arrays = {key: _extra(key, value) for key, value in extras.items()}
        super().__init__(_ostraka.make_mesh(points, begin, corners, arrays, name or "mesh.ply"))

    @Object.name.setter  # type: ignore[attr-defined]
    def name(self, name: str) -> None:
        _ostraka.check_mesh_name(name)
        Object.name.fset(self, name)  # type: ignore[attr-defined]

    @property
    def points(self) -> numpy.ndarray:
        """Coordinates, n x 3, float64: a read-only view."""
        return self._native.points()

    @property
    def faces(self) -> numpy.ndarray:
        """The corners of the triangles, m x 3, uint32. For other polygons, see `polygons`."""
        if self._faces is None:
            begin, corners = self.polygons
            if (numpy.diff(begin) != 3).any():
                raise InputError("has polygons that are not triangles", self.name, "use polygons, or ostraka.mesh.convert")
            self._faces = corners.reshape(-1, 3)
        return self._faces

    @property
    def polygons(self) -> tuple[numpy.ndarray, numpy.ndarray]:
        """Begin of each polygon among the corners (with one more entry for the end), and the corners."""
        return self._native.polygons()

    @property
    def extras(self) -> dict[str, numpy.ndarray]:
        """Colours, labels and texture coordinates that exist, by name: read-only views."""
        return self._native.extras()

    @property
    def is_manifold(self) -> bool:
        """Whether it is an oriented manifold of triangles, with or without border. Other meshes can be repaired."""
        return self._native.is_manifold()

    def __repr__(self) -> str:
        faces = len(self.polygons[0]) - 1 if self._faces is None else len(self._faces)
        return f"<ostraka.Mesh {self.name!r}: {len(self.points)} vertices, {faces} faces>"


class Document(Object):
    """A JSON document, from a file or from dicts and lists."""

    _ending = ".json"
    _cached = ("_native", "_document")
    _document: Any = None

    def __init__(self, source: Any, *, name: str | None = None) -> None:
        if isinstance(source, _ostraka.Object):
            super().__init__(source)
        elif _is_file_name(source):
            super().__init__(_ostraka.read_bytes(os.fsencode(source)))
        elif isinstance(source, (Mapping, list, tuple)):
            file_name = name or "document" + self._ending
            try:
                text = json.dumps(source, allow_nan=False, default=_plain)
            except (ValueError, TypeError, RecursionError) as error:
                raise InputError(f"is not a JSON document: {error}", file_name, "use texts, numbers, dicts and lists") from None
            super().__init__(_ostraka.make_document(text, file_name))
        else:
            raise UsageError(f"a document cannot be made from {type(source).__name__}", type(self).__name__,
                             "give a file, a dict or a list")
        if name is not None:
            self.name = name

    @property
    def document(self) -> Any:
        """The document as dicts and lists. They are a copy; `type(self)(document)` makes a new object of a changed one."""
        try:
            return json.loads(self.to_bytes())
        except ValueError as error:
            raise InputError(f"is not a JSON document: {error}", self.name, "give another file") from None

    def _cached_document(self) -> Any:
        if self._document is None:
            self._document = self.document
        return self._document

    def __getitem__(self, key: Any) -> Any:
        return self._cached_document()[key]


class Annotations(Document):
    """Annotations of a mesh, each a dict as in the file (.ant.json). They can be counted, iterated, and found by id or tag."""

    _ending = ".ant.json"

    def _list(self) -> list[dict[str, Any]]:
        document = self._cached_document()
        entries = document.get("annotations") if isinstance(document, dict) else None
        if not isinstance(entries, list) or not all(isinstance(entry, dict) for entry in entries):
            raise InputError("contains no list of annotations", self.name, 'give {"annotations": [...]}')
        return entries

    def __len__(self) -> int:
        return len(self._list())

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return iter(self._list())

    def __getitem__(self, key: Any) -> Any:
        """The annotation with this id (a number) or tag (a text), or a member of the file."""
        for annotation in self._list():
            if annotation.get("id" if isinstance(key, int) else "tag") == key:
                return annotation
        document = self._cached_document()
        if key in document:
            return document[key]
        nearest = _ostraka.nearest_name(str(key), [str(tag) for tag in self.tags])
        raise KeyError(f"there is no annotation {key!r}" + (f"; did you mean {nearest!r}?" if nearest else ""))

    @property
    def tags(self) -> list[str]:
        return [annotation.get("tag", "") for annotation in self._list()]

    def faces(self, mesh: Any) -> dict[int, numpy.ndarray]:
        """The faces of each region on the mesh, by the id of the region."""
        return self._native.faces(as_mesh(mesh)._native)[0]

    def labels(self, mesh: Any) -> numpy.ndarray:
        """For each face of the mesh the id of the smallest region on it, -1 for none; the whole object is ignored."""
        return self._native.faces(as_mesh(mesh)._native)[1]


class Array(Object):
    """Numbers: one value per element, coordinates in a cage, or new indices of old elements (-1: removed)."""

    def __init__(self, source: Any, *, name: str | None = None) -> None:
        if isinstance(source, _ostraka.Object):
            super().__init__(source)
            return
        array = _numbers("values", source, "numbers")
        if array.ndim != 1:
            raise InputError(f"is an array of the shape {array.shape}", name or "values", "give one number per element")
        super().__init__(_ostraka.make_values(array, name or "values.npy"))

    @property
    def array(self) -> numpy.ndarray:
        """A read-only view."""
        return self._native.array()

    @property
    def normals(self) -> numpy.ndarray | None:
        """For Green coordinates, the weights of the normals."""
        return self._native.normals()

    def __array__(self, dtype: Any = None) -> numpy.ndarray:
        return self.array if dtype is None else self.array.astype(dtype)

    def __len__(self) -> int:
        return len(self.array)


class Bytes(Object):
    """The unchanged content of a file: a picture, a table, a text."""

    def __init__(self, source: Any, *, name: str | None = None) -> None:
        if isinstance(source, _ostraka.Object):
            super().__init__(source)
        elif isinstance(source, (bytes, bytearray, memoryview)):
            super().__init__(_ostraka.make_bytes(bytes(source), name or "bytes"))
        elif _is_file_name(source):
            super().__init__(_ostraka.read_bytes(os.fsencode(source)))
            if name is not None:
                self.name = name
        else:
            raise UsageError(f"bytes cannot be made from {type(source).__name__}", "Bytes", "give bytes or a file")

    @property
    def text(self) -> str:
        return self.to_bytes().decode(errors="replace")

    def _repr_png_(self) -> bytes | None:
        data = self.to_bytes()
        return data if data.startswith(b"\x89PNG") else None

    def _repr_svg_(self) -> str | None:
        return self.text if self.name.endswith(".svg") else None


class Folder(Object, Mapping):
    """The files of an output folder, by name."""

    _cached = ("_native", "_known_files")
    _known_files: dict[str, Bytes] | None = None

    def _files(self) -> dict[str, Bytes]:
        if self._known_files is None:
            self._known_files = {name: Bytes(native) for name, native in self._native.files().items()}
        return self._known_files

    def __getitem__(self, name: str) -> Bytes:
        return self._files()[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._files())

    def __len__(self) -> int:
        return len(self._files())

    __hash__ = object.__hash__
    __eq__ = object.__eq__

    def __repr__(self) -> str:
        return f"<ostraka.Folder: {', '.join(self)}>"


class Template(Object):
    """A template with its parts."""


_classes = {"mesh": Mesh, "annotations": Annotations, "document": Document, "array": Array, "folder": Folder, "bytes": Bytes}
for _class in (Object, Template, *_classes.values()):
    _class.__module__ = "ostraka"


def from_native(native: _ostraka.Object) -> Object:
    """Wraps an object of the native module in the class of its type."""
    return _classes.get(native.type, Template)(native)


def _object_of(kind: type[Object], native: _ostraka.Object) -> Any:
    """Makes an object of this class, or of a derived one, without calling its constructor."""
    wrapped = object.__new__(kind)
    wrapped._native = native
    return wrapped


_native_types = {Mesh: ("mesh",), Document: ("annotations", "document", "bytes"), Array: ("array",),
            Bytes: ("bytes",), Folder: ("folder",), Template: ("other",)}


def restored(kind: type[Object], state: bytes) -> Any:
    """Restores a pickled object. Raises InputError if the bytes are damaged, or hold an object of another class."""
    if not isinstance(kind, type) or not issubclass(kind, Object) or not isinstance(state, bytes):
        raise InputError("holds no object of this module", "pickle", "pickle the object again, or save it as a file")
    native = _ostraka.restore(state)
    types = next((types for base, types in _native_types.items() if issubclass(kind, base)), None)
    if types is not None and native.type not in types:
        raise InputError(f"holds an object of another class than {kind.__name__}", "pickle", "pickle the object again")
    return _object_of(kind, native)


def _plain(value: Any) -> Any:
    """Converts numbers and arrays of NumPy in a document."""
    refuse_masks("document", value)
    if hasattr(value, "tolist"):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} cannot be written")


def as_mesh(value: Any, name: str | None = None) -> Mesh:
    return value if isinstance(value, Mesh) else Mesh(value, name=name)


def as_given(value: Any, kind: str, name: str, called: str) -> Any:
    """Converts a value given for an input of this kind: to the bytes of a file name, or to an object of the native module."""
    if isinstance(value, Object):
        return value._native
    if isinstance(value, (str, os.PathLike)):
        return os.fsencode(value)
    if kind in ("mesh", "cage") and not isinstance(value, (bytes, bytearray, memoryview)):
        return Mesh(value, name=called)._native
    if isinstance(value, (bytes, bytearray, memoryview)):
        return Bytes(value, name=called)._native
    if isinstance(value, Mapping):
        return Document(value, name=called)._native
    is_list = isinstance(value, (list, tuple))
    if is_list and not (kind == "values" or value and all(isinstance(number, (int, float)) for number in value)):
        return Document(value, name=called)._native
    if is_list or hasattr(value, "__array__"):
        array = _numbers(name, value, "numbers")
        if kind != "values" and array.dtype.kind in "iu" and array.ndim == 1:
            return Bytes("".join(f"{number}\n" for number in array.tolist()).encode(), name=name + ".txt")._native
        return Array(array, name=called)._native
    raise UsageError(f"{name} is of the type {type(value).__name__}", "", "give a file, or an object in memory")

"""Objects, reports and results are pickled and copied: what comes back is the same to the bit, or refused."""

import copy
import multiprocessing
import pickle
import pickletools
import random

import numpy
import pytest

import ostraka
from ostraka import _objects

PROTOCOLS = range(2, pickle.HIGHEST_PROTOCOL + 1)
WAYS = {
    "pickle": lambda value: pickle.loads(pickle.dumps(value)),
    "copy": copy.copy,
    "deepcopy": copy.deepcopy,
}


def annotated_pot(data):
    pot = ostraka.Mesh(data / "teapot.ply")
    return pot, ostraka.annotation.transfer(pot, data / "teapot.ant.json", pot).output


def coordinates(data, kind):
    pot = ostraka.mesh.make("teapot", True, vertices=2500).output
    cage = ostraka.cage.make(pot, vertices=60).output
    return ostraka.cage.weights(pot, cage, kind=kind).output


def two_regions(data):
    pot, annotations = annotated_pot(data)
    return ostraka.relation.extract(pot, annotations).output


def template(data):
    pot, annotations = annotated_pot(data)
    graph = ostraka.relation.extract(pot, annotations).output
    return ostraka.template.pack(mesh=pot, annotations=annotations, graph=graph).output


POINTS = numpy.array([[0.0, 0, 0], [1 / 3, 0, 0], [0, -0.0, 1e-300], [0, 0, numpy.pi]])
FACES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
OBJECTS = {
    "mesh of a file": lambda data: ostraka.Mesh(data / "teapot.ply"),
    "mesh of arrays": lambda data: ostraka.Mesh(POINTS, FACES, name="tetra.obj", vertex_colours=[[1, 2, 3]] * 4,
                                                face_labels=[4, 3, 2, -1]),
    "mesh of an operation": lambda data: ostraka.mesh.refine(data / "teapot.ply", vertices=5000).output,
    "mesh called .glb": lambda data: ostraka.mesh.convert(data / "teapot.ply", "memory:pot.glb").output,
    "polygons": lambda data: ostraka.Mesh(numpy.vstack([POINTS, [[1, 1, 0]]]), [[0, 1, 4, 2], [0, 1, 3]]),
    "no mesh": lambda data: ostraka.Mesh([], []),
    "annotations of a file": lambda data: ostraka.Annotations(data / "teapot.ant.json"),
    "annotations of an operation": lambda data: annotated_pot(data)[1],
    "annotations of a dict": lambda data: ostraka.Annotations({"annotations": []}, name="none.ant.json"),
    "document": lambda data: ostraka.Document({"a": [1, 2.5, "ü\n"], "b": {"c": None}, "d": 2**60, "e": 0.1}),
    "graph": two_regions,
    "index map": lambda data: ostraka.mesh.convert(data / "teapot.ply", map=True).map,
    "values": lambda data: ostraka.measure.map(data / "teapot.ply", of="mean-curvature").output,
    "array": lambda data: ostraka.Array([0.1, -0.0, numpy.nan, numpy.inf], name="four.npy"),
    "no values": lambda data: ostraka.Array([]),
    "mean value coordinates": lambda data: coordinates(data, "mean-value"),
    "Green coordinates": lambda data: coordinates(data, "green"),
    "harmonic coordinates": lambda data: coordinates(data, "harmonic"),
    "picture": lambda data: ostraka.render(data / "teapot.ply", size="80x60").picture,
    "bytes": lambda data: ostraka.Bytes(bytes(range(256)), name="all ü.bin"),
    "folder": lambda data: ostraka.slice(data / "teapot.ply", count=3, output=True).output,
    "template": template,
}


CACHED = {}


def made_once(name, data):
    if name not in CACHED:
        CACHED[name] = OBJECTS[name](data)
    return CACHED[name]


def parts_of(value):
    """All that is seen of an object, to the bit."""
    parts = {"type": type(value), "name": value.name, "vars": {key: entry for key, entry in vars(value).items() if key[0] != "_"}}
    if isinstance(value, ostraka.Mesh):
        parts["points"] = value.points.tobytes()
        parts["polygons"] = [array.tobytes() for array in value.polygons]
        parts["extras"] = {name: (array.dtype, array.shape, array.tobytes()) for name, array in value.extras.items()}
        parts["manifold"] = value.is_manifold
    if isinstance(value, ostraka.Array):
        parts["array"] = (value.array.dtype, value.array.shape, value.array.tobytes())
        parts["normals"] = None if value.normals is None else value.normals.tobytes()
    if isinstance(value, ostraka.Document):
        parts["document"] = value.document
    if isinstance(value, ostraka.Folder):
        parts["files"] = {name: one.to_bytes() for name, one in value.items()}
    return parts


def files_of(value, folder):
    """What it is saved as, under its own name and under others."""
    folder.mkdir()
    if isinstance(value, ostraka.Mesh):
        if len(value.points):
            for ending in ("ply", "obj", "off", "stl", "glb"):
                value.save(folder / f"saved.{ending}")
    elif isinstance(value, ostraka.Template):
        value.save(folder / "saved.template.json")
    elif isinstance(value, ostraka.Array):
        value.save(folder / "saved.npy")
    else:
        value.save(folder / "saved")
    is_empty = isinstance(value, ostraka.Mesh) and len(value.points) == 0
    if not isinstance(value, (ostraka.Folder, ostraka.Template)) and not is_empty:
        (folder / "bytes").write_bytes(value.to_bytes())
    return {str(file.relative_to(folder)): file.read_bytes() for file in sorted(folder.rglob("*")) if file.is_file()}


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", OBJECTS)
def test_objects_come_back_as_they_were(name, way, data, tmp_path):
    value = made_once(name, data)
    value.mine = ["an attribute"]
    again = WAYS[way](value)
    assert again is not value and parts_of(again) == parts_of(value)
    assert files_of(again, tmp_path / "again") == files_of(value, tmp_path / "before")
    twice = WAYS[way](again)
    assert files_of(twice, tmp_path / "twice") == files_of(value, tmp_path / "once more")


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_every_protocol(protocol, data):
    pot = OBJECTS["mesh of arrays"](data)
    assert parts_of(pickle.loads(pickle.dumps(pot, protocol))) == parts_of(pot)


def test_operations_give_the_same_for_what_was_pickled(data):
    """The same reports, checksums of inputs and outputs; also on a mesh that the annotations were not made for."""
    pot, annotations = annotated_pot(data)
    graph = ostraka.relation.extract(pot, annotations).output
    moved = ostraka.Mesh(pot.points * 2, pot.faces)
    packed = ostraka.template.pack(mesh=pot, annotations=annotations, graph=graph).output
    cage = ostraka.cage.make(pot, vertices=100).output
    weights = ostraka.cage.weights(pot, cage).output
    edit = data / "teapot-stretch.edit.json"
    for work in (lambda keep: ostraka.annotation.list(keep(pot), keep(annotations)),
                 lambda keep: ostraka.annotation.list(keep(moved), keep(annotations)),
                 lambda keep: ostraka.relation.check(keep(pot), keep(annotations), keep(graph)),
                 lambda keep: ostraka.deform(keep(pot), keep(annotations), edit, cage=keep(cage), weights=keep(weights)),
                 lambda keep: ostraka.template.show(keep(packed)),
                 lambda keep: ostraka.template.check(keep(packed))):
        before, after = work(lambda value: value), work(WAYS["pickle"])
        first, second = before.report.to_dict(), after.report.to_dict()
        first.pop("run", None), second.pop("run", None)
        assert first == second and repr(before.report) == repr(after.report)
        for name, value in before.outputs.items():
            if value is not None:
                assert after[name].to_bytes() == value.to_bytes()


def test_copies_share_memory_but_no_name(data):
    pot = ostraka.Mesh(data / "teapot.ply")
    for way in ("copy", "deepcopy"):
        again = WAYS[way](pot)
        assert numpy.shares_memory(again.points, pot.points)
        again.name = "other.ply"
        assert pot.name == str(data / "teapot.ply")
    annotations = ostraka.Annotations(data / "teapot.ant.json")
    annotations["spout"]["tag"] = "changed by hand"
    assert "spout" in copy.deepcopy(annotations).tags and "spout" in copy.copy(annotations).tags
    pair = copy.deepcopy([pot, pot, {"pot": pot}])
    assert pair[0] is pair[1] is pair[2]["pot"] and pair[0] is not pot


class MyMesh(ostraka.Mesh):
    """A class of a user's own, whose constructor takes something else."""

    def __init__(self, size):
        super().__init__(POINTS * size, FACES)
        self.size = size


@pytest.mark.parametrize("way", WAYS)
def test_classes_of_users(way):
    again = WAYS[way](MyMesh(3))
    assert type(again) is MyMesh and again.size == 3 and again.points.tobytes() == (POINTS * 3).tobytes()


@pytest.mark.parametrize("way", WAYS)
def test_results_and_reports(way, data):
    made = ostraka.annotation.transfer(data / "teapot.ply", data / "teapot.ant.json", data / "teapot.ply")
    again = WAYS[way](made)
    assert repr(again) == repr(made) and again.holds == made.holds and again.report.to_dict() == made.report.to_dict()
    assert again.report.to_csv() == made.report.to_csv() and again.report._repr_markdown_() == made.report._repr_markdown_()
    assert again.output is again["output"] and again.output.to_bytes() == made.output.to_bytes()
    for name, table in made.report.tables.items():
        for other in (again.report.tables[name], WAYS[way](table)):
            assert other.rows == table.rows and other.units == table.units and other.to_csv() == table.to_csv()
    assert not WAYS[way](ostraka.mesh.info(ostraka.Mesh(POINTS[:3], [[0, 1, 2]]))).holds


def of_another_process(pot):
    made = ostraka.mesh.refine(pot, vertices=5000)
    return made.output, made.report.to_dict()["provenance"], len(pot.points)


@pytest.mark.parametrize("method", ["spawn", "forkserver", "fork"])
def test_objects_go_to_other_processes_and_back(method, data):
    pot = ostraka.Mesh(data / "teapot.ply")
    made = ostraka.mesh.refine(pot, vertices=5000)
    with multiprocessing.get_context(method).Pool(2) as pool:
        for output, provenance, count in pool.map(of_another_process, [pot, copy.copy(pot)]):
            assert output.to_bytes() == made.output.to_bytes() and provenance == made.report.provenance and count == 4000
        [info] = pool.map(ostraka.mesh.info, [pot])  # a function of the module
        assert repr(info) == repr(ostraka.mesh.info(pot))


# ---- damage ----

@pytest.mark.parametrize("name", OBJECTS)
def test_damaged_pickles_are_refused(name, data):
    """Bytes changed, cut off and repeated at random places: an error in words, or the object as it was; never another one."""
    chance = random.Random(name)
    value = made_once(name, data)
    whole = value._native.state()
    expected = parts_of(value)
    for damage in range(20):
        state = bytearray(whole)
        at = chance.choice([chance.randrange(len(state)), chance.randrange(min(200, len(state)))])
        if damage % 4 == 0:
            del state[at:]
        elif damage % 4 == 1:
            state[at:at] = state[:chance.randrange(1, 50)]
        else:
            state[at] ^= 1 << chance.randrange(8)
        with pytest.raises(ostraka.InputError, match="pickle"):
            _objects.restored(type(value), bytes(state))
    assert parts_of(_objects.restored(type(value), whole)) | {"vars": {}} == expected | {"vars": {}}


def signed(state):
    """With the checksum of what it holds now: what is behind the checksum is examined too."""
    import hashlib

    return bytes(state) + hashlib.sha256(bytes(state)).hexdigest().encode()


@pytest.mark.parametrize("name", OBJECTS)
def test_forged_pickles_do_no_harm(name, data):
    """Damage with a checksum that fits is refused, or makes an object that can be used: nothing crashes."""
    chance = random.Random(name)
    value = made_once(name, data)
    whole = value._native.state()[:-64]
    for _ in range(25):
        state = bytearray(whole)
        for _ in range(chance.randrange(1, 4)):
            at = chance.choice([chance.randrange(len(state)), chance.randrange(min(300, len(state)))])
            state[at] = chance.choice([0, 1, 255, 128, chance.randrange(256)])
        if chance.random() < 0.2:
            del state[chance.randrange(len(state)):]
        try:
            made = _objects.restored(type(value), signed(state))
            parts_of(made)
            if not isinstance(made, (ostraka.Folder, ostraka.Template)):
                made.to_bytes()
            if isinstance(made, ostraka.Mesh):
                ostraka.mesh.convert(made)
        except (ostraka.Error, UnicodeError, ValueError):
            pass


def test_pickles_of_another_class_or_version_are_refused(data):
    state = OBJECTS["array"](data)._native.state()
    with pytest.raises(ostraka.InputError, match="another class"):
        _objects.restored(ostraka.Mesh, state)
    with pytest.raises(ostraka.InputError, match="not an object of this version"):
        _objects.restored(ostraka.Array, state.replace(b"ostraka object 4", b"ostraka object 5", 1))
    for wrong in ((int, state), (ostraka.Array, "text"), (ostraka.Array, b""), (None, None)):
        with pytest.raises(ostraka.InputError):
            _objects.restored(*wrong)


def test_damaged_reports_are_refused(data):
    report = ostraka.mesh.info(data / "teapot.ply").report
    function, (texts, layout, holds, digest) = report.__reduce__()
    for wrong in (({**texts, "json": texts["json"].replace("4000", "4001")}, layout, holds, digest),
                  (texts, layout, not holds, digest), ({}, layout, holds, digest), (texts, None, holds, digest),
                  (None, layout, holds, digest), (texts, layout + b" ", holds, digest)):
        with pytest.raises(ostraka.InputError, match="damaged"):
            function(*wrong)


def test_pickles_name_this_module_only(data):
    """What a pickle of an object calls when it is read."""
    for value in (OBJECTS["mesh of arrays"](data), ostraka.mesh.info(data / "teapot.ply").report):
        names = [one for code, one, _ in pickletools.genops(pickle.dumps(value)) if code.name == "SHORT_BINUNICODE"]
        assert "restored" in names or "restored_report" in names


def test_what_cannot_be_pickled_says_so():
    with pytest.raises(TypeError, match="cannot pickle"):
        pickle.dumps(ostraka.Array([1.0])._native)

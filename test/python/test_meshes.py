"""Meshes from and to arrays, files and the objects of others."""

import gc

import numpy
import pytest

import ostraka


def test_points_are_handed_over_without_a_copy(teapot):
    first, second = teapot.points, teapot.points
    assert first.shape == (4000, 3) and first.dtype == numpy.float64 and first.flags.c_contiguous
    assert numpy.shares_memory(first, second) and not first.flags.owndata
    assert first.__array_interface__["data"] == second.__array_interface__["data"]


def test_a_million_points_are_handed_over_without_a_copy():
    side = 1000
    x, y = numpy.meshgrid(numpy.arange(side, dtype=float), numpy.arange(side, dtype=float))
    points = numpy.column_stack([x.ravel(), y.ravel(), numpy.zeros(side * side)])
    corner = (numpy.arange(side - 1)[:, None] * side + numpy.arange(side - 1)).ravel()
    faces = numpy.concatenate([numpy.column_stack([corner, corner + 1, corner + side]),
                               numpy.column_stack([corner + 1, corner + side + 1, corner + side])])
    mesh = ostraka.Mesh(points, faces)
    assert mesh.is_manifold and len(mesh.points) == 1_000_000
    assert numpy.shares_memory(mesh.points, mesh.points)
    assert numpy.array_equal(mesh.points, points) and numpy.array_equal(mesh.faces, faces)


def test_views_keep_the_mesh_alive(data):
    points = ostraka.Mesh(data / "teapot.ply").points
    gc.collect()
    assert numpy.isfinite(points).all()


def test_views_cannot_be_written_to(teapot):
    for array in (teapot.points, teapot.faces, *teapot.polygons, *teapot.extras.values()):
        with pytest.raises(ValueError):
            array[0] = 0
        with pytest.raises(ValueError):
            array.setflags(write=True)


def test_outputs_share_memory_too(teapot):
    fine = ostraka.mesh.refine(teapot, vertices=5000).output
    assert numpy.shares_memory(fine.points, fine.points) and len(fine.points) == 5000


def test_arrays_come_back_as_they_were_given(tetrahedron):
    points, faces = tetrahedron
    colours = numpy.array([[255, 0, 0], [0, 255, 0], [0, 0, 255], [1, 2, 3]])
    mesh = ostraka.Mesh(points, faces, vertex_colours=colours, face_labels=[3, 2, 1, -1])
    assert mesh.is_manifold
    assert numpy.array_equal(mesh.points, points) and numpy.array_equal(mesh.faces, faces)
    assert numpy.array_equal(mesh.extras["vertex_colours"][:, :3], colours)
    assert (mesh.extras["vertex_colours"][:, 3] == 255).all()
    assert mesh.extras["face_labels"].tolist() == [3, 2, 1, -1] and set(mesh.extras) == {"vertex_colours", "face_labels"}
    points[0] = 7
    assert mesh.points[0].tolist() == [0, 0, 0]


@pytest.mark.parametrize("dtype", ["f4", "f8", ">f8", "i4"])
@pytest.mark.parametrize("order", ["C", "F"])
def test_any_layout_of_numbers_is_taken(tetrahedron, dtype, order):
    points = numpy.asarray(tetrahedron[0], dtype=dtype, order=order)
    faces = numpy.asarray(tetrahedron[1], dtype="u2", order=order)
    for given in (points, points[::1], points.tolist()):
        assert numpy.array_equal(ostraka.Mesh(given, faces).points, tetrahedron[0])
    every_second = numpy.repeat(points, 2, axis=0)[::2]
    assert numpy.array_equal(ostraka.Mesh(every_second, faces).points, tetrahedron[0])


def test_a_file_is_read_as_it_stands(data, tmp_path, tetrahedron):
    mesh = ostraka.Mesh(data / "teapot.ply")
    assert mesh.name == str(data / "teapot.ply") and "face_labels" in mesh.extras
    quads = tmp_path / "quads.obj"
    quads.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nf 1 2 3 4\nf 2 5 3\n")
    mesh = ostraka.Mesh(quads)
    assert mesh.polygons[0].tolist() == [0, 4, 7] and not mesh.is_manifold
    with pytest.raises(ostraka.InputError, match="not triangles"):
        mesh.faces
    assert len(ostraka.mesh.convert(mesh).output.faces) == 3


def test_polygons_of_several_lengths(tetrahedron):
    points = numpy.vstack([tetrahedron[0], [[1, 1, 0]]])
    mesh = ostraka.Mesh(points, [[0, 1, 4, 2], [0, 1, 3]])
    assert mesh.polygons[0].tolist() == [0, 4, 7]
    assert ostraka.mesh.info(mesh).report["polygons"] == 2


class Trimesh:
    """As trimesh.Trimesh."""

    def __init__(self, points, faces):
        self.vertices, self.faces = points, faces


class PolyData:
    """As pyvista.PolyData: faces is one list, with the number of corners before them."""

    def __init__(self, points, faces):
        self.points, self.faces = points.astype(numpy.float32), faces


def test_trimesh_is_taken(tetrahedron):
    mesh = ostraka.Mesh(Trimesh(*tetrahedron))
    assert numpy.array_equal(mesh.faces, tetrahedron[1])
    assert ostraka.mesh.info(Trimesh(*tetrahedron)).holds


def test_pyvista_is_taken(tetrahedron):
    points, faces = tetrahedron
    padded = numpy.column_stack([numpy.full(4, 3), faces]).ravel()
    assert numpy.array_equal(ostraka.Mesh(PolyData(points, padded)).faces, faces)
    assert ostraka.mesh.info(PolyData(points, padded)).holds
    mixed = ostraka.Mesh(PolyData(points, numpy.array([4, 0, 1, 2, 3, 3, 0, 1, 2])))
    assert mixed.polygons[0].tolist() == [0, 4, 7] and mixed.polygons[1].tolist() == [0, 1, 2, 3, 0, 1, 2]
    for wrong in ([3, 0, 1], [-1, 0, 1], [9]):
        with pytest.raises(ostraka.InputError):
            ostraka.Mesh(PolyData(points, numpy.array(wrong)))


@pytest.mark.parametrize("points, faces, problem", [
    ([[0, 0, 0], [1, 0, 0], [0, numpy.nan, 0]], [[0, 1, 2]], "point 2 is not finite"),
    ([[0, 0, 0], [1, 0, 0], [0, numpy.inf, 0]], [[0, 1, 2]], "point 2 is not finite"),
    ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 1, 3]], "face 1 names vertex 3"),
    ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, -1]], "face 0 names vertex -1"),
    ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], numpy.array([[0, 1, 2**64 - 1]], dtype="u8"), "do not exist"),
    ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0.0, 1.0, 2.0]], "array of float64"),
    ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1]], "shape"),
    ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [0, 1, 2], "shape"),
    ([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]], "shape"),
    ([[0, 0, 0], [1, 0, 0], [0, 1]], [[0, 1, 2]], "cannot be converted"),
    ([[0, 0, "a"], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], "array of"),
    ([[0, 0, 1j], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], "array of"),
    ([[True, 0, None], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], "array of"),
])
def test_bad_arrays_are_refused(points, faces, problem):
    with pytest.raises(ostraka.InputError, match=problem) as refused:
        ostraka.Mesh(points, faces)
    assert refused.value.where in ("points", "faces") and refused.value.remedy


@pytest.mark.parametrize("extras", [
    {"face_labels": [1, 2]}, {"face_labels": [1.5] * 4}, {"face_labels": [2**40] * 4}, {"vertex_colours": [[256, 0, 0]] * 4},
    {"vertex_colours": [[0, 0]] * 4}, {"vertex_colours": [1, 2, 3, 4]}, {"face_labels": [[1], [2], [3], [4]]},
    {"face_labels": "abcd"},
])
def test_bad_extras_are_refused(tetrahedron, extras):
    with pytest.raises(ostraka.InputError):
        ostraka.Mesh(*tetrahedron, **extras)


def test_what_is_no_mesh_is_refused(tetrahedron, data):
    for wrong in (3, None, object(), tetrahedron[0]):
        with pytest.raises(ostraka.UsageError):
            ostraka.Mesh(wrong)
    with pytest.raises(ostraka.UsageError, match="a file and arrays are given"):
        ostraka.Mesh(data / "teapot.ply", tetrahedron[1])
    with pytest.raises(ostraka.UsageError, match="did you mean 'face_labels'"):
        ostraka.Mesh(*tetrahedron, face_label=[1, 2, 3, 4])
    with pytest.raises(ostraka.UsageError, match="extension"):
        ostraka.Mesh(*tetrahedron, name="pot")
    with pytest.raises(ostraka.InputError, match="cannot be opened"):
        ostraka.Mesh("nowhere.ply")


@pytest.mark.parametrize("points, faces", [
    (numpy.zeros((0, 3)), numpy.zeros((0, 3), int)), ([], []), ([[0, 0, 0], [1, 0, 0]], []),
    ([[0, 0, 0]] * 3, [[0, 1, 2]]), (numpy.eye(3), [[0, 1, 1]]), (numpy.eye(3) * 1e300, [[0, 1, 2]]),
    (numpy.eye(3), [[0, 1, 2], [0, 1, 2], [0, 1, 2]]),
])
def test_degenerate_meshes_are_answered_in_words(points, faces):
    """No operation on a single mesh crashes; where it cannot work, it says why."""
    mesh = ostraka.Mesh(points, faces)
    if len(faces) < 3:
        assert not mesh.is_manifold and len(mesh.points) == len(points)
    else:  # cut where more than two triangles meet at an edge
        assert mesh.is_manifold and len(mesh.points) > len(points) and len(mesh.faces) == len(faces)
    for operation, options in ((ostraka.mesh.info, {}), (ostraka.mesh.repair, {}), (ostraka.mesh.convert, {}),
                               (ostraka.mesh.refine, {"vertices": 100}), (ostraka.mesh.simplify, {"vertices": 3}),
                               (ostraka.axis, {}), (ostraka.slice, {}), (ostraka.cage.make, {}), (ostraka.render, {}),
                               (ostraka.measure.map, {"of": "thickness"}), (ostraka.annotation.segment, {})):
        try:
            assert isinstance(operation(mesh, **options), ostraka.Result)
        except ostraka.Error as error:
            assert error.kind == "input" and error.where and error.problem


def test_one_triangle():
    mesh = ostraka.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    assert mesh.is_manifold
    assert not ostraka.mesh.info(mesh).holds  # it is open
    assert len(ostraka.mesh.refine(mesh, vertices=100).output.points) == 100


def test_a_mesh_is_saved(tetrahedron, tmp_path):
    mesh = ostraka.Mesh(*tetrahedron, name="tetra.ply")
    for ending in ("ply", "obj", "off", "stl"):
        saved = mesh.save(tmp_path / f"tetra.{ending}")
        assert len(ostraka.Mesh(saved).faces) == 4
    with pytest.raises(ostraka.UsageError):
        mesh.save(tmp_path / "tetra.txt")
    with pytest.raises(ostraka.WorkError):
        mesh.save(tmp_path / "no folder" / "tetra.ply")
    assert sorted(file.name for file in tmp_path.iterdir()) == ["tetra.obj", "tetra.off", "tetra.ply", "tetra.stl"]

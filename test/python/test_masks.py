"""Masked arrays: a masked element has no value, and is refused wherever arrays are taken."""

import numpy
import pytest

import ostraka

MASKED = numpy.ma.masked


def with_mask(array, *places):
    array = numpy.ma.array(array, mask=False)
    for place in places:
        array[place] = MASKED
    return array


class Lazy:
    """Makes itself a masked array when asked."""

    def __init__(self, array):
        self.array = array

    def __array__(self, dtype=None):
        return self.array


def refused(work, where):
    with pytest.raises(ostraka.InputError, match="masked") as error:
        work()
    assert error.value.where == where and "fill" in error.value.remedy


def test_meshes(tetrahedron):
    points, faces = tetrahedron
    refused(lambda: ostraka.Mesh(with_mask(points, (1, 2)), faces), "points")
    refused(lambda: ostraka.Mesh(points, with_mask(faces, (3, 0))), "faces")
    refused(lambda: ostraka.Mesh([with_mask(points[0], 1), *points[1:]], faces), "points")
    refused(lambda: ostraka.Mesh([[0, 0, MASKED], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]), "points")
    refused(lambda: ostraka.Mesh(points, [with_mask([0, 1, 2], 0), [0, 1, 2, 3]]), "faces")
    refused(lambda: ostraka.Mesh(Lazy(with_mask(points, (0, 0))), faces), "points")
    refused(lambda: ostraka.Mesh(points, faces, face_labels=with_mask([1, 2, 3, 4], 2)), "face_labels")
    refused(lambda: ostraka.Mesh(points, faces, vertex_colours=with_mask([[1, 2, 3]] * 4, (0, 1))), "vertex_colours")

    class Shape:
        vertices = with_mask(points, (0, 0))

    Shape.faces = faces
    refused(lambda: ostraka.mesh.info(Shape()), "points")
    Shape.points, Shape.faces = points, with_mask(numpy.column_stack([numpy.full(4, 3), faces]).ravel(), 5)
    del Shape.vertices
    refused(lambda: ostraka.mesh.info(Shape()), "faces")


def test_values_and_labels(teapot, data):
    heights = with_mask(teapot.points[:, 2], 7)
    refused(lambda: ostraka.Array(heights), "values")
    refused(lambda: ostraka.Array([1.0, MASKED]), "values")
    refused(lambda: ostraka.measure.describe(teapot, annotations=data / "teapot.ant.json", map={"height": heights}, output=True),
            "map")
    refused(lambda: ostraka.annotation.apply(teapot, with_mask(numpy.zeros(8000, int), 5)), "recipe")


def test_options_and_documents(teapot, data):
    refused(lambda: ostraka.annotation.transfer(teapot, data / "teapot.ant.json", teapot, max_angle=MASKED), "max_angle")
    refused(lambda: ostraka.measure.take(teapot, annotations=data / "teapot.ant.json", tool="tape",
                                         at=[with_mask([0.0, -59, 50], 1), (0, -35, 95)], annotation="body", name="belly"), "at")
    refused(lambda: ostraka.Document({"a": [1, {"b": with_mask([1, 2], 0)}]}), "document")
    refused(lambda: ostraka.Document([1, MASKED]), "document")


def test_without_masked_elements_they_are_plain_arrays(tetrahedron, teapot):
    points, faces = (with_mask(array) for array in tetrahedron)
    mesh = ostraka.Mesh(points, faces, face_labels=with_mask([1, 2, 3, 4]))
    assert numpy.array_equal(mesh.points, tetrahedron[0]) and numpy.array_equal(mesh.faces, tetrahedron[1])
    assert not isinstance(mesh.points, numpy.ma.MaskedArray)
    assert mesh.extras["face_labels"].tolist() == [1, 2, 3, 4]
    assert ostraka.Array(with_mask([1.0, 2.0])).array.tolist() == [1, 2]
    assert ostraka.Array(numpy.ma.array([1.0, 2.0], mask=numpy.ma.nomask)).array.tolist() == [1, 2]
    assert ostraka.Document({"a": with_mask([1, 2])}).document == {"a": [1, 2]}
    assert ostraka.Mesh(Lazy(points), faces).is_manifold

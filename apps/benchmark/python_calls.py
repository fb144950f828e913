"""What a call from Python costs beside its work: python3 apps/benchmark/python_calls.py, with the module on PYTHONPATH."""

import statistics
import time

import numpy

import ostraka


def measure(title, work, repeats=200):
    work()
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        work()
        times.append(1e6 * (time.perf_counter() - begin))
    print(f"{title:48} {statistics.median(times):10.1f} us")


def grid(side):
    x, y = numpy.meshgrid(numpy.arange(side, dtype=float), numpy.arange(side, dtype=float))
    corner = (numpy.arange(side - 1)[:, None] * side + numpy.arange(side - 1)).ravel()
    faces = numpy.concatenate([numpy.column_stack([corner, corner + 1, corner + side]),
                               numpy.column_stack([corner + 1, corner + side + 1, corner + side])])
    return numpy.column_stack([x.ravel(), y.ravel(), numpy.zeros(side * side)]), faces


triangle = ostraka.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
points, faces = grid(1000)
million = ostraka.Mesh(points, faces)
measure("mesh.convert of one triangle", lambda: ostraka.mesh.convert(triangle))
measure("Mesh of one triangle", lambda: ostraka.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))
measure("points of 1M vertices", lambda: million.points)
measure("Mesh of 1M vertices from arrays", lambda: ostraka.Mesh(points, faces), 3)
print("a view, without a copy:", numpy.shares_memory(million.points, million.points))

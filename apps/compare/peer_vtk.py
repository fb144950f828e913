"""The same work by VTK, one task a process: python3 peer_vtk.py TASK ARGUMENTS... prints what it took and what came out."""
import json
import sys
import time

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import mutable
from vtkmodules.vtkCommonDataModel import vtkMeanValueCoordinatesInterpolator, vtkPlane, vtkStaticCellLocator
from vtkmodules.vtkFiltersCore import vtkCutter, vtkQuadricDecimation
from vtkmodules.vtkFiltersModeling import vtkHausdorffDistancePointSetFilter
from vtkmodules.vtkIOPLY import vtkPLYReader, vtkPLYWriter

last = time.perf_counter()


def lap():
    global last
    now = time.perf_counter()
    seconds, last = now - last, now
    return seconds


def read(file):
    reader = vtkPLYReader()
    reader.SetFileName(file)
    reader.Update()
    return reader.GetOutput()


def write(file, mesh):
    writer = vtkPLYWriter()
    writer.SetFileName(file)
    writer.SetInputData(mesh)
    writer.SetFileTypeToBinary()
    writer.Write()


def convert(source, target):
    write(target, read(source))
    return {"work": lap()}


def slices(source, count):
    mesh = read(source)
    figures = {"read": lap()}
    low, high = mesh.GetBounds()[4:6]
    plane = vtkPlane()
    plane.SetNormal(0, 0, 1)
    plane.SetOrigin(0, 0, low)
    cutter = vtkCutter()
    cutter.SetInputData(mesh)
    cutter.SetCutFunction(plane)
    for i in range(int(count)):
        cutter.SetValue(i, (high - low) * (i + 0.5) / int(count))
    cutter.Update()
    lines = cutter.GetOutput()
    points = vtk_to_numpy(lines.GetPoints().GetData()).astype(float)
    ends = vtk_to_numpy(lines.GetLines().GetConnectivityArray()).reshape(-1, 2)
    length = numpy.linalg.norm(points[ends[:, 0]] - points[ends[:, 1]], axis=1).sum()
    return figures | {"work": lap(), "length": float(length)}


def simplify(source, target, vertices):
    mesh = read(source)
    figures = {"read": lap()}
    decimation = vtkQuadricDecimation()
    decimation.SetInputData(mesh)
    decimation.SetTargetReduction(1 - int(vertices) / mesh.GetNumberOfPoints())
    decimation.Update()
    figures |= {"work": lap()}
    write(target, decimation.GetOutput())
    return figures


def locator_of(mesh):
    locator = vtkStaticCellLocator()
    locator.SetDataSet(mesh)
    locator.BuildLocator()
    return locator


def nearest(locator, points):
    """Index of the nearest cell and the distance, one call a point: VTK has no call for many."""
    cell, part, squared, place = mutable(0), mutable(0), mutable(0.0), [0.0, 0.0, 0.0]
    cells, distances = numpy.empty(len(points), int), numpy.empty(len(points))
    for i, point in enumerate(points):
        locator.FindClosestPoint(point, place, cell, part, squared)
        cells[i], distances[i] = cell.get(), squared.get()
    return cells, numpy.sqrt(distances)


def closest(source, other):
    mesh, points = read(source), vtk_to_numpy(read(other).GetPoints().GetData()).astype(float)
    figures = {"read": lap()}
    locator = locator_of(mesh)
    figures |= {"build": lap()}
    _, distances = nearest(locator, points)
    return figures | {"work": lap(), "mean": float(distances.mean()), "maximum": float(distances.max())}


def hausdorff(source, other):
    a, b = read(source), read(other)
    figures = {"read": lap()}
    hausdorff_filter = vtkHausdorffDistancePointSetFilter()
    hausdorff_filter.SetInputData(0, a)
    hausdorff_filter.SetInputData(1, b)
    hausdorff_filter.SetTargetDistanceMethodToPointToCell()
    hausdorff_filter.Update()
    return figures | {"work": lap(), "maximum": hausdorff_filter.GetRelativeDistance()[0]}


def labels(source, source_labels, target, output):
    """Each face of the target takes the label of the face nearest to its centroid."""
    mesh, other = read(source), read(target)
    values = numpy.loadtxt(source_labels, dtype=int)
    figures = {"read": lap()}
    locator = locator_of(mesh)
    points = vtk_to_numpy(other.GetPoints().GetData()).astype(float)
    corners = vtk_to_numpy(other.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    cells, _ = nearest(locator, points[corners].mean(axis=1))
    figures |= {"work": lap()}
    numpy.savetxt(output, values[cells], fmt="%d")
    return figures


def weights(source, cage, output):
    """Mean value coordinates, one call a point: VTK has no call for many."""
    points, cage = vtk_to_numpy(read(source).GetPoints().GetData()).astype(float), read(cage)
    figures = {"read": lap()}
    corners, triangles = cage.GetPoints(), cage.GetPolys()
    values = numpy.empty((len(points), corners.GetNumberOfPoints()))
    for point, row in zip(points, values):
        vtkMeanValueCoordinatesInterpolator.ComputeInterpolationWeights(point, corners, triangles, row)
    figures |= {"work": lap()}
    numpy.save(output, values)
    return figures


if __name__ == "__main__":
    tasks = {"convert": convert, "slice": slices, "simplify": simplify, "closest": closest, "hausdorff": hausdorff, "labels": labels,
             "weights": weights}
    if len(sys.argv) < 2 or sys.argv[1] not in tasks:
        sys.exit("usage: peer_vtk.py TASK ARGUMENTS...   with one of " + ", ".join(tasks))
    lap()
    print(json.dumps(tasks[sys.argv[1]](*sys.argv[2:])))

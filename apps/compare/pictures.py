"""Compares pictures of textured meshes with those of VTK: same camera, flat light, black background.

usage: xvfb-run /usr/bin/python3 apps/compare/pictures.py COMMAND MESH IMAGE [--view AZIMUTH,ELEVATION] [--size WxH] [render options]

MESH: .obj, .glb or .gltf with one image; IMAGE: that image as PNG or JPEG, which VTK shows without the material's colour. VTK draws 4 x 4
samples per pixel, averaged in linear light. Prints the shares of the object's pixels whose channels differ by at most 8 of 255: of all
pixels, and of those that the object covers whole; the others mix object and background.
"""
import argparse
import math
import os
import subprocess
import tempfile

import numpy as np
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkImagingCore import vtkImageFlip
from vtkmodules.vtkIOGeometry import vtkGLTFReader, vtkOBJReader
from vtkmodules.vtkIOImage import vtkJPEGReader, vtkPNGReader
from vtkmodules.vtkRenderingCore import (vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkTexture,
                                         vtkWindowToImageFilter)

SAMPLES = 4  # per pixel in each direction
TOLERANCE = 8


def surfaces(block):
    for i in range(block.GetNumberOfBlocks()):
        part = block.GetBlock(i)
        if isinstance(part, vtkPolyData):
            for name in ("TEXCOORD_0", "texcoord_0"):  # by version
                if part.GetPointData().HasArray(name):
                    part.GetPointData().SetActiveTCoords(name)
            yield part
        elif part is not None and hasattr(part, "GetNumberOfBlocks"):
            yield from surfaces(part)


def read_surfaces(file):
    reader = vtkOBJReader() if file.endswith(".obj") else vtkGLTFReader()
    reader.SetFileName(file)
    reader.Update()
    return [reader.GetOutput()] if file.endswith(".obj") else list(surfaces(reader.GetOutput()))


def texture_of(file, is_gltf):
    reader = vtkPNGReader() if file.lower().endswith(".png") else vtkJPEGReader()
    reader.SetFileName(file)
    texture = vtkTexture()
    if is_gltf:  # whose v grows downwards
        flip = vtkImageFlip()
        flip.SetInputConnection(reader.GetOutputPort())
        flip.SetFilteredAxis(1)
        texture.SetInputConnection(flip.GetOutputPort())
    else:
        texture.SetInputConnection(reader.GetOutputPort())
    texture.InterpolateOn()
    texture.RepeatOn()
    return texture


def axes_of(azimuth, elevation):
    """Right, up and towards the viewer, with z up and the front at -y."""
    a, e = math.radians(azimuth), math.radians(elevation)
    level = np.array([math.sin(a), -math.cos(a), 0])
    toward = math.cos(e) * level + math.sin(e) * np.array([0, 0, 1])
    up = -math.sin(e) * level + math.cos(e) * np.array([0, 0, 1])
    return np.cross(up, toward), up, toward


def place_camera(renderer, meshes, view, width, height):
    used = [np.unique(vtk_to_numpy(m.GetPolys().GetConnectivityArray())) for m in meshes]
    points = np.concatenate([vtk_to_numpy(m.GetPoints().GetData()).astype(float)[u] for m, u in zip(meshes, used)])
    axes = np.array(axes_of(*view))
    local = points @ axes.T
    low, high = local.min(0), local.max(0)
    centre, size = (low + high) / 2 @ axes, high - low
    scale = min(0.92 * width / size[0], 0.92 * height / size[1])  # src/render/camera.cpp
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetFocalPoint(*centre)
    camera.SetPosition(*(centre + 2 * size[2] * axes[2]))
    camera.SetViewUp(*axes[1])
    camera.SetParallelScale(height / scale / 2)
    camera.SetClippingRange(0.8 * size[2], 3.2 * size[2])


def pixels(window):
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    grab.Update()
    image = grab.GetOutput()
    width, height, _ = image.GetDimensions()
    return vtk_to_numpy(image.GetPointData().GetScalars()).reshape(height, width, -1)[::-1, :, :3]


def picture_of_vtk(mesh, image, view, width, height):
    renderer = vtkRenderer()
    meshes = read_surfaces(mesh)
    for part in meshes:
        mapper, actor = vtkPolyDataMapper(), vtkActor()
        mapper.SetInputData(part)
        mapper.ScalarVisibilityOff()
        actor.SetMapper(mapper)
        actor.SetTexture(texture_of(image, not mesh.endswith(".obj")))
        actor.GetProperty().LightingOff()
        renderer.AddActor(actor)
    place_camera(renderer, meshes, view, width, height)
    window = vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)
    window.SetSize(SAMPLES * width, SAMPLES * height)
    window.AddRenderer(renderer)
    window.Render()
    samples = pixels(window).reshape(height, SAMPLES, width, SAMPLES, 3) / 255.0
    light = np.where(samples <= 0.04045, samples / 12.92, ((samples + 0.055) / 1.055) ** 2.4).mean((1, 3))
    coded = np.where(light <= 0.0031308, 12.92 * light, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055)
    return np.rint(255 * coded).astype(int), (samples.max(-1) > 0).all((1, 3))


def picture_of(command, mesh, view, width, height, options):
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "picture.png")
        subprocess.run([command, "render", mesh, file, "--colour", "texture", "--light", "flat", "--view", "%g,%g" % view, "--up", "z",
                        "--size", f"{width}x{height}", "--background", "black", "--no-scale-bar", "--no-legend", "--quiet", *options],
                       check=True, stdout=subprocess.DEVNULL)
        reader = vtkPNGReader()
        reader.SetFileName(file)
        reader.Update()
        values = vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())
        return values.reshape(height, width, -1)[::-1, :, :3].astype(int)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("command")
    parser.add_argument("mesh")
    parser.add_argument("image")
    parser.add_argument("--view", default="30,20")
    parser.add_argument("--size", default="1000x800")
    given, options = parser.parse_known_args()
    view = tuple(float(x) for x in given.view.split(","))
    width, height = (int(x) for x in given.size.split("x"))
    reference, whole = picture_of_vtk(given.mesh, given.image, view, width, height)
    own = picture_of(given.command, given.mesh, view, width, height, options)
    shown = (reference.max(-1) > 0) | (own.max(-1) > 0)
    close = np.abs(reference - own).max(-1) <= TOLERANCE
    print(f"{os.path.basename(given.mesh)}: {100 * close[shown].mean():.2f} % of {shown.sum()} pixels, "
          f"{100 * close[whole].mean():.2f} % of {whole.sum()} that the object covers whole")


if __name__ == "__main__":
    main()

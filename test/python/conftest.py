"""What the tests of the Python module share."""

import os
import pathlib
import subprocess

import numpy
import pytest

import ostraka

SOURCE = pathlib.Path(__file__).resolve().parents[2]
DATA = SOURCE / "data"


@pytest.fixture
def data():
    return DATA


@pytest.fixture
def command(tmp_path):
    """Runs the command in the test's folder."""
    program = os.environ.get("OSTRAKA_COMMAND")
    if not program:
        pytest.skip("OSTRAKA_COMMAND names no command")

    def run(*words):
        return subprocess.run([program, *map(str, words)], cwd=tmp_path, capture_output=True, text=True, check=False)

    return run


@pytest.fixture
def tetrahedron():
    points = numpy.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = numpy.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    return points, faces


@pytest.fixture
def teapot():
    return ostraka.Mesh(DATA / "teapot.ply")

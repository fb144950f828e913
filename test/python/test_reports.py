"""Reports, their tables, and how they are shown."""

import csv
import io
import json

import numpy
import pytest

import ostraka


@pytest.fixture
def listed(data):
    return ostraka.annotation.list(data / "teapot.ply", data / "teapot.ant.json").report


def test_the_result_is_that_of_json(listed, data, command):
    told = json.loads(command("annotation", "list", data / "teapot.ply", data / "teapot.ant.json", "--json").stdout)
    assert listed.to_dict() == told and listed.result == told["result"] and listed["class"] == "flowered teapot"
    assert listed.provenance["command"] == "annotation list" and listed.notes == []


def test_tables_are_rows_and_columns(listed):
    table = listed.tables["annotations"]
    assert len(table) == len(listed["annotations"]) and table.columns[:3] == ["id", "tag", "type"]
    assert table[5]["tag"] == "spout" and next(iter(table))["id"] == 0
    assert table["id"].dtype == numpy.int64 and table["area"].dtype == numpy.float64
    assert numpy.isnan(table["area"][-1])  # a point has none
    assert table.units["area"] == "length^2"
    array = table.to_numpy()
    assert array["tag"][5] == "spout" and array.shape == (len(table),)
    with pytest.raises((KeyError, ValueError)):
        table["aera"]


def test_tables_are_written_as_csv(listed, tmp_path):
    table = listed.tables["annotations"]
    rows = list(csv.DictReader(io.StringIO(table.to_csv())))
    assert rows[5]["tag"] == "spout" and float(rows[5]["area"]) == table[5]["area"] and len(rows) == len(table)
    table.to_csv(tmp_path / "parts.csv")
    assert (tmp_path / "parts.csv").read_text() == table.to_csv()


def test_members_of_members_are_columns(data):
    table = ostraka.annotation.transfer(data / "teapot.ply", data / "teapot.ant.json",
                                        data / "teapot.ply").report.tables["annotations"]
    assert "distortion.A" in table.columns and (table["distortion.A"][:5] < 1e-9).all()


def test_empty_tables(data):
    empty = ostraka.annotation.list(data / "teapot.ply", {"annotations": []}).report.tables
    for table in empty.values():
        assert len(table) == 0 and table.to_numpy().shape == (0,) and table.to_csv().count("\n") == 1


def test_notebooks_show_them(listed, teapot):
    assert listed._repr_markdown_().startswith("|")
    assert "<td>spout</td>" in listed.tables["annotations"]._repr_html_()
    picture = ostraka.render(teapot, size="100x80").picture
    assert picture._repr_png_().startswith(b"\x89PNG") and picture._repr_svg_() is None


def test_results_show_their_outputs(data, tmp_path):
    made = ostraka.mesh.convert(data / "teapot.ply")
    assert "output: <ostraka.Mesh 'output.ply': 4000 vertices, 8000 faces>" in repr(made)
    made = ostraka.mesh.convert(data / "teapot.ply", tmp_path / "pot.obj")
    assert f"output: written to {tmp_path / 'pot.obj'}" in repr(made)
    assert made.holds and list(made.outputs) == ["output", "map"]

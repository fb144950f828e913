"""Reports and results."""

from __future__ import annotations

import csv
import hashlib
import io
import json
import os
import pathlib
from collections.abc import Iterator
from typing import Any

import numpy

from . import _ostraka
from ._errors import InputError
from ._objects import Bytes

_dtypes = {"boolean": "?", "integer": "i8", "number": "f8"}


class Table:
    """A table of a report: a list of rows (dicts), whose columns are available as arrays by name."""

    def __init__(self, name: str, columns: list[dict[str, str]], rows: list[dict[str, Any]]) -> None:
        self.name = name
        self._columns = columns
        self.rows = [{column["key"]: _member(row, column["key"]) for column in columns} for row in rows]

    @property
    def columns(self) -> list[str]:
        return [column["key"] for column in self._columns]

    @property
    def units(self) -> dict[str, str]:
        """Units of the columns that have one; "length" is the unit of length of the objects."""
        return {column["key"]: column["unit"] for column in self._columns if column["unit"]}

    def __len__(self) -> int:
        return len(self.rows)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return iter(self.rows)

    def __getitem__(self, key: int | str) -> Any:
        """A row by its index, or a column (an array) by its name."""
        return self.rows[key] if not isinstance(key, str) else self.to_numpy()[key]

    def to_numpy(self) -> numpy.ndarray:
        """A structured array with a field for each column. Empty cells are nan in columns of numbers, None in others."""
        fields = []
        for column in self._columns:
            cells = [row[column["key"]] for row in self.rows]
            dtype = _dtypes.get(column["type"], "O")
            if None in cells:
                dtype = "f8" if dtype in ("i8", "f8") else "O"
            fields.append((column["key"], dtype))
        array = numpy.empty(len(self.rows), dtype=fields)
        for key, dtype in fields:
            cells = [row[key] for row in self.rows]
            for i, cell in enumerate(cells):
                array[key][i] = numpy.nan if cell is None and dtype == "f8" else cell
        return array

    def to_pandas(self) -> Any:
        """The table as a DataFrame; requires pandas."""
        import pandas

        return pandas.DataFrame(self.rows, columns=self.columns)

    def to_csv(self, file: str | os.PathLike[str] | None = None) -> str | None:
        """Writes the table as CSV to a file, or returns it as text if no file is given."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(self.columns)
        for row in self.rows:
            writer.writerow([json.dumps(cell) if isinstance(cell, (list, dict)) else cell for cell in row.values()])
        if file is None:
            return text.getvalue()
        Bytes(text.getvalue().encode()).save(file)
        return None

    def __repr__(self) -> str:
        return f"<ostraka.Table {self.name!r}: {len(self)} rows of {', '.join(self.columns)}>"

    def _repr_html_(self) -> str:
        from html import escape

        head = "".join(f"<th>{escape(column)}</th>" for column in self.columns)
        body = "".join("<tr>" + "".join(f"<td>{escape('' if cell is None else str(cell))}</td>" for cell in row.values())
                       + "</tr>" for row in self.rows)
        return f"<table><tr>{head}</tr>{body}</table>"


def _member(values: Any, key: str) -> Any:
    """The nested member with this key ("a.b" is the member b of the member a); None if there is none."""
    for name in key.split("."):
        if not isinstance(values, dict) or name not in values:
            return None
        values = values[name]
    return values


class _SavedReport:
    """The texts of a pickled report, in place of the native report."""

    formats = ("table", "json", "csv", "markdown")

    def __init__(self, texts: dict[str, str], layout: bytes, holds: bool) -> None:
        self._texts = texts
        self._layout = layout
        self.holds = holds

    def text(self, form: str) -> str:
        return self._texts[form]

    def layout(self) -> bytes:
        return self._layout


def _digest(texts: dict[str, str], layout: bytes, holds: bool) -> str:
    return hashlib.sha256(json.dumps([texts, layout.decode(), holds], sort_keys=True).encode()).hexdigest()


def restored_report(texts: dict[str, str], layout: bytes, holds: bool, digest: str) -> Report:
    """Restores a pickled report. Raises InputError if it is damaged."""
    try:
        sound = set(texts) == set(_SavedReport.formats) and isinstance(holds, bool) and _digest(texts, layout, holds) == digest
    except (TypeError, ValueError, AttributeError):
        sound = False
    if not sound:
        raise InputError("holds a damaged report (its checksum differs)", "pickle", "pickle the report again")
    return Report(_SavedReport(texts, layout, holds))


class Report:
    """The report of an operation; printed as by the command. It can be pickled and copied."""

    def __init__(self, native: _ostraka.Report | _SavedReport) -> None:
        self._native = native
        self._json: dict[str, Any] | None = None

    def __reduce__(self) -> tuple[Any, ...]:
        texts = {form: self._native.text(form) for form in _SavedReport.formats}
        layout, holds = self._native.layout(), self.holds
        return restored_report, (texts, layout, holds, _digest(texts, layout, holds))

    def __copy__(self) -> Report:
        return Report(self._native)  # immutable

    def __deepcopy__(self, memo: dict[int, Any]) -> Report:
        return Report(self._native)

    @property
    def holds(self) -> bool:
        """False if the answer is "no": the command would end with exit code 3."""
        return self._native.holds

    def to_dict(self) -> dict[str, Any]:
        """The complete report, as printed by `--json`."""
        if self._json is None:
            self._json = json.loads(self._native.text("json"))
        return self._json

    @property
    def result(self) -> dict[str, Any]:
        return self.to_dict()["result"]

    @property
    def provenance(self) -> dict[str, Any]:
        """The operation, its options, and the checksums of its inputs."""
        return self.to_dict()["provenance"]

    @property
    def notes(self) -> list[str]:
        """Remarks on the result."""
        return self.result.get("notes", [])

    @property
    def tables(self) -> dict[str, Table]:
        tables = {}
        for layout in json.loads(self._native.layout()):
            rows = _member(self.result, layout["key"])
            if isinstance(rows, list):
                tables[layout["key"]] = Table(layout["key"], layout["columns"], rows)
        return tables

    def to_csv(self) -> str:
        """The report as printed by `--show csv`."""
        return self._native.text("csv")

    def to_markdown(self) -> str:
        """The report as printed by `--show markdown`."""
        return self._native.text("markdown")

    def __getitem__(self, key: str) -> Any:
        """A member of the result."""
        return self.result[key]

    def __repr__(self) -> str:
        notes = "".join(f"note: {note}\n" for note in self.notes)
        return (self._native.text("table") + notes).rstrip("\n")

    def _repr_markdown_(self) -> str:
        return self.to_markdown() + "".join(f"\n*Note: {note}*\n" for note in self.notes)


class Result:
    """The result of an operation: its report, and its outputs by name, as attributes or items.

    An output is an object if it stayed in memory, the path of its file if it was written, a list if there are several, None if
    there is none. "_" is appended to names of outputs that are attributes of the class.
    """

    def __init__(self, report: Report, outputs: dict[str, Any]) -> None:
        self.report = report
        self.outputs = outputs
        for name, value in outputs.items():
            setattr(self, attribute_name(name), value)

    @property
    def holds(self) -> bool:
        """False if the answer is "no"."""
        return self.report.holds

    def __getitem__(self, name: str) -> Any:
        return self.outputs[name]

    def __repr__(self) -> str:
        lines = [repr(self.report)] if repr(self.report) else []
        for name, value in self.outputs.items():
            if value is None:
                continue
            shown = f"written to {value}" if isinstance(value, pathlib.Path) else repr(value)
            lines.append(f"{name}: {shown}")
        return "\n".join(lines)

    def _repr_markdown_(self) -> str:
        return self.report._repr_markdown_()


def attribute_name(output: str) -> str:
    """Attribute name of an output; "_" is appended to names of the class's own attributes."""
    return output + "_" if hasattr(Result, output) or output in ("report", "outputs") else output


for _class in (Table, Report, Result):
    _class.__module__ = "ostraka"

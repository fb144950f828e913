#!/usr/bin/env python3
"""Runs the true command and spoils what it makes, to see that the kit notices: wrong_backend.py MODE -- COMMAND...

sign       flips the sign of the greatest weight of the first point in what `cage weights` writes
iteration  takes one iteration less wherever a call sets the option --iterations
order      reverses the order of the vertices in every PLY file written, and the indices of its faces with them
"""
import os
import subprocess
import sys

import numpy as np

from numpy_backend import TYPES, list_fields, read_header


def files_named(words):
    """Files that the words of a call name, those in folders included."""
    for word in words:
        for name in {word, word.partition("=")[2]} - {""}:
            if os.path.isdir(name):
                for folder, _, files in os.walk(name):
                    yield from (os.path.join(folder, file) for file in files)
            elif os.path.isfile(name):
                yield name


def flip_sign(file):
    weights = np.load(file)
    if weights.ndim < 2:  # sparse weights: the kit says of them only that they are there
        return
    weights[0, np.abs(weights[0]).argmax()] *= -1
    np.save(file, weights)


def reverse_order(file):
    with open(file, "rb") as stream:
        data = stream.read()
    kind, elements, at = read_header(data, file)
    body = data[at:]
    counts = {name: count for name, count, _ in elements}
    n = counts.get("vertex", 0)
    if kind == "ascii":
        lines, parts, first = body.decode().splitlines(keepends=True), [], 0
        for name, count, _ in elements:
            rows = lines[first:first + count]
            first += count
            if name == "vertex":
                rows.reverse()
            elif name == "face":
                rows = [row.split() for row in rows]
                rows = [" ".join(r[:1] + [str(n - 1 - int(i)) for i in r[1:1 + int(r[0])]] + r[1 + int(r[0]):]) + "\n" for r in rows]
            parts.append("".join(rows))
        body = "".join(parts).encode()
    else:
        parts, start = [], 0
        for name, count, properties in elements:
            fields = []
            for p in properties:
                fields += list_fields(p) if p[0] == "list" else [(p[-1], "<" + TYPES[p[0]])]
            rows = np.frombuffer(body, np.dtype(fields), count, start).copy()
            start += rows.nbytes
            if name == "vertex":
                rows = rows[::-1]
            elif name == "face":
                rows["vertex_indices"] = n - 1 - rows["vertex_indices"]
            parts.append(rows.tobytes())
        body = b"".join(parts)
    with open(file, "wb") as stream:
        stream.write(data[:at] + body)


def main():
    mode, words = sys.argv[1], sys.argv[3:]
    if mode == "iteration" and "--iterations" in words:
        at = words.index("--iterations") + 1
        words[at] = str(int(words[at]) - 1)
    before = set(files_named(words))
    code = subprocess.run(words, check=False).returncode
    for file in set(files_named(words)) - before:
        if mode == "sign" and words[1:3] == ["cage", "weights"] and file.endswith(".npy"):
            flip_sign(file)
        elif mode == "order" and file.endswith(".ply"):
            reverse_order(file)
    return code


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""An example backend of another kind, in Python with NumPy alone.

    ostraka conformance run --lines -- python3 numpy_backend.py

It reads a case a line, {"id": ..., "operation": ..., "with": {...}}, and answers with a line, {"code": ..., "result": ...,
"message": ...}. Names of files are absolute, those of outputs included. It has two operations:

- `annotation transfer` by nearest places: each target face takes the annotations of the nearest source face (by
  centroids), points and lines go to the nearest vertices, lines joined by shortest paths along edges.
- `cage weights` by mean value coordinates, as in Figure 4 of Ju, Schaefer and Warren (2005).

All else is answered with code 4, not supported; so are the options that it does not have (Green coordinates, covers).

Known weaknesses, which are exactly the cases where it differs (KNOWN_WEAKNESSES):

- It gives no report of a transfer: no areas, perimeters or distances.
- Beside an edge of the object the nearest centroid may be that of a face around the corner.
- Where source faces are large, the nearest centroid is not that of the face on which a place lies.
"""
import heapq
import hashlib
import json
import os
import sys

import numpy as np

KNOWN_WEAKNESSES = ["annotation-transfer-points-and-lines", "annotation-transfer-scores", "annotation-transfer-subdivided"]


class Refusal(Exception):
    """What an answer with another code than 0 says."""

    def __init__(self, code, message):
        super().__init__(message)
        self.code = code


# Meshes -----------------------------------------------------------------------------------------------------------------

TYPES = {"char": "i1", "int8": "i1", "uchar": "u1", "uint8": "u1", "short": "i2", "int16": "i2", "ushort": "u2",
         "uint16": "u2", "int": "i4", "int32": "i4", "uint": "u4", "uint32": "u4", "float": "f4", "float32": "f4",
         "double": "f8", "float64": "f8"}


def read_bytes(file):
    try:
        with open(file, "rb") as stream:
            return stream.read()
    except OSError as error:
        raise Refusal(1, f"{file}: {error.strerror}") from None


def read_header(data, file):
    """Format, elements as (name, count, [property words]), and where the body begins."""
    end = data.find(b"end_header\n")
    if not data.startswith(b"ply") or end < 0:
        raise Refusal(1, f"{file}: is no PLY file")
    kind, elements = "", []
    for line in data[:end].decode("latin-1").splitlines():
        words = line.split()
        if words[:1] == ["format"]:
            kind = words[1]
        elif words[:1] == ["element"]:
            elements.append((words[1], int(words[2]), []))
        elif words[:1] == ["property"]:
            elements[-1][2].append(words[1:])
    return kind, elements, end + len(b"end_header\n")


def list_fields(words):
    """A list property of triangles as fields of a row: three vertices, or the texture coordinates of three corners."""
    return [("count " + words[-1], "<" + TYPES[words[1]]), (words[-1], "<" + TYPES[words[2]], 6 if words[-1] == "texcoord" else 3)]


def read_ply(file):
    """Points (n x 3) and triangles (m x 3); polygons are not read."""
    data = read_bytes(file)
    kind, elements, at = read_header(data, file)
    tables = {}
    try:
        words = iter(data[at:].split()) if kind == "ascii" else None
        for name, count, properties in elements:
            if words is not None:
                rows = [[[next(words) for _ in range(int(next(words)))] if p[0] == "list" else next(words)
                         for p in properties] for _ in range(count)]
                tables[name] = {p[-1]: [row[i] for row in rows] for i, p in enumerate(properties)}
                continue
            fields = []
            for p in properties:
                if p[0] == "list":
                    fields += list_fields(p)
                else:
                    fields.append((p[-1], "<" + TYPES[p[0]]))
            tables[name] = np.frombuffer(data, np.dtype(fields), count, at)
            at += tables[name].nbytes
        points = np.stack([np.asarray(tables["vertex"][axis], float) for axis in "xyz"], axis=1)
        corners = tables["face"]["vertex_indices"]
        faces = np.asarray(corners, np.int64).reshape(len(corners), 3)
    except (KeyError, ValueError, StopIteration):
        raise Refusal(1, f"{file}: is cut off, or no triangle mesh") from None
    if not np.isfinite(points).all() or (len(faces) and (faces.min() < 0 or faces.max() >= len(points))):
        raise Refusal(1, f"{file}: has coordinates or indices out of range")
    return points, faces


def mesh_checksum(points, faces):
    """Over the indexed geometry, as the files of coordinates name it."""
    counts = np.array([len(points), len(faces)], "<u8")
    return hashlib.sha256(counts.tobytes() + (points + 0.0).astype("<f8").tobytes() + faces.astype("<u4").tobytes()).hexdigest()


def diagonal(points):
    return float(np.linalg.norm(points.max(0) - points.min(0)))


def nearest(places, queries):
    """Of each query the index of the nearest place; of equally near ones the lowest."""
    found = np.empty(len(queries), np.int64)
    for start in range(0, len(queries), 512):
        apart = queries[start:start + 512, None, :] - places[None, :, :]
        found[start:start + 512] = np.einsum("ijk,ijk->ij", apart, apart).argmin(1)
    return found


# Annotations ------------------------------------------------------------------------------------------------------------

def read_annotations(file, points, faces):
    try:
        document = json.loads(read_bytes(file))
    except ValueError:
        raise Refusal(1, f"{file}: is no JSON") from None
    mesh = document.get("mesh", {})
    if mesh and (mesh.get("vertices"), mesh.get("faces")) != (len(points), len(faces)):
        raise Refusal(1, f"{file}: was made for another mesh")
    return document


def faces_of(annotation, faces):
    """The faces of a region: all, listed, or to the left of its outlines."""
    if annotation.get("all"):
        return set(range(len(faces)))
    if annotation.get("faces"):
        return set(annotation["faces"])
    left = {(int(t[i]), int(t[(i + 1) % 3])): f for f, t in enumerate(faces) for i in range(3)}
    outline = set()
    for chain in annotation.get("boundaries", []):
        closed = chain if chain[0] == chain[-1] else chain + chain[:1]
        outline.update(zip(closed[:-1], closed[1:]))
    inside = set(annotation.get("seeds", [])) | {left[edge] for edge in outline if edge in left}
    front = list(inside)
    while front:
        t = faces[front.pop()]
        for i in range(3):
            a, b = int(t[i]), int(t[(i + 1) % 3])
            beside = left.get((b, a))
            if (a, b) not in outline and beside is not None and beside not in inside:
                inside.add(beside)
                front.append(beside)
    return inside


def shortest_path(points, neighbours, start, end):
    distance, before, heap = {start: 0.0}, {}, [(0.0, start)]
    while heap:
        so_far, v = heapq.heappop(heap)
        if v == end:
            break
        if so_far > distance[v]:
            continue
        for u in neighbours[v]:
            longer = so_far + float(np.linalg.norm(points[u] - points[v]))
            if longer < distance.get(u, np.inf):
                distance[u], before[u] = longer, v
                heapq.heappush(heap, (longer, u))
    path = [end]
    while path[-1] != start and path[-1] in before:
        path.append(before[path[-1]])
    return path[::-1]


def transfer(settings):
    points, faces = read_ply(settings["source"])
    document = read_annotations(settings["annotations"], points, faces)
    target, triangles = read_ply(settings["target"])
    if not 0.9 < diagonal(target) / diagonal(points) < 1.1:
        raise Refusal(1, f"{settings['target']}: differs in size from the source")
    source_face = nearest(points[faces].mean(1), target[triangles].mean(1))
    neighbours = [set() for _ in target]
    for a, b, c in triangles.tolist():
        for v, u in ((a, b), (b, c), (c, a)):
            neighbours[v].add(u)
            neighbours[u].add(v)

    def places(indices):
        return nearest(target, points[np.asarray(indices, np.int64)]).tolist()

    carried = []
    for annotation in document["annotations"]:
        one = {key: annotation[key] for key in ("id", "tag", "colour", "type") if key in annotation}
        if annotation["type"] == "point":
            one["points"] = list(dict.fromkeys(places(annotation["points"])))
        elif annotation["type"] == "line":
            one["polylines"] = []
            for chain in annotation["polylines"]:
                ends = places(chain)
                path = ends[:1]
                for end in ends[1:]:
                    if end != path[-1]:
                        path += shortest_path(target, neighbours, path[-1], end)[1:]
                one["polylines"].append(path)
        elif annotation.get("all"):
            one.update(all=True, boundaries=[])
        else:
            inside = np.zeros(len(faces), bool)
            inside[list(faces_of(annotation, faces))] = True
            one.update(boundaries=[], faces=np.flatnonzero(inside[source_face]).tolist())
        carried.append(one)
    with open(settings["output"], "w", encoding="utf-8") as stream:
        json.dump({"format": "ostraka-annotations", "version": 1, "annotations": carried}, stream)
    return {"code": 0, "result": {}}


# Coordinates ------------------------------------------------------------------------------------------------------------

def mean_value_weights(x, cage, faces, scale):
    """Weights of one point, and whether it lies on the cage (Ju, Schaefer, Warren 2005, Figure 4)."""
    weights = np.zeros(len(cage))
    toward = cage - x
    d = np.linalg.norm(toward, axis=1)
    if d.min() < 1e-14 * scale:
        weights[d.argmin()] = 1
        return weights, True
    u = toward / d[:, None]
    for t in faces:
        length = np.array([np.linalg.norm(u[t[(i + 1) % 3]] - u[t[(i + 2) % 3]]) for i in range(3)])
        theta = 2 * np.arcsin(np.minimum(length / 2, 1))
        half = theta.sum() / 2
        if np.pi - half < 1e-7:  # within the face: planar coordinates
            weights[:] = 0
            for i in range(3):
                weights[t[i]] = np.sin(theta[i]) * d[t[(i + 1) % 3]] * d[t[(i + 2) % 3]]
            return weights / weights.sum(), True
        sine = np.sin(theta)
        c = np.array([2 * np.sin(half) * np.sin(half - theta[i]) / (sine[(i + 1) % 3] * sine[(i + 2) % 3]) - 1
                      for i in range(3)])
        s = np.sign(np.linalg.det(u[t])) * np.sqrt(np.maximum(1 - c * c, 0))
        if np.abs(s).min() < 1e-9:  # in the plane of the face, outside it
            continue
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            weights[t[i]] += (theta[i] - c[j] * theta[k] - c[k] * theta[j]) / (d[t[i]] * sine[j] * s[k])
    return weights / weights.sum(), False


def is_inside(x, cage, faces):
    """By the sum of the solid angles (Van Oosterom and Strackee 1983)."""
    a, b, c = (cage[faces[:, i]] - x for i in range(3))
    la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
    over = np.einsum("ij,ij->i", a, np.cross(b, c))
    under = la * lb * lc + np.einsum("ij,ij->i", a, b) * lc + np.einsum("ij,ij->i", b, c) * la + np.einsum("ij,ij->i", c, a) * lb
    return bool(np.arctan2(over, under).sum() / (2 * np.pi) > 0.5)


def weights(settings):
    points, triangles = read_ply(settings["mesh"])
    cage, faces = read_ply(settings["cage"])
    edges = {(int(t[i]), int(t[(i + 1) % 3])) for t in faces for i in range(3)}
    if any((b, a) not in edges for a, b in edges):
        raise Refusal(1, f"{settings['cage']}: is open")
    scale, rows, outside = diagonal(cage), [], 0
    for x in points:
        row, is_on_it = mean_value_weights(x, cage, faces, scale)
        rows.append(row)
        outside += is_on_it or not is_inside(x, cage, faces)
    array, name = np.array(rows), settings["output"]
    np.save(name, array)
    header = {"format": "ostraka-coordinates", "version": 1, "kind": "mean-value",
              "vertex": {"file": os.path.basename(name), "rows": array.shape[0], "columns": array.shape[1],
                         "sha256": hashlib.sha256(read_bytes(name)).hexdigest()}}
    for what, (p, f) in (("mesh", (points, triangles)), ("cage", (cage, faces))):
        header[what] = {"vertices": len(p), "faces": len(f), "sha256": mesh_checksum(p, f)}
    with open(name.removesuffix(".npy") + ".coordinates.json", "w", encoding="utf-8") as stream:
        json.dump(header, stream)
    return {"code": 0 if outside == 0 else 3,
            "result": {"kind": "mean-value", "points": len(points), "cageVertices": len(cage), "cageFaces": len(faces),
                       "outside": outside, "holds": outside == 0}}


# The protocol -----------------------------------------------------------------------------------------------------------

OPERATIONS = {"annotation transfer": transfer, "cage weights": weights}
NAMES = {"annotation transfer": {"source", "annotations", "target", "output"}, "cage weights": {"mesh", "cage", "output"}}
CHOICES = {  # words that an option takes, the supported one first
    "kind": ["mean-value", "green", "harmonic", "local", "positive-mean-value"],
    "rounding": ["balanced", "path", "area"],
    "cover": ["overlapping", "enclosing", "enclosed"],
}


def answer(case):
    operation, settings = case["operation"], case["with"]
    if operation not in OPERATIONS:
        return {"code": 4}
    for name, value in settings.items():
        if name in CHOICES and value not in CHOICES[name]:
            return {"code": 2, "message": f"option {name} is '{value}' (use one of: {', '.join(CHOICES[name])})"}
        if name not in NAMES[operation] and (name not in CHOICES or value != CHOICES[name][0]):
            return {"code": 4}
    for name in NAMES[operation] - set(settings):
        return {"code": 2, "message": f"{name} is missing"}
    try:
        return OPERATIONS[operation](settings)
    except Refusal as refusal:
        return {"code": refusal.code, "message": str(refusal)}


def main():
    for line in sys.stdin:
        print(json.dumps(answer(json.loads(line))), flush=True)


if __name__ == "__main__":
    main()

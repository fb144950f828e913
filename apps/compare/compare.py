"""Measures the same work by this toolkit and by others, whole processes side by side, and writes a table.

usage: compare.py BUILD_FOLDER [--vertices N] [--laps N]
Each row is a fresh process that reads its files and writes its results; the laps of all peers of a task take turns. Seconds and
memory are those of the median lap. Errors come from one measure for all.
"""
import argparse
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import time

import numpy

here = pathlib.Path(__file__).resolve().parent


def run_process(words):
    """Wall seconds, exit code, standard output and standard error of the process."""
    begin = time.perf_counter()
    process = subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    printed, problems = process.communicate()
    return time.perf_counter() - begin, process.returncode, printed, problems


def with_memory(words):
    """GNU time measures the peak of the process that it waits for."""
    with tempfile.NamedTemporaryFile("r") as file:
        seconds, code, printed, problems = run_process(["/usr/bin/time", "-f", "%M", "-o", file.name, *map(str, words)])
        if code not in (0, 3):
            sys.exit(f"compare: {' '.join(map(str, words))} ended with {code}: {problems[-600:]}")
        return {"seconds": seconds, "MB": int(file.read().split()[-1]) / 1024, "printed": printed}


def document_of(run):
    """The JSON that a peer prints: a report of Ostraka (run.seconds) or a line of JSON."""
    begin = run["printed"].find("{")
    try:
        document = json.loads(run["printed"][begin:]) if begin >= 0 else {}
    except ValueError:
        document = {}
    return document


class Task:
    def __init__(self, title, note=""):
        self.title, self.note, self.peers = title, note, {}

    def peer(self, name, words, error=None):
        """`error`: makes the text of the last column from the document of a run."""
        self.peers[name] = (words, error)
        return self

    def run(self, laps):
        runs = {name: [] for name in self.peers}
        for _ in range(laps):
            for name, (words, _) in self.peers.items():
                runs[name].append(with_memory(words))
        rows = []
        for name, (_, error) in self.peers.items():
            sorted_runs = sorted(runs[name], key=lambda run: run["seconds"])
            median_run = sorted_runs[len(sorted_runs) // 2]
            document = document_of(median_run) | {"printed": median_run["printed"]}
            work = document.get("work")
            rows.append([name, f"{median_run['seconds']:.2f}", "" if work is None else f"{work + document.get('build', 0):.3f}",
                         f"{median_run['MB']:.0f}", error(document) if error else ""])
        best = min(float(row[1]) for row in rows)
        print(f"### {self.title}\n\n{self.note}{chr(10) * 2 if self.note else ''}"
              "| by | whole process, s | work alone, s | MB | result |\n|---|---:|---:|---:|---|")
        for row in rows:
            print("| " + " | ".join(row) + " |")
        print(flush=True)
        return {"task": self.title, "fastest": next(row[0] for row in rows if float(row[1]) == best)}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("build", type=pathlib.Path)
    parser.add_argument("--vertices", type=int, default=1_000_000)
    parser.add_argument("--laps", type=int, default=3)
    arguments = parser.parse_args()
    build = arguments.build.resolve()
    ostraka, peers, vtk = build / "ostraka", build / "ostraka_peers", ["/usr/bin/python3", here / "peer_vtk.py"]
    sys.path.insert(0, str(build / "python"))
    import ostraka as module

    folder = pathlib.Path(tempfile.mkdtemp(prefix="ostraka-compare-"))
    os.chdir(folder)

    def make(name, object_name, vertices, seed=1):
        subprocess.run([ostraka, "mesh", "make", object_name, name, "--vertices", str(vertices), "--seed", str(seed), "--labels",
                        name.replace(".ply", ".labels"), "--quiet"], check=True, stdout=subprocess.DEVNULL)

    n = arguments.vertices
    make("large.ply", "statuette", n)
    make("middle.ply", "statuette", max(300, n // 10), 2)
    make("small.ply", "statuette", max(300, n // 20), 3)
    # The other programs read plain geometry only.
    for name in ("large", "middle", "small"):
        subprocess.run([peers, "convert", "cgal", f"{name}.ply", f"{name}-plain.ply"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([ostraka, "cage", "make", "small-plain.ply", "cage.ply", "--vertices", "200", "--quiet"], check=True,
                   stdout=subprocess.DEVNULL)
    recipe = here.parent.parent / "data/statuette.recipe.json"
    for name in ("small", "large"):
        subprocess.run([ostraka, "annotation", "apply", f"{name}.ply", recipe, f"{name}.ant.json", "--quiet"], check=True,
                       stdout=subprocess.DEVNULL)
    large, middle, small = "large-plain.ply", "middle-plain.ply", "small-plain.ply"
    meshlab = shutil.which("meshlabserver")
    screen = ["xvfb-run", "-a", "meshlabserver"]

    def by_meshlab(task, name, words, error=None):
        if meshlab:
            task.peer(name, [*screen, *words], error)

    def filter_script(file, title, **parameters):
        """MeshLab wants all parameters of a filter, each with its type."""
        text = "".join(f'<Param type="{kind}" name="{name}" value="{value}" min="0" max="1000000"/>'
                       for name, (kind, value) in parameters.items())
        pathlib.Path(file).write_text(f'<!DOCTYPE FilterScript><FilterScript><filter name="{title}">{text}</filter></FilterScript>')
        return file

    def integer(value):
        return ("RichInt", value)

    def real(value):
        return ("RichFloat", value)

    def flag(value):
        return ("RichBool", "true" if value else "false")

    counts = f"{n:,} vertices"
    convert = Task(f"A mesh of {counts} read and written (binary PLY)")
    convert.peer("Ostraka", [ostraka, "mesh", "convert", large, "o.ply", "--quiet"])
    convert.peer("CGAL 5.5", [peers, "convert", "cgal", large, "c.ply"])
    convert.peer("OpenMesh 9", [peers, "convert", "openmesh", large, "m.ply"])
    convert.peer("VTK 9.1", [*vtk, "convert", large, "v.ply"])
    by_meshlab(convert, "MeshLab 2020.09", ["-i", large, "-o", "l.ply"])

    def length(document):
        return f"contours {document['length']:.5g} mm"

    slicing = Task(f"100 slices of {counts}", "Ostraka also computes 37 descriptors of each slice and writes their table.")
    slicing.peer("Ostraka", [ostraka, "slice", large, "--count", "100", "--output", "o.csv", "--quiet", "--json"],
                 lambda document: "contours {:.5g} mm".format(sum(one["descriptors"]["perimeter"] for one in document["result"]["slices"])))
    slicing.peer("CGAL 5.5", [peers, "slice", "cgal", large, "100"], length)
    slicing.peer("VTK 9.1", [*vtk, "slice", large, "100"], length)

    def error_of(file):
        def mean_and_maximum(_):
            words = subprocess.run([peers, "closest", "ours", file, large], capture_output=True, text=True, check=True)
            distances = json.loads(words.stdout)
            return f"mean {distances['mean']:.2e}, maximum {distances['maximum']:.2e} mm off"
        return mean_and_maximum

    target_count = max(300, n // 20)
    simplify = Task(f"{counts} simplified to {target_count:,}", "\"Off\" is the distance of the vertices of the original mesh from the simplified surface.")
    simplify.peer("Ostraka", [ostraka, "mesh", "simplify", large, "so.ply", "--vertices", str(target_count), "--quiet"], error_of("so.ply"))
    simplify.peer("CGAL 5.5, Garland-Heckbert", [peers, "simplify", "cgal", large, "sc.ply", str(target_count)], error_of("sc.ply"))
    simplify.peer("OpenMesh 9, quadrics", [peers, "simplify", "openmesh", large, "sm.ply", str(target_count)], error_of("sm.ply"))
    simplify.peer("VTK 9.1, quadrics", [*vtk, "simplify", large, "sv.ply", str(target_count)], error_of("sv.ply"))
    script = filter_script("simplify.mlx", "Simplification: Quadric Edge Collapse Decimation", TargetFaceNum=integer(2 * target_count),
                           TargetPerc=real(0), QualityThr=real(0.3), PreserveBoundary=flag(False), BoundaryWeight=real(1),
                           PreserveNormal=flag(False), PreserveTopology=flag(False), OptimalPlacement=flag(True),
                           PlanarQuadric=flag(False), PlanarWeight=real(0.001), QualityWeight=flag(False), AutoClean=flag(True),
                           Selected=flag(False))
    by_meshlab(simplify, "MeshLab 2020.09, quadrics", ["-i", large, "-o", "sl.ply", "-s", script], error_of("sl.ply"))

    def distances(document):
        return f"mean {document['mean']:.6g}, maximum {document['maximum']:.6g} mm"

    closest = Task(f"Nearest points on {counts} to the vertices of {max(300, n // 10):,}",
                   "\"Work alone\" comprises building the tree and the queries. VTK is queried from Python, one query per call.")
    closest.peer("Ostraka (library, 2 threads)", [peers, "closest", "ours", large, middle], distances)
    closest.peer("CGAL 5.5 (1 thread)", [peers, "closest", "cgal", large, middle], distances)
    closest.peer("VTK 9.1", [*vtk, "closest", large, middle], distances)

    farthest = Task(f"Farthest point of {target_count:,} vertices from {max(300, n // 10):,} (one-sided Hausdorff distance)",
                    "Ostraka and VTK query from vertices; CGAL bounds the distance of whole surfaces to 0.1 % of the diagonal.")
    largest = lambda document: f"{document['maximum']:.5g} mm"
    farthest.peer("Ostraka (library, from vertices)", [peers, "closest", "ours", middle, small], largest)
    farthest.peer("CGAL 5.5, bounded error", [peers, "hausdorff", "cgal", small, middle], largest)
    farthest.peer("VTK 9.1, from vertices", [*vtk, "hausdorff", small, middle], largest)
    script = filter_script("hausdorff.mlx", "Hausdorff Distance", SampledMesh=("RichMesh", 0), TargetMesh=("RichMesh", 1),
                           SaveSample=flag(False), SampleVert=flag(True), SampleEdge=flag(False), SampleFauxEdge=flag(False),
                           SampleFace=flag(False), SampleNum=integer(target_count), MaxDist=("RichAbsPerc", 50))

    def logged(document):
        match = re.search(r"max\s*:?\s*([0-9.e+-]+)", document["printed"])
        return f"{float(match[1]):.5g} mm" if match else ""

    by_meshlab(farthest, "MeshLab 2020.09, from vertices", ["-l", "/dev/stdout", "-i", small, middle, "-s", script], logged)

    def reproduction(file):
        def largest_error(_):
            values = numpy.load(file)
            corners, points = module.Mesh("cage.ply").points, module.Mesh(small).points
            return f"off by {numpy.linalg.norm(values @ corners - points, axis=1).max():.1e} mm at most"
        return largest_error

    weights = Task(f"Mean value coordinates of {target_count:,} vertices in a cage of 200",
                   "\"Off\" is the distance of a vertex from its reconstruction W c by the coordinates. VTK is called from Python, one point per call.")
    weights.peer("Ostraka (2 threads)", [ostraka, "cage", "weights", small, "cage.ply", "wo.npy", "--quiet"], reproduction("wo.npy"))
    weights.peer("VTK 9.1 (1 thread)", [*vtk, "weights", small, "cage.ply", "wv.npy"], reproduction("wv.npy"))

    pathlib.Path("raise.edit.json").write_text(json.dumps({"format": "ostraka-edit", "version": 1, "steps": raise_steps(module, small)}))

    def strained(file):
        def rms_strain(_):
            faces, before, after = (module.Mesh(small).faces, module.Mesh(small).points, module.Mesh(file).points)
            edges = numpy.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
            lengths = [numpy.linalg.norm(p[edges[:, 0]] - p[edges[:, 1]], axis=1) for p in (before, after)]
            strain = lengths[1] / lengths[0] - 1
            return f"edges stretched by {numpy.sqrt((strain**2).mean()):.2%} rms"
        return rms_strain

    raising = Task(f"The head of {target_count:,} vertices raised, its base fixed",
                   "CGAL: as rigid as possible (spokes and rims), 10 iterations. Ostraka: Laplacian displacements to convergence, "
                   "with its checks of moved parts and of constraints.")
    raising.peer("Ostraka", [ostraka, "deform", small, "raise.edit.json", "do.ply", "--quiet"], strained("do.ply"))
    raising.peer("CGAL 5.5", [peers, "raise", "cgal", small, "dc.ply"], strained("dc.ply"))

    def wrong(labels_of):
        def wrong_fraction(_):
            truth = numpy.loadtxt("large.labels", dtype=int)
            return f"{(labels_of() != truth).mean():.3%} of the faces wrong"
        return wrong_fraction

    def ours():
        return region_labels(module, "transferred.ant.json", "large.ply", len(numpy.loadtxt("large.labels", dtype=int)))

    labels = Task(f"Parts of {target_count:,} vertices transferred to {counts}",
                  "\"Wrong\" is relative to the known parts of the object. Ostraka transfers outlines and scores them; VTK gives each face "
                  "the part of the face nearest to its centroid, from Python, one query per call.")
    labels.peer("Ostraka", [ostraka, "annotation", "transfer", "small.ply", "small.ant.json", "large.ply", "transferred.ant.json",
                            "--quiet"], wrong(ours))
    labels.peer("VTK 9.1", [*vtk, "labels", small, "small.labels", large, "vtk.labels"],
                wrong(lambda: numpy.loadtxt("vtk.labels", dtype=int)))

    summary = [task.run(arguments.laps) for task in (convert, slicing, simplify, closest, farthest, weights, raising, labels)]
    print("| work | fastest |\n|---|---|")
    for one in summary:
        print(f"| {one['task']} | {one['fastest']} |")
    shutil.rmtree(folder)


def raise_steps(module, file):
    points = module.Mesh(file).points
    low, high = points.min(axis=0), points.max(axis=0)
    height = float(high[2] - low[2])
    box = lambda a, b: {"box": {"min": [float(low[0]) - 1, float(low[1]) - 1, float(low[2]) + a * height],
                                "max": [float(high[0]) + 1, float(high[1]) + 1, float(low[2]) + b * height]}}
    return [{"select": box(0.85, 1.1), "translate": [0, 0, 0.1 * height]}, {"select": box(-0.1, 0.1), "translate": [0, 0, 0]}]


def region_labels(module, annotations, mesh, faces):
    """The recipe's regions of labels 0 to 6 are the annotations 1 to 7."""
    values = numpy.full(faces, -1)
    for identity, list_of_faces in module.Annotations(annotations).faces(mesh).items():
        if 1 <= identity <= 7:
            values[list_of_faces] = identity - 1
    return values


if __name__ == "__main__":
    main()

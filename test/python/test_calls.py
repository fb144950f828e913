"""Calls: good and bad arguments, files and objects, progress, Ctrl-C, other threads."""

import os
import pathlib
import pickle
import signal
import subprocess
import sys
import textwrap
import threading
import time

import numpy
import pytest

import ostraka
from ostraka import _functions


# ---- the same bytes as the command ----

RUNS = [
    ("mesh refine", ["teapot.ply", "fine.ply", "--vertices", "5000", "--annotations", "teapot.ant.json",
                     "--annotations-out", "fine.ant.json"],
     lambda: ostraka.mesh.refine("teapot.ply", "fine.ply", vertices=5000, annotations="teapot.ant.json",
                                 annotations_out="fine.ant.json"),
     lambda: ostraka.mesh.refine(ostraka.Mesh("teapot.ply"), "fine.ply", vertices=5000,
                                 annotations=ostraka.Annotations("teapot.ant.json"), annotations_out="fine.ant.json")),
    ("mesh convert", ["teapot.ply", "pot.obj"], lambda: ostraka.mesh.convert("teapot.ply", "pot.obj"),
     lambda: ostraka.mesh.convert(ostraka.Mesh("teapot.ply")).output.save("pot.obj")),
    ("annotation transfer", ["teapot.ply", "teapot.ant.json", "teapot.ply", "on.ant.json",
                             "--rounding", "area", "--max-angle", "60"],
     lambda: ostraka.annotation.transfer("teapot.ply", "teapot.ant.json", "teapot.ply", "on.ant.json", rounding="area",
                                         max_angle=60),
     lambda: ostraka.annotation.transfer(ostraka.Mesh("teapot.ply"), pathlib.Path("teapot.ant.json"),
                                         ostraka.Mesh("teapot.ply"), "on.ant.json", rounding="area",
                                         max_angle=numpy.float32(60))),
    ("measure take", ["teapot.ply", "--annotations", "teapot.ant.json", "--tool", "tape", "--at=0,-59,50", "--at=0,-35,95",
                      "--annotation", "body", "--name", "belly", "--output", "measured.ant.json"],
     lambda: ostraka.measure.take("teapot.ply", annotations="teapot.ant.json", tool="tape", at=["0,-59,50", "0,-35,95"],
                                  annotation="body", name="belly", output="measured.ant.json"),
     lambda: ostraka.measure.take(ostraka.Mesh("teapot.ply"), annotations="teapot.ant.json", tool="tape",
                                  at=[(0, -59, 50), numpy.array([0.0, -35.0, 95.0])], annotation="body", name="belly",
                                  output="measured.ant.json")),
    ("measure map", ["teapot.ply", "curvature.npy", "--of", "mean-curvature"],
     lambda: ostraka.measure.map("teapot.ply", "curvature.npy", of="mean-curvature"),
     lambda: ostraka.measure.map("teapot.ply", of="mean-curvature").output.save("curvature.npy")),
    ("relation extract", ["teapot.ply", "teapot.ant.json", "teapot.graph.json"],
     lambda: ostraka.relation.extract("teapot.ply", "teapot.ant.json", "teapot.graph.json"),
     lambda: ostraka.relation.extract(ostraka.Mesh("teapot.ply"), "teapot.ant.json").output.save("teapot.graph.json")),
    ("render", ["teapot.ply", "pot.png", "--size", "300x200", "--annotations", "teapot.ant.json"],
     lambda: ostraka.render("teapot.ply", "pot.png", size="300x200", annotations="teapot.ant.json"),
     lambda: ostraka.render([ostraka.Mesh("teapot.ply")], size="300x200",
                            annotations=[ostraka.Annotations("teapot.ant.json")]).picture.save("pot.png")),
    ("slice", ["teapot.ply", "--count", "5", "--output", "slices"],
     lambda: ostraka.slice("teapot.ply", count=5, output="slices"),
     lambda: ostraka.slice(ostraka.Mesh("teapot.ply"), count=5, output=True).output.save("slices")),
]


def files_in(folder):
    return {str(file.relative_to(folder)): file.read_bytes() for file in sorted(folder.rglob("*"))
            if file.is_file() and not file.name.startswith(".")}


@pytest.mark.parametrize("name, words, on_files, on_objects", RUNS, ids=[run[0] for run in RUNS])
def test_files_are_those_of_the_command(name, words, on_files, on_objects, data, tmp_path, command, monkeypatch):
    made = []
    for way in ("command", on_files, on_objects):
        folder = tmp_path / str(len(made))
        folder.mkdir()
        for file in ("teapot.ply", "teapot.ant.json"):
            (folder / file).symlink_to(data / file)
        monkeypatch.chdir(folder)
        if way == "command":
            done = subprocess.run([os.environ["OSTRAKA_COMMAND"], *name.split(), *words],
                                  capture_output=True, text=True, check=False)
            assert done.returncode in (0, 3), done.stderr
        else:
            way()
        made.append(files_in(folder))
    assert len(made[0]) > 2 and made[0] == made[1] == made[2]


def test_text_of_a_report_is_that_of_the_command(data, command):
    words = ("annotation", "list", data / "teapot.ply", data / "teapot.ant.json")
    report = ostraka.annotation.list(data / "teapot.ply", data / "teapot.ant.json").report
    assert repr(report) == command(*words).stdout.rstrip("\n")
    assert report.to_csv() == command(*words, "--show", "csv").stdout
    assert report.to_markdown() == command(*words, "--show", "markdown").stdout


# ---- arguments ----

def transfer(data, **options):
    return ostraka.annotation.transfer(data / "teapot.ply", data / "teapot.ant.json", data / "teapot.ply", **options)


@pytest.mark.parametrize("options, message", [
    ({"roundin": "area"}, "no parameter 'roundin' .did you mean 'rounding'"),
    ({"max-angle": 3}, "did you mean 'max_angle'"),
    ({"xyzzy": 3}, "no parameter 'xyzzy'"),
    ({"rounding": "are"}, "did you mean 'area'"),
    ({"rounding": 3}, "one of: path"),
    ({"max_angle": 1000}, "option max_angle is 1000 .use a value from 0 to 180"),
    ({"max_angle": float("nan")}, "0 to 180"),
    ({"max_angle": "wide"}, "0 to 180"),
    ({"max_angle": [1, 2]}, "max_angle"),
    ({"max_angle": {}}, "max_angle"),
    ({"refine": "yes"}, "true or false"),
    ({"refine": 1}, "true or false"),
    ({"output": 3}, "output is of the type int"),
    ({"output": ""}, "empty"),
    ({"output": "memory:"}, "without a name"),
    ({"back": "a\0b"}, "zero byte"),
    ({"progress": 3}, "cannot be called"),
])
def test_wrong_options_are_named(data, options, message):
    with pytest.raises(ostraka.UsageError, match=message) as refused:
        transfer(data, **options)
    assert isinstance(refused.value, ValueError) and refused.value.kind == "usage"


def test_wrong_arguments_are_type_errors(data):
    pot = data / "teapot.ply"
    for call, message in ((lambda: ostraka.mesh.info(), "input is missing"),
                          (lambda: ostraka.mesh.info(None), "input is missing"),
                          (lambda: ostraka.mesh.info(pot, pot), "2 arguments"),
                          (lambda: ostraka.mesh.info(pot, input=pot), "given twice"),
                          (lambda: ostraka.mesh.info(pot, inputs=pot), "did you mean 'input'")):
        with pytest.raises(TypeError, match=message) as refused:
            call()
        assert isinstance(refused.value, ostraka.ArgumentError) and refused.value.where == "mesh info"


@pytest.mark.parametrize("wrong", [3, 2.5, object(), numpy.zeros((3, 3)), [], "memory:x.ply", "", "a\0b.ply"])
def test_wrong_objects_are_refused(wrong):
    with pytest.raises(ostraka.UsageError):
        ostraka.mesh.info(wrong)


def test_files_that_are_not_there_or_not_that(data, tmp_path):
    with pytest.raises(ostraka.InputError, match="cannot be opened") as refused:
        ostraka.mesh.info("/nowhere/pot.ply")
    assert refused.value.where == "/nowhere/pot.ply" and refused.value.kind == "input" and refused.value.remedy
    wrong = tmp_path / "wrong.ply"
    wrong.write_bytes(b"ply\nno mesh\xff")
    for given in (wrong, wrong.read_bytes()):
        with pytest.raises(ostraka.InputError, match="(wrong|input).ply"):
            ostraka.mesh.info(given)
    with pytest.raises(ostraka.InputError, match="another mesh"):
        ostraka.annotation.list(data / "teapot.ply", data / "chair.ant.json")
    with pytest.raises(ostraka.InputError, match="annotations.ant.json: at /annotations/0"):
        ostraka.annotation.list(data / "teapot.ply", {"annotations": [1]})
    with pytest.raises(ostraka.InputError, match="not a JSON document"):
        ostraka.annotation.list(data / "teapot.ply", {"annotations": float("nan")})
    with pytest.raises(ostraka.UsageError):
        ostraka.mesh.convert(data / "teapot.ply", tmp_path / "pot.xyz")
    with pytest.raises(ostraka.WorkError, match="folder"):
        ostraka.mesh.convert(data / "teapot.ply", tmp_path / "none" / "pot.ply")
    with pytest.raises(ostraka.UsageError, match="same file|input"):
        ostraka.mesh.convert(wrong, wrong)


def test_errors_can_be_pickled():
    error = ostraka.InputError("is not there", "pot.ply", "look for it")
    again = pickle.loads(pickle.dumps(error))
    assert str(again) == "pot.ply: is not there (look for it)" and type(again) is ostraka.InputError
    assert (again.kind, again.where, again.problem, again.remedy) == ("input", "pot.ply", "is not there", "look for it")


def test_numbers_of_numpy_are_numbers(data):
    plain = transfer(data, max_angle=60, refine=False).report
    assert transfer(data, max_angle=numpy.float64(60), refine=numpy.bool_(False)).report.provenance == plain.provenance
    refined = ostraka.mesh.refine(data / "teapot.ply", vertices=numpy.int32(5000))
    assert refined.report.provenance["options"]["vertices"] == "5000"


def test_file_names_of_every_kind(data, tmp_path):
    odd = tmp_path / "Tôpf \udcff.ply"
    for name in (odd, str(odd)):
        ostraka.mesh.convert(data / "teapot.ply", name)
        assert odd.exists() and len(ostraka.Mesh(name).points) == 4000
        odd.unlink()


# ---- outputs ----

def test_outputs_stay_in_memory_or_are_written(data, tmp_path):
    made = transfer(data)
    assert isinstance(made.output, ostraka.Annotations) and made.back is None and made["output"] is made.output
    made = transfer(data, output=tmp_path / "on.ant.json", back=True)
    assert made.output == tmp_path / "on.ant.json" and made.output.exists()
    assert isinstance(made.back, ostraka.Annotations) and len(made.back) == len(ostraka.Annotations(made.output))
    assert transfer(data, back=False).back is None


def test_an_output_in_memory_is_called_as_its_file_would_be(data):
    made = ostraka.vocabulary.convert(data / "terracotta.vocabulary.json", "memory:words.ttl")
    assert made.output.name == "words.ttl" and "@prefix" in made.output.text
    again = ostraka.vocabulary.convert(made.output)
    assert ostraka.vocabulary.check(again.output).holds
    pot = ostraka.mesh.refine(data / "teapot.ply", "memory:pot.ply", vertices=5000).output
    assert pot.name == "pot.ply"
    on = ostraka.annotation.transfer(data / "teapot.ply", data / "teapot.ant.json", pot).output
    assert on["mesh"]["file"] == "pot.ply"


def test_objects_go_from_call_to_call(data, tmp_path):
    pot = ostraka.mesh.make("teapot", True, vertices=2500, labels=True)
    annotated = ostraka.annotation.apply(pot.output, data / "teapot.recipe.json")
    by_label = ostraka.annotation.apply(pot.output, pot.labels)
    by_array = ostraka.annotation.apply(pot.output, numpy.loadtxt(pot.labels.text.split(), dtype=int))
    assert [one["boundaries"] for one in by_label.output] == [one["boundaries"] for one in by_array.output]
    graph = ostraka.relation.extract(pot.output, annotated.output)
    assert ostraka.relation.check(pot.output, annotated.output, graph.output).holds
    cage = ostraka.cage.make(pot.output, vertices=100)
    weights = ostraka.cage.weights(pot.output, cage.output)
    assert weights.output.array.shape == (2500, len(cage.output.points))
    assert numpy.allclose(numpy.asarray(weights.output).sum(axis=1), 1)
    assert numpy.allclose(weights.output.array @ cage.output.points, pot.output.points)
    raised = ostraka.deform(pot.output, annotated.output, data / "teapot-stretch.edit.json", cage=cage.output,
                            weights=weights.output)
    assert len(raised.output.points) == 2500
    template = ostraka.template.pack(mesh=pot.output, annotations=annotated.output, graph=graph.output).output
    assert isinstance(template, ostraka.Template)
    assert ostraka.template.check(template).holds
    template.save(tmp_path / "pot.template.json")
    assert ostraka.template.check(tmp_path / "pot.template.json").holds


def test_values_are_arrays(data, teapot):
    made = ostraka.measure.map(teapot, of="mean-curvature").output
    assert made.array.shape == (4000,) and numpy.shares_memory(made.array, made.array)
    described, same = (ostraka.measure.describe(teapot, annotations=data / "teapot.ant.json", map={"bend": given},
                                                output=True).output for given in (made.array, made))
    assert "bend" in described.to_bytes().decode()
    assert list(described)[1]["attributes"] == list(same)[1]["attributes"]


def test_folders_hold_files(teapot, tmp_path):
    folder = ostraka.slice(teapot, count=4, output=True).output
    assert isinstance(folder, ostraka.Folder) and len(folder) > 1
    name = next(iter(folder))
    folder.save(tmp_path / "slices")
    assert (tmp_path / "slices" / name).read_bytes() == folder[name].to_bytes()


def test_annotations_are_dicts(data, teapot):
    annotations = ostraka.Annotations(data / "teapot.ant.json")
    assert annotations["spout"]["id"] == 5 and annotations[5]["tag"] == "spout" and annotations["unit"] == "mm"
    assert len(annotations) == len(list(annotations)) == len(annotations.tags)
    with pytest.raises(KeyError, match="did you mean 'spout'"):
        annotations["sprout"]
    faces, labels = annotations.faces(teapot), annotations.labels(teapot)
    assert len(labels) == 8000 and (labels[faces[5]] == 5).all()
    with pytest.raises(ostraka.InputError, match="another mesh"):
        annotations.faces(data / "chair.ply")
    document = annotations.document
    document["annotations"] = [one for one in document["annotations"] if one["tag"] in ("spout", "lid")]
    fewer = ostraka.Annotations(document)
    assert ostraka.annotation.list(teapot, fewer).report.tables["annotations"]["tag"].tolist() == ["lid", "spout"]
    for wrong in (3, None):
        with pytest.raises(ostraka.UsageError):
            ostraka.Annotations(wrong)
    with pytest.raises(ostraka.InputError, match="no list of annotations"):
        len(ostraka.Annotations({"a": 1}))


def test_an_input_brought_up_to_date_stays_as_it_is_in_memory(data, teapot):
    annotations = ostraka.Annotations(data / "teapot.ant.json")
    made = ostraka.annotation.select(teapot, annotations, nearest=(0, 0, 200), tag="top")
    assert "top" in made.output.tags and "top" not in annotations.tags


def test_the_answer_no_is_no_error(data):
    assert not ostraka.annotation.diff(data / "teapot.ply", data / "teapot.ant.json", {
        **ostraka.Annotations(data / "teapot.ant.json").document, "annotations": []}).holds


# ---- progress, signals, threads ----

def test_progress_is_told(teapot):
    told = []
    ostraka.mesh.refine(teapot, vertices=300_000, progress=lambda phase, share: told.append((phase, share)))
    assert told and all(phase and 0 <= share <= 1 for phase, share in told)


def test_progress_can_stop_the_work(teapot, tmp_path):
    def stop(phase, share):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        ostraka.mesh.refine(teapot, tmp_path / "fine.ply", vertices=1_000_000, progress=stop)
    assert list(tmp_path.iterdir()) == []


def test_progress_is_drawn(teapot, capfd):
    ostraka.mesh.refine(teapot, vertices=300_000, progress=True)
    assert capfd.readouterr().err.endswith("\r\033[K")
    _functions.progress_bar("refine", 0.5)
    assert capfd.readouterr().err.startswith("\rrefine  50 %")


def test_other_threads_go_on(teapot):
    """Python's lock is free while an operation works: another thread counts on."""
    counted, ended = [0], threading.Event()

    def count():
        while not ended.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    before = counted[0]
    ostraka.mesh.refine(teapot, vertices=300_000)
    during = counted[0] - before
    ended.set()
    thread.join()
    assert during >= 3


def test_several_threads_call_at_once(data):
    results = [None] * 4

    def work(i):
        results[i] = transfer(data).output.to_bytes()

    threads = [threading.Thread(target=work, args=(i,)) for i in range(len(results))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert results[0] is not None and len(set(results)) == 1


INTERRUPTED = """
    import os, signal, sys, threading, ostraka
    handler = sys.argv[2]
    if handler == "other":
        class Enough(Exception): pass
        def raises(number, frame): raise Enough
        signal.signal(signal.SIGINT, raises)
    sent = []
    def interrupt(phase, share):
        if not sent:
            sent.append(phase)
            os.kill(os.getpid(), signal.SIGINT)
    try:
        ostraka.mesh.refine(sys.argv[1], "fine.ply", vertices=3_000_000, progress=interrupt)
    except BaseException as error:
        print(type(error).__name__)
    else:
        print("finished")
    print(len(ostraka.Mesh(sys.argv[1]).points), sorted(os.listdir(".")))
"""


@pytest.mark.parametrize("handler, expected", [("own", "KeyboardInterrupt"), ("other", "Enough")])
def test_control_c_stops_the_work(data, tmp_path, handler, expected):
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(INTERRUPTED), data / "teapot.ply", handler], cwd=tmp_path,
                          capture_output=True, text=True, timeout=120, check=False)
    assert done.stdout.splitlines() == [expected, "4000 []"], done.stderr


def test_control_c_from_outside(data, tmp_path):
    program = "import ostraka, sys; print('begun', flush=True); " \
              "ostraka.mesh.refine(sys.argv[1], 'fine.ply', vertices=5_000_000)"
    running = subprocess.Popen([sys.executable, "-c", program, data / "teapot.ply"], cwd=tmp_path, stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
    assert running.stdout.readline() == "begun\n"
    time.sleep(0.3)
    running.send_signal(signal.SIGINT)
    _, errors = running.communicate(timeout=120)
    assert "KeyboardInterrupt" in errors and running.returncode == -signal.SIGINT
    assert list(tmp_path.iterdir()) == []


def test_the_number_of_threads_changes_no_result(data):
    before = ostraka.threads()
    try:
        made = []
        for count in (1, 3):
            ostraka.set_threads(count)
            assert ostraka.threads() == count
            made.append(transfer(data).output.to_bytes())
        assert made[0] == made[1]
        ostraka.set_threads(0)
        assert ostraka.threads() >= 1
    finally:
        ostraka.set_threads(before)
    for wrong in (-1, 1025, "two", 1.5, True):
        with pytest.raises(ostraka.UsageError):
            ostraka.set_threads(wrong)


def test_a_forked_process_can_work(data):
    """As multiprocessing does: no thread that was there before is needed."""
    transfer(data)
    child = os.fork()
    if child == 0:
        code = 1
        try:
            code = 0 if len(transfer(data).output) > 0 else 1
        finally:
            os._exit(code)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0

"""What the module does to the process and takes of the machine: memory, threads that wait, the umask, programs."""

import json
import os
import subprocess
import sys
import threading

import pytest

import ostraka


def in_python(program, *words, **environment):
    settings = {name: value for name, value in os.environ.items() if name != "OMP_WAIT_POLICY"} | environment
    return subprocess.run([sys.executable, "-c", program, *map(str, words)], capture_output=True, text=True, timeout=120,
                          check=False, env=settings)


# ---- memory ----

@pytest.fixture
def unlimited():
    yield
    ostraka.set_memory_limit(0)


def test_the_memory_limit_is_set(unlimited):
    machine = ostraka.memory_limit()
    assert machine > 0.1
    ostraka.set_memory_limit(2.5)
    assert ostraka.memory_limit() == 2.5
    ostraka.set_memory_limit(0)
    assert ostraka.memory_limit() == machine
    for wrong in (-1, float("nan"), float("inf"), "1", True, None):
        with pytest.raises(ostraka.UsageError, match="memory limit"):
            ostraka.set_memory_limit(wrong)


def test_work_beyond_the_limit_is_refused_in_words(unlimited, data):
    cage = ostraka.cage.make(data / "teapot.ply", vertices=100).output
    ostraka.set_memory_limit(0.001)  # less than the process occupies already
    with pytest.raises(ostraka.WorkError, match="memory") as refused:
        ostraka.cage.weights(data / "teapot.ply", cage)
    assert "ostraka.set_memory_limit" in refused.value.problem and refused.value.where and refused.value.remedy
    ostraka.set_memory_limit(0)
    assert len(ostraka.cage.weights(data / "teapot.ply", cage).output.array) == 4000


def test_used_up_memory_is_said_in_words():
    """Where the system gives no more, the call fails, and the process lives on."""
    program = """if True:
        import resource, ostraka
        mesh = ostraka.mesh.make("teapot", True, vertices=2500).output
        used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + 300_000_000, used + 300_000_000))
        try:
            ostraka.mesh.refine(mesh, vertices=10_000_000)
        except (ostraka.WorkError, MemoryError) as error:
            print(type(error).__name__)
        print(ostraka.mesh.info(mesh).holds)
    """
    done = in_python(program)
    assert done.stdout.splitlines() == ["WorkError", "True"], done.stdout + done.stderr


# ---- threads that wait ----

def test_threads_that_wait_sleep():
    show = "import ostraka, os; print(os.environ['OMP_WAIT_POLICY'])"
    assert in_python(show).stdout == "passive\n"
    assert in_python(show, OMP_WAIT_POLICY="active").stdout == "active\n"


def test_openmp_has_read_it():
    """OpenMP reads it as it is loaded, and shows what it has read."""
    shown = in_python("import ostraka", OMP_DISPLAY_ENV="true").stderr
    assert "OMP_WAIT_POLICY = 'PASSIVE'" in shown


def test_openmp_that_was_loaded_before_is_kept_from_spinning():
    """Two threads that sleep make it count more threads than cores; operations work on, also in a process that is forked."""
    program = """if True:
        import ctypes, multiprocessing, os, time, numpy
        ctypes.CDLL("libgomp.so.1")
        before = len(os.listdir("/proc/self/task"))
        import ostraka
        deadline = time.monotonic() + 20
        while len(os.listdir("/proc/self/task")) < before + 2 and time.monotonic() < deadline:
            time.sleep(0.01)
        print(len(os.listdir("/proc/self/task")) - before)
        mesh = ostraka.mesh.make("teapot", True, vertices=2500).output
        with multiprocessing.get_context("fork").Pool(1) as pool:
            [info] = pool.map(ostraka.mesh.info, [mesh])
        print(repr(info) == repr(ostraka.mesh.info(mesh)))
    """
    done = in_python(program)
    assert done.stdout.splitlines() == ["2", "True"] and done.returncode == 0, done.stderr


# ---- the umask ----

def test_the_umask_is_left_alone(tetrahedron, tmp_path):
    """Files written by several threads have the rights that the umask leaves, while others read it all the time."""
    mesh = ostraka.Mesh(*tetrahedron)
    before = os.umask(0o027)
    ended, seen, failures = threading.Event(), set(), []

    def watch():
        while not ended.is_set():
            with open("/proc/self/status", encoding="ascii") as status:
                seen.add(next(line.split()[1] for line in status if line.startswith("Umask")))

    def write(number):
        try:
            for i in range(60):
                mesh.save(tmp_path / f"{number}-{i}.ply")
                ostraka.mesh.convert(mesh, tmp_path / f"{number}-{i}.obj")
        except Exception as error:
            failures.append(error)

    try:
        watchers = [threading.Thread(target=watch) for _ in range(2)]
        writers = [threading.Thread(target=write, args=(number,)) for number in range(4)]
        for thread in watchers + writers:
            thread.start()
        for thread in writers:
            thread.join()
        ended.set()
        for thread in watchers:
            thread.join()
    finally:
        assert os.umask(before) == 0o027
    assert not failures and seen == {"0027"}
    files = list(tmp_path.iterdir())
    assert len(files) == 4 * 60 * 2 and {file.stat().st_mode & 0o777 for file in files} == {0o640}


# ---- programs ----

@pytest.fixture
def study(tmp_path):
    """One that starts a program which is not the toolkit's own."""
    folder = tmp_path / "programs"
    folder.mkdir()
    program = folder / "stranger"
    program.write_text(f"#!/bin/sh\ntouch {tmp_path / 'started'}\ntouch \"$1/made.txt\"\n")
    program.chmod(0o755)
    file = tmp_path / "s.study.json"
    file.write_text(json.dumps({"format": "ostraka-study", "version": 1,
                                "steps": {"a": {"program": ["stranger", "${folder}"]}}}))
    return file


def test_programs_of_strangers_are_refused(study, tmp_path):
    with pytest.raises(ostraka.InputError, match="stranger") as refused:
        ostraka.run(study, output=tmp_path / "out", programs=tmp_path / "programs")
    assert "not a program of the toolkit" in refused.value.problem and "allow" in refused.value.remedy
    assert not (tmp_path / "started").exists() and not (tmp_path / "out").exists()
    shown = ostraka.run(study, output=tmp_path / "out", programs=tmp_path / "programs", dry_run=True)
    assert "'stranger'" in shown.report.tables["programs"][0]["words"] and not (tmp_path / "started").exists()


def test_programs_run_where_the_caller_allows_them(study, tmp_path):
    made = ostraka.run(study, output=tmp_path / "out", programs=tmp_path / "programs", allow_programs=True)
    assert made.holds and (tmp_path / "started").exists()
    (tmp_path / "started").unlink()
    with pytest.raises(ostraka.InputError, match="stranger"):
        ostraka.replay(tmp_path / "out", programs=tmp_path / "programs")
    assert not (tmp_path / "started").exists()
    assert ostraka.replay(tmp_path / "out", programs=tmp_path / "programs", allow_programs=True).holds


def test_other_programs_beside_python_are_none_of_ours(tmp_path):
    file = tmp_path / "s.study.json"
    file.write_text(json.dumps({"format": "ostraka-study", "version": 1, "steps": {
        "a": {"program": ["sh", "-c", f"touch {tmp_path / 'started'}"]}}}))
    with pytest.raises(ostraka.InputError, match="not a program of the toolkit"):
        ostraka.run(file, output=tmp_path / "out")
    assert not (tmp_path / "started").exists()

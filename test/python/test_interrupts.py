"""Interrupts: whatever thread has called an operation, it ends soon, and leaves nothing behind."""

import ctypes
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import pytest

import ostraka

PROGRAM = """
    import os, signal, sys, threading, time
    from concurrent.futures import ThreadPoolExecutor
    import ostraka

    pot, ways = ostraka.Mesh(sys.argv[1]), sys.argv[2]
    began = threading.Event()

    def interrupt():
        began.wait()
        os.kill(os.getpid(), signal.SIGINT)

    def work(number=0):
        try:
            # Minutes of work, for which a short-lived file is written as well.
            ostraka.mesh.refine(pot, f"fine-{number}.ply", vertices=5_000_000, progress=lambda phase, share: began.set())
        except BaseException as error:
            print("ended by", type(error).__name__, flush=True)
            raise

    threading.excepthook = lambda error: None
    threading.Thread(target=interrupt, daemon=True).start()
    if ways == "main":
        work()
    elif ways == "pool":
        with ThreadPoolExecutor() as pool:
            list(pool.map(work, range(2)))
    else:
        thread = threading.Thread(target=work, daemon=ways == "daemon")
        thread.start()
        while thread.is_alive():
            time.sleep(0.05)
"""


@pytest.mark.parametrize("ways, ended", [("main", 1), ("pool", 2), ("thread", 1), ("daemon", None)])
def test_control_c_ends_the_work_of_every_thread(ways, ended, data, tmp_path):
    folder, temporary = tmp_path / "folder", tmp_path / "temporary"
    folder.mkdir(), temporary.mkdir()
    done = subprocess.run([sys.executable, "-c", textwrap.dedent(PROGRAM), data / "teapot.ply", ways], cwd=folder,
                          capture_output=True, text=True, timeout=60, check=False, env=os.environ | {"TMPDIR": str(temporary)})
    assert done.returncode == -signal.SIGINT and "KeyboardInterrupt" in done.stderr, done.stderr
    if ended is not None:
        assert done.stdout.splitlines() == ["ended by KeyboardInterrupt"] * ended
    assert list(folder.iterdir()) == [] and list(temporary.iterdir()) == []


class Enough(Exception):
    """What another thread raises."""


def test_what_another_thread_raises_ends_the_work(teapot, tmp_path):
    """As tools do that stop a thread, by PyThreadState_SetAsyncExc."""
    began, seen = threading.Event(), []

    def work():
        try:
            ostraka.mesh.refine(teapot, tmp_path / "fine.ply", vertices=5_000_000, progress=lambda phase, share: began.set())
        except Enough as error:
            seen.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    began.wait()
    ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread.ident), ctypes.py_object(Enough))
    thread.join(30)
    assert not thread.is_alive() and len(seen) == 1 and list(tmp_path.iterdir()) == []


def interrupted(work):
    """Whether an interrupt half a second later has ended it."""
    timer = threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    try:
        work()
    except KeyboardInterrupt:
        return True
    finally:
        timer.join()
    return False


def test_the_module_works_on_after_an_interrupt(teapot, tmp_path):
    """Also while what was interrupted still ends; it leaves neither files nor objects nor threads."""
    expected = ostraka.mesh.refine(teapot, vertices=5000)
    for _ in range(2):
        assert interrupted(lambda: ostraka.mesh.refine(teapot, tmp_path / "fine.ply", vertices=5_000_000))
        assert interrupted(lambda: ostraka.mesh.refine(teapot, vertices=5_000_000))
        again = ostraka.mesh.refine(teapot, vertices=5000)
        assert again.output.to_bytes() == expected.output.to_bytes()
        assert again.report.provenance == expected.report.provenance
    deadline = time.monotonic() + 60
    while len(os.listdir("/proc/self/task")) > threading.active_count() and time.monotonic() < deadline:
        time.sleep(0.1)
    assert len(os.listdir("/proc/self/task")) == threading.active_count()
    assert list(tmp_path.iterdir()) == []


def test_checksums_are_whole_after_an_interrupt(teapot, tmp_path):
    """The checksum of an object in memory is made when it is needed first; one that was cancelled is made again."""
    fine = ostraka.mesh.refine(teapot, vertices=300_000).output

    def stop(phase, share):
        raise Enough

    for _ in range(2):
        try:
            ostraka.mesh.convert(fine, tmp_path / "fine.obj", progress=stop)
        except Enough:
            pass
        (tmp_path / "fine.obj").unlink(missing_ok=True)
    inputs = ostraka.mesh.info(fine).report.provenance["inputs"]
    assert all(len(one["sha256"]) == 64 for one in inputs) and len(inputs) == 1


def test_objects_that_are_written_while_python_ends(data, tmp_path):
    """As finalizers do; and a daemon thread that works on does not keep the process."""
    program = """if True:
        import sys, threading, ostraka
        class Keeper:
            mesh = ostraka.Mesh(sys.argv[1])
            def __del__(self):
                self.mesh.save("kept.ply")
        sys.modules["kept"] = Keeper()
        began = threading.Event()
        threading.Thread(target=ostraka.mesh.refine, args=(sys.argv[1], "fine.ply"), daemon=True,
                         kwargs={"vertices": 5_000_000, "progress": lambda phase, share: began.set()}).start()
        began.wait()
    """
    done = subprocess.run([sys.executable, "-c", program, data / "teapot.ply"], cwd=tmp_path, capture_output=True, text=True,
                          timeout=60, check=False)
    assert done.returncode == 0 and "Error" not in done.stderr, done.stderr
    assert [file.name for file in tmp_path.iterdir() if file.name != "kept.ply"] == []

#!/usr/bin/env python3
"""Studies, folders of runs, sessions, kits and templates of somebody who means harm: each is refused in words before anything
happens.

    malicious_test.py COMMAND [WORD...]

WORD: only cases whose names hold it. Every case works in a folder of its own, with canaries beside it: files, folders and
programs that must be as they were afterwards, and whose contents nothing may tell.
"""
import functools
import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time

SECRET = "canary-93ab6f01de"
CASES = []
TIME_LIMIT = 60  # seconds

PLY = """ply
format ascii 1.0
comment {comment}
element vertex 4
property double x
property double y
property double z
element face 4
property list uchar int vertex_indices
end_header
{first} 0 0
0 1 0
0 0 1
0 0 0
3 0 1 2
3 0 2 3
3 0 3 1
3 1 3 2
"""
BALL = {"operation": "mesh make", "keep": ["output"], "with": {"object": "sphere", "vertices": 200}}


def write(name, text):
    os.makedirs(os.path.dirname(name) or ".", exist_ok=True)
    with open(name, "w", encoding="utf-8") as stream:
        stream.write(text if isinstance(text, str) else json.dumps(text))


def read(name):
    with open(name, encoding="utf-8") as stream:
        return json.load(stream)


def state(folder):
    """Names, kinds, sizes and times of all that lies in a folder."""
    rows = []
    for place, folders, files in os.walk(folder):
        for name in sorted(folders) + sorted(files):
            path = os.path.join(place, name)
            known = os.lstat(path)
            is_folder = os.path.isdir(path) and not os.path.islink(path)
            rows.append((path, known.st_mode, 0 if is_folder else known.st_size, 0 if is_folder else known.st_mtime_ns,
                         os.readlink(path) if os.path.islink(path) else ""))
    return sorted(rows)


class Place:
    """A folder "work" with what was received, and canaries beside it."""

    def __init__(self, root, command):
        self.command, self.root = command, root
        self.work, self.out = os.path.join(root, "work"), os.path.join(root, "canaries")
        os.makedirs(self.work)
        os.makedirs(os.path.join(root, "tmp"))
        write(os.path.join(self.out, "secret.txt"), SECRET + "\n")
        write(os.path.join(self.out, "secret.json"), {SECRET: 1})
        write(os.path.join(self.out, "secret.ply"), PLY.format(comment=SECRET, first="271828.1875"))
        write(os.path.join(self.out, "folder", "inner.txt"), SECRET + "\n")
        write(os.path.join(self.out, "folder", "report.json"), {SECRET: 1})
        self.plant_program(os.path.join(self.out, "program"))
        self.canaries = state(self.out)

    def plant_program(self, name):
        write(name, f"#!/bin/sh\necho > '{self.out}/made'\n")
        os.chmod(name, 0o755)

    def inside(self, *names):
        return os.path.join(self.work, *names)

    def outside(self, *names):
        return os.path.join(self.out, *names)

    def link(self, name, to):
        path = self.inside(name)
        if os.path.isdir(path) and not os.path.islink(path):
            shutil.rmtree(path)
        elif os.path.lexists(path):
            os.remove(path)
        os.symlink(to, path)

    def environment(self):
        return {**os.environ, "TMPDIR": os.path.join(self.root, "tmp"), "HOME": os.path.join(self.root, "tmp")}

    def call(self, *words):
        return subprocess.run([self.command, *words], cwd=self.work, capture_output=True, text=True, errors="replace", check=False,
                              timeout=TIME_LIMIT, env=self.environment(), stdin=subprocess.DEVNULL)

    def call_until_address(self, *words):
        """A workbench, until it ends or says its address: then it is ended, with exit code 0."""
        with subprocess.Popen([self.command, *words], cwd=self.work, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              env=self.environment(), stdin=subprocess.DEVNULL) as child:
            said, end = "", time.monotonic() + TIME_LIMIT
            while child.poll() is None and "127.0.0.1" not in said and time.monotonic() < end:
                if select.select([child.stdout], [], [], 0.1)[0]:
                    said += child.stdout.readline()
            ended = child.poll() is not None
            if not ended:
                child.kill()
            out, err = child.communicate()
            return subprocess.CompletedProcess(words, child.returncode if ended else 0, said + out, err)

    def check_canaries(self):
        assert state(self.out) == self.canaries, "the canaries are no longer as they were"
        assert sorted(os.listdir(self.root)) == ["canaries", "tmp", "work"], os.listdir(self.root)


def refused(*places, changes=False):
    """A case whose function prepares the folder and gives the words of a call: it is refused, and the message names the places.
    `changes`: what lies in the folder may have changed."""

    def register(function):
        @functools.wraps(function)
        def test(place):
            words = function(place)
            before = state(place.work)
            done = place.call_until_address(*words) if words[0] == "workbench" else place.call(*words)
            place.check_canaries()
            for text in (done.stdout, done.stderr):
                assert SECRET not in text and "271828" not in text, "it tells what a canary holds: " + text[:500]
            assert done.returncode in (1, 2), f"exit code {done.returncode}: {(done.stderr or done.stdout)[-1500:]}"
            message = done.stderr.strip().splitlines()[-1] if done.stderr.strip() else ""
            for named in places:
                assert named in message, f"'{named}' is not named: {message}"
            assert message.endswith(")") and "(" in message, f"there is no remedy: {message}"
            assert "internal error" not in message, message
            assert changes or state(place.work) == before, "something was written before it was refused"

        CASES.append((function.__name__, test))
        return function

    return register


def harmless(function):
    """What is in order is done: else the others prove nothing."""
    CASES.append((function.__name__, function))
    return function


# ---- studies ----

def study(place, steps, name="x.study.json", **members):
    write(place.inside("sphere.ply"), PLY.format(comment="a tetrahedron", first="1"))
    write(place.inside(name), {"format": "ostraka-study", "version": 1, **members, "steps": steps})
    return ["run", name]


@harmless
def a_harmless_study(place):
    done = place.call(*study(place, {"a": BALL, "b": {"operation": "mesh info", "with": {"input": "sphere.ply"}}}))
    assert done.returncode == 0, done.stderr
    place.check_canaries()


@refused("x.study.json", "/steps/a/program/0", "allow-programs")
def a_study_that_starts_a_shell(place):
    return study(place, {"a": {"program": ["sh", "-c", f"echo > {place.outside('made')}"]}})


@refused("x.study.json", "/steps/a/program")
def a_study_that_starts_a_program_beside_it(place):
    place.plant_program(place.inside("helper"))
    return study(place, {"a": {"program": ["helper"]}})


@refused("x.study.json", "/steps/a/program")
def a_study_that_starts_a_program_by_its_path(place):
    return study(place, {"a": {"program": [place.outside("program")]}})


@refused("x.study.json", "/steps/a/program")
def a_study_that_starts_a_program_above(place):
    return study(place, {"a": {"program": ["../canaries/program"]}})


@refused("x.study.json", "/steps/a/program")
def a_shell_among_harmless_steps(place):
    return study(place, {"ball": BALL, "a": {"program": ["sh", "-c", f"echo > {place.outside('made')}"]}})


@refused("x.study.json", "/steps/a/program")
def a_shell_by_a_parameter(place):
    return study(place, {"a": {"program": ["${what}", "-c", f"echo > {place.outside('made')}"]}}, parameters={"what": "sh"})


@refused("x.study.json", "/steps/a/program")
def an_own_program_with_an_absolute_path(place):
    return study(place, {"a": {"program": ["ostraka_experiments", "technique", place.outside("made")]}})


@refused("x.study.json", "/steps/a/program")
def an_own_program_with_a_path_that_climbs(place):
    return study(place, {"a": {"program": ["ostraka_experiments", "technique", "${folder}/../../../../canaries/made"]}})


@refused("x.study.json", "/steps/a/program")
def an_own_program_with_a_path_behind_an_equals_sign(place):
    return study(place, {"a": {"program": ["ostraka_experiments", "joins", "--output=" + place.outside("made")]}})


@refused("x.study.json", "/steps/a/program")
def an_own_program_with_a_path_over_a_link(place):
    place.link("out", place.out)
    return study(place, {"a": {"program": ["ostraka_experiments", "technique", "${study}/out/made"]}})


@refused("x.study.json", "/steps/a/reads")
def a_program_that_reads_outside(place):
    return study(place, {"a": {"program": ["ostraka_experiments", "technique", "${folder}"], "reads": ["../canaries/secret.txt"]}})


@harmless
def a_dry_run_shows_programs_and_starts_none(place):
    words = study(place, {"a": {"program": ["sh", "-c", f"echo > {place.outside('made')}"]}})
    done = place.call(*words, "--dry-run")
    place.check_canaries()
    assert f"echo > {place.outside('made')}" in done.stdout + done.stderr, "the words are not shown"


@refused("x.study.json", "/steps/a/operation")
def a_study_that_runs_a_kit_with_a_program(place):
    return study(place, {"a": {"operation": "conformance run", "with": {"command": ["sh", "-c", f"echo > {place.outside('made')}"]}}})


@refused("x.study.json", "/steps/a/operation")
def a_study_that_records_a_kit(place):
    return study(place, {"a": {"operation": "conformance self", "with": {"record": True, "kit": place.out}}})


@refused("x.study.json", "/steps/a/operation")
def a_study_that_runs_a_study(place):
    study(place, {"b": {"program": ["sh"]}}, name="y.study.json")
    return study(place, {"a": {"operation": "run", "with": {"study": "y.study.json", "programs": "/bin", "allow-programs": True}}})


@refused("x.study.json", "/steps/a/operation")
def a_study_that_replays(place):
    return study(place, {"a": {"operation": "replay", "with": {"crate": "y-run"}}})


@refused("x.study.json", "/steps/a/operation")
def a_study_that_opens_a_workbench(place):
    return study(place, {"a": {"operation": "workbench", "with": {"place": place.out}}})


@refused("x.study.json", "/steps/a/with/input", "--reads")
def an_input_by_its_path(place):
    return study(place, {"a": {"operation": "mesh info", "with": {"input": place.outside("secret.ply")}}})


@refused("x.study.json", "/steps/a/with/input")
def an_input_above(place):
    return study(place, {"a": {"operation": "mesh info", "with": {"input": "../canaries/secret.ply"}}})


@refused("x.study.json", "/steps/a/with/input")
def an_input_over_a_linked_folder(place):
    place.link("out", place.out)
    return study(place, {"a": {"operation": "mesh info", "with": {"input": "out/secret.ply"}}})


@refused("x.study.json", "/steps/a/with/input")
def an_input_that_is_a_link(place):
    place.link("scan.ply", place.outside("secret.ply"))
    return study(place, {"a": {"operation": "mesh info", "with": {"input": "scan.ply"}}})


@refused("x.study.json", "/steps/a/with/input")
def an_input_that_is_a_device(place):
    return study(place, {"a": {"operation": "mesh info", "with": {"input": "/dev/zero"}}})


@refused("x.study.json")
def an_input_that_is_a_pipe(place):
    os.mkfifo(place.inside("scan.ply"))
    return study(place, {"a": {"operation": "mesh info", "with": {"input": "scan.ply"}}})


@refused("x.study.json", "/steps/a/with/input")
def an_input_by_a_parameter(place):
    return study(place, {"a": {"operation": "mesh info", "with": {"input": "${scan}"}}},
                 parameters={"scan": ["sphere.ply", "../canaries/secret.ply"]})


@refused("x.study.json", "/parameters/scan/files")
def a_pattern_by_its_path(place):
    return study(place, {"a": {"operation": "mesh info", "with": {"input": "${scan}"}}},
                 parameters={"scan": {"files": place.outside("*.ply")}})


@refused("x.study.json", "/parameters/scan/files")
def a_pattern_that_climbs(place):
    return study(place, {"a": {"operation": "mesh info", "with": {"input": "${scan}"}}},
                 parameters={"scan": {"files": "../*/secret.*"}})


@refused("x.study.json", "/parameters/scan/files")
def a_pattern_over_a_link(place):
    place.link("out", place.out)
    return study(place, {"a": {"operation": "mesh info", "with": {"input": "${scan}"}}}, parameters={"scan": {"files": "*/secret.ply"}})


@refused("x.study.json", "/steps/a")
def an_output_that_climbs(place):
    return study(place, {"a": {**BALL, "keep": {"output": "../../../../canaries/made.ply"}}})


@refused("x.study.json", "/steps/a")
def an_output_by_its_path(place):
    return study(place, {"a": {**BALL, "keep": {"output": place.outside("secret.ply")}}})


@refused("x.study.json", "/steps/a/with/output")
def an_output_among_the_settings(place):
    return study(place, {"a": {"operation": "mesh make", "with": {"object": "sphere", "output": place.outside("made.ply")}}})


@refused("x.study.json", "/steps")
def a_step_that_is_named_like_a_path(place):
    return study(place, {"../../../canaries/folder": BALL})


@refused("x.study.json", "/parameters/n")
def a_range_that_overflows(place):
    return study(place, {"a": {**BALL, "with": {"object": "sphere", "seed": "${n}"}}},
                 parameters={"n": {"from": 9223372036854775806, "to": 9223372036854775807}})


@refused("x.study.json")
def more_instances_than_can_be(place):
    ranges = {f"n{i}": {"from": 1, "to": 100000} for i in range(4)}
    with_all = {"object": "sphere", "vertices": "${n0}", "seed": "${n1}", "noise": "${n2}"}
    return study(place, {"a": {"operation": "mesh make", "with": with_all}}, parameters=ranges)


@refused("x.study.json")
def a_study_that_goes_on_behind_a_zero_byte(place):
    words = study(place, {"a": BALL})
    with open(place.inside("x.study.json"), "a", encoding="utf-8") as stream:
        stream.write("\0{\"steps\": {}}")
    return words


@refused("x.study.json")
def a_study_of_a_hundred_thousand_brackets(place):
    write(place.inside("x.study.json"), "[" * 100000)
    return ["run", "x.study.json"]


# ---- folders of runs ----

def run_folder(place):
    """The folder x-run of a study of one step, which was run."""
    words = study(place, {"ball": BALL})
    done = place.call(*words)
    assert done.returncode == 0, done.stderr
    return words


def record_with(place, output):
    words = run_folder(place)
    file = place.inside("x-run/steps/ball/record.json")
    document = read(file)
    document["outputs"]["output"] = {"sha256": "0" * 64, "kept": True, **output}
    write(file, document)
    return words


@harmless
def a_harmless_run_folder(place):
    words = run_folder(place)
    assert place.call(*words).returncode == 0
    done = place.call("replay", "x-run")
    assert done.returncode == 0, done.stderr + done.stdout
    place.check_canaries()


@refused("record.json")
def a_record_of_a_folder_by_its_path(place):
    return record_with(place, {"file": place.outside("folder"), "folder": True})


@refused("record.json")
def a_record_of_a_folder_above(place):
    return record_with(place, {"file": "../../../../canaries/folder", "folder": True})


@refused("record.json")
def a_record_of_a_file_by_its_path(place):
    return record_with(place, {"file": place.outside("secret.txt")})


@refused("record.json")
def a_record_of_a_folder_over_a_link(place):
    words = record_with(place, {"file": "out/folder", "folder": True})
    place.link("x-run/steps/ball/out", place.out)
    return words


@refused("x-run/steps/ball")
def a_step_that_is_a_link(place):
    words = run_folder(place)
    place.link("x-run/steps/ball", place.outside("folder"))
    return [*words, "--again"]


@refused("x-run/steps")
def a_folder_of_steps_that_is_a_link(place):
    words = run_folder(place)
    os.makedirs(place.outside("folder", "ball"))
    place.canaries = state(place.out)
    place.link("x-run/steps", place.outside("folder"))
    return [*words, "--again"]


def with_link(name):
    def prepare(place):
        words = run_folder(place)
        place.link(os.path.join("x-run", name), place.outside("secret.json" if name.endswith("json") else "secret.txt"))
        return [*words, "--again"]

    return prepare


for linked in ("page.md", "run.json", "run.study.json", "ro-crate-metadata.json", "steps/ball/report.json", "steps/ball/record.json",
               "steps/ball/ball.ply"):
    with_that_link = with_link(linked)
    with_that_link.__name__ = "a_link_in_place_of_" + linked.replace("/", "_")
    refused(os.path.basename(linked))(with_that_link)


@refused("page.md")
def a_page_that_is_a_link_to_nothing_yet(place):
    words = run_folder(place)
    place.link("x-run/page.md", place.outside("made"))
    return [*words, "--again"]


@refused("page.md")
def a_page_that_is_a_device(place):
    words = run_folder(place)
    place.link("x-run/page.md", "/dev/full")
    return [*words, "--again"]


@refused("run.study.json", "/steps/a/program", "allow-programs")
def a_run_whose_study_starts_a_shell(place):
    run_folder(place)
    file = place.inside("x-run/run.study.json")
    document = read(file)
    document["steps"]["a"] = {"program": ["sh", "-c", f"echo > {place.outside('made')}"]}
    write(file, document)
    return ["replay", "x-run"]


@refused("run.study.json", "/steps/a/with/input", "--reads")
def a_run_whose_study_stood_elsewhere(place):
    run_folder(place)
    document = read(place.inside("x-run/run.study.json"))
    document["steps"]["a"] = {"operation": "mesh info", "with": {"input": "secret.ply"}}
    write(place.inside("x-run/run.study.json"), document)
    request = read(place.inside("x-run/run.json"))
    request["folder"] = "../../canaries"
    write(place.inside("x-run/run.json"), request)
    return ["replay", "x-run"]


@refused("run.study.json")
def a_run_whose_parameters_are_set_elsewhere(place):
    run_folder(place)
    document = read(place.inside("x-run/run.study.json"))
    document["parameters"] = {"scan": "ball.ply"}
    document["steps"]["a"] = {"operation": "mesh info", "with": {"input": "${scan}"}}
    write(place.inside("x-run/run.study.json"), document)
    request = read(place.inside("x-run/run.json"))
    request["set"] = ["scan=" + place.outside("secret.ply")]
    write(place.inside("x-run/run.json"), request)
    return ["replay", "x-run"]


@refused("record.json")
def a_replay_of_a_record_that_leads_out(place):
    record_with(place, {"file": place.outside("folder"), "folder": True})
    return ["replay", "x-run"]


@refused("run.study.json")
def a_replay_of_a_link(place):
    run_folder(place)
    place.link("x-run/run.study.json", place.outside("secret.json"))
    return ["replay", "x-run"]


# ---- sessions ----

def session(place, parts=None, files=(), name="s001", further=()):
    """A session with the mesh ball.ply."""
    write(place.inside("ball.ply"), PLY.format(comment="a tetrahedron", first="1"))
    state_then = {"objects": [{"name": "ball", "parts": parts or {"mesh": "../ball.ply"}}], "active": 0, "files": list(files)}
    steps = [{"name": name, "title": "open ball.ply", "state": state_then}, *further]
    write(place.inside("session/session.json"), {"format": "ostraka-session", "version": 1, "place": 1, "counter": 1, "steps": steps})
    return ["workbench", ".", "--session", "session", "--no-browser"]


@harmless
def a_harmless_session(place):
    done = place.call_until_address(*session(place))
    assert done.returncode == 0 and "127.0.0.1" in done.stdout + done.stderr, done.stderr
    place.check_canaries()


@refused("session.json", "/steps/0/name")
def a_step_of_a_session_that_is_a_path(place):
    return session(place, name="../../canaries/folder")


@refused("session.json")
def a_part_by_its_path(place):
    return session(place, {"mesh": place.outside("secret.ply")})


@refused("session.json")
def a_part_above(place):
    return session(place, {"mesh": "../../canaries/secret.ply"})


@refused("session.json")
def a_part_over_a_link(place):
    place.link("out", place.out)
    return session(place, {"mesh": "../out/secret.ply"})


@refused("session.json")
def a_part_that_is_a_device(place):
    return session(place, {"mesh": "../ball.ply", "annotations": "/dev/zero"})


@refused("session.json")
def a_file_of_a_session_above(place):
    return session(place, files=[{"name": "x", "kind": "table", "file": "../../canaries/secret.txt"}])


@refused("session.json")
def a_part_of_a_step_that_was_undone(place):
    undone = {"name": "s002", "title": "x",
              "state": {"objects": [{"name": "x", "parts": {"mesh": place.outside("secret.ply")}}], "active": 0, "files": []}}
    return session(place, further=[undone])


@refused("steps")
def steps_of_a_session_that_are_a_link(place):
    words = session(place)
    place.link("session/steps", place.outside("folder"))
    return words


@refused("documents")
def documents_of_a_session_that_are_a_link(place):
    words = session(place)
    place.link("session/documents", place.outside("folder"))
    return words


@refused("s001")
def a_step_of_a_session_that_is_a_link(place):
    words = session(place)
    os.makedirs(place.inside("session/steps"))
    place.link("session/steps/s001", place.outside("folder"))
    return words


@refused("session.study.json")
def a_study_of_a_session_that_is_a_link(place):
    words = session(place)
    place.link("session/session.study.json", place.outside("secret.json"))
    return words


@refused("session.json")
def a_session_that_is_a_link(place):
    words = session(place)
    place.link("session/session.json", place.outside("secret.json"))
    return words


# ---- kits ----

def kit(place, **members):
    write(place.inside("kit/inputs/ball.ply"), PLY.format(comment="a tetrahedron", first="1"))
    case = {"id": "x", "operation": "mesh convert", "about": "a case", "with": {"input": "inputs/ball.ply"},
            "outputs": {"output": "out.ply"}, "code": 0, "compare": [{"what": "output", "as": "exists", "reason": "it is there"}],
            **members}
    write(place.inside("kit/conformance.json"), {"format": "ostraka-conformance", "version": 1, "kit": "1", "cases": [case]})
    return ["conformance", "self", "--kit", "kit"]


@harmless
def a_harmless_kit(place):
    done = place.call(*kit(place))
    assert done.returncode == 0, done.stderr + done.stdout
    place.check_canaries()


@refused("conformance.json", "/outputs/output")
def a_case_whose_output_is_elsewhere(place):
    return kit(place, outputs={"output": place.outside("secret.ply")})


@refused("conformance.json", "/outputs/output")
def a_case_whose_output_climbs(place):
    return kit(place, outputs={"output": "../../../../../../../../" + place.outside("made.ply").lstrip("/")})


@refused("conformance.json", "/outputs/output")
def a_case_whose_output_climbs_for_another_program(place):
    kit(place, outputs={"output": "../made.ply"})
    return ["conformance", "run", "--kit", "kit", "--", sys.executable, "-c", "pass"]


@refused("conformance.json", "/with/input")
def a_case_whose_input_is_elsewhere(place):
    return kit(place, **{"with": {"input": place.outside("secret.ply")}})


@refused("conformance.json", "/with/input")
def a_case_whose_input_climbs(place):
    return kit(place, **{"with": {"input": "../../canaries/secret.ply"}})


@refused("conformance.json", "/with/input")
def a_case_whose_input_is_a_link(place):
    words = kit(place)
    place.link("kit/inputs/ball.ply", place.outside("secret.ply"))
    return words


@refused("conformance.json", "/with/output")
def a_case_that_sets_an_output(place):
    return kit(place, **{"with": {"input": "inputs/ball.ply", "output": place.outside("made.ply")}})


@refused("conformance.json", "/cases/0/id")
def a_case_that_is_named_like_a_path(place):
    return kit(place, id="../../../canaries/folder")


@refused("conformance.json", "case 'x'")
def a_case_that_runs_a_kit_with_a_program(place):
    return kit(place, operation="conformance run", **{"with": {"command": ["sh", "-c", f"echo > {place.outside('made')}"]}}, outputs={})


@refused("conformance.json", "/with/allow-programs=true")
def kit_flag_in_a_name(place):
    """A name that becomes a flag with its value, in a case that expects a refusal."""
    return kit(place, operation="run", **{"with": {"study": "inputs/x.study.json", "allow-programs=true": True}}, code=2, compare=[], outputs={})


@refused("conformance.json", "/outputs/programs")
def kit_option_as_an_output(place):
    """An option that only the caller may set, named as an output."""
    return kit(place, operation="run", **{"with": {"study": "inputs/x.study.json"}}, outputs={"output": "o/", "programs": "p"})


@refused("conformance.json", "/with/allow-programs")
def a_case_that_allows_programs(place):
    write(place.inside("kit/inputs/x.study.json"), {"format": "ostraka-study", "version": 1, "steps": {
        "a": {"program": ["sh", "-c", f"echo > {place.outside('made')}"]}}})
    return kit(place, operation="run", outputs={"output": "run/"},
               **{"with": {"study": "inputs/x.study.json", "allow-programs": True}})


@refused("conformance.json", "/with/programs")
def a_case_that_names_a_folder_of_programs(place):
    write(place.inside("kit/inputs/x.study.json"), {"format": "ostraka-study", "version": 1, "steps": {"a": BALL}})
    return kit(place, operation="run", outputs={"output": "run/"}, **{"with": {"study": "inputs/x.study.json", "programs": "/bin"}})


@refused("conformance.json")
def what_is_expected_is_a_link(place):
    words = kit(place, compare=[{"what": "output", "as": "bytes", "reason": "the same"}])
    os.makedirs(place.inside("kit/expected"))
    place.link("kit/expected/x", place.outside("folder"))
    return [*words, "--record"]


# ---- templates, and what is larger than it looks ----

def template(place, **parts):
    write(place.inside("ball.ply"), PLY.format(comment="a tetrahedron", first="1"))
    write(place.inside("x.template.json"), {"format": "ostraka-template", "version": 1, "class": "ball", "mesh": "ball.ply", **parts})
    return ["template", "check", "x.template.json"]


@refused("x.template.json", "/mesh")
def a_template_whose_mesh_is_elsewhere(place):
    return template(place, mesh=place.outside("secret.ply"))


@refused("x.template.json", "/mesh")
def a_template_whose_mesh_climbs(place):
    return template(place, mesh="../canaries/secret.ply")


@refused("x.template.json", "/mesh")
def a_template_whose_mesh_is_a_link(place):
    words = template(place)
    place.link("ball.ply", place.outside("secret.ply"))
    return words


@refused("big.ply")
def a_mesh_of_more_vertices_than_there_are(place):
    write(place.inside("big.ply"), PLY.format(comment="", first="1").replace("vertex 4", "vertex 4000000000"))
    return ["mesh", "info", "big.ply"]


@refused("deep.ant.json")
def annotations_of_a_hundred_thousand_brackets(place):
    write(place.inside("ball.ply"), PLY.format(comment="", first="1"))
    write(place.inside("deep.ant.json"), "{\"a\":" * 100000)
    return ["annotation", "list", "ball.ply", "deep.ant.json"]


@refused("zero.ant.json")
def annotations_with_a_zero_byte(place):
    write(place.inside("ball.ply"), PLY.format(comment="", first="1"))
    write(place.inside("zero.ant.json"), "{\"format\": \"ostraka-annotations\", \"version\": 1, \"annotations\": []}\0{}")
    return ["annotation", "list", "ball.ply", "zero.ant.json"]


def command_with_neighbours(command, folder):
    """The command as a package installs it, where other programs stand beside it."""
    os.makedirs(folder)
    copy = os.path.join(folder, "ostraka")
    try:
        os.link(os.path.realpath(command), copy)
    except OSError:
        shutil.copy2(os.path.realpath(command), copy)
    os.symlink("/bin/sh", os.path.join(folder, "sh"))
    write(os.path.join(folder, "ostraka_experiments"), "#!/bin/sh\necho started > \"$0.started\"\n")
    write(os.path.join(folder, "helper"), "#!/bin/sh\necho started > \"$0.started\"\n")
    for name in ("ostraka_experiments", "helper"):
        os.chmod(os.path.join(folder, name), 0o755)
    return copy


def main():
    command, wanted = sys.argv[1], sys.argv[2:]
    passed = failed = 0
    with tempfile.TemporaryDirectory() as base:
        own = command_with_neighbours(command, os.path.join(base, "bin"))
        neighbours = state(os.path.join(base, "bin"))
        for name, test in CASES:
            if wanted and not any(word in name for word in wanted):
                continue
            try:
                test(Place(os.path.join(base, name), own))
                assert state(os.path.join(base, "bin")) == neighbours, "a program was started"
                passed += 1
            except (AssertionError, subprocess.TimeoutExpired, OSError) as error:
                failed += 1
                print("FAILED", name + ":", str(error)[:1500], flush=True)
                for started in os.listdir(os.path.join(base, "bin")):
                    if started.endswith(".started"):
                        os.remove(os.path.join(base, "bin", started))
    print(f"{passed} passed, {failed} failed")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

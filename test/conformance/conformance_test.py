#!/usr/bin/env python3
"""The conformance kit notices what is wrong, and only that. Run by pytest, or by itself.

OSTRAKA_COMMAND is the command, OSTRAKA_KIT the folder of the kit.
"""
import json
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree

import numpy_backend

HERE = os.path.dirname(os.path.abspath(__file__))
COMMAND = os.environ.get("OSTRAKA_COMMAND", "ostraka")
KIT = os.environ.get("OSTRAKA_KIT", os.path.join(HERE, "..", "..", "data", "conformance"))


def cases():
    with open(os.path.join(KIT, "conformance.json"), encoding="utf-8") as stream:
        return json.load(stream)["cases"]


def conformance(*words, backend=()):
    """Exit code, result of the report, and standard error of a run of the kit."""
    verb = ["run"] if backend else ["self"]
    completed = subprocess.run([COMMAND, "conformance", *verb, "--kit", KIT, "--json", *words, *(["--", *backend] if backend else [])],
                          capture_output=True, text=True, check=False)
    assert completed.returncode in (0, 3), completed.stderr[-2000:]
    return completed.returncode, json.loads(completed.stdout)["result"], completed.stderr


def only(names):
    return [word for name in sorted(names) for word in ("--only", name)]


def differing(result):
    return sorted(row["case"] for row in result["differences"])


def script(text):
    """A backend of a few lines, as the words that start it."""
    return [sys.executable, "-c", text]


def test_the_command_agrees_with_itself():
    code, result, _ = conformance()
    assert differing(result) == []
    assert code == 0 and result["agree"] == result["cases"] == len(cases()) and result["unsupported"] == 0


def test_every_operation_has_its_cases():
    completed = subprocess.run([COMMAND, "operations", "--json"], capture_output=True, text=True, check=True)
    for operation in json.loads(completed.stdout)["result"]["operations"]:
        name = operation["name"]
        if name in ("conformance run", "conformance self"):
            continue
        own_cases = [case for case in cases() if case["operation"] == name]
        assert len(own_cases) >= 3, name
        assert any(case.get("degenerate") for case in own_cases), name


def wrong(mode, operations):
    """Only operations that the mode can touch are run; all others are passed through as they are."""
    with open(os.path.join(HERE, "expected_failures.json"), encoding="utf-8") as stream:
        expected = json.load(stream)[mode]
    code, result, _ = conformance(*only(operations),
                                  backend=[sys.executable, os.path.join(HERE, "wrong_backend.py"), mode, "--", COMMAND])
    assert differing(result) == sorted(expected)
    assert code == 3 and expected


def test_a_flipped_sign_is_noticed():
    wrong("sign", {"cage weights", "cage influence", "measure map"})


def test_one_iteration_less_is_noticed():
    wrong("iteration", {case["operation"] for case in cases() if "iterations" in case["with"]} | {"mesh remesh"})


def test_another_vertex_order_is_noticed_where_the_order_is_promised():
    wrong("order", {case["operation"] for case in cases()
                    if any(file.endswith((".ply", "/")) for file in case.get("outputs", {}).values())})


def test_freedoms_allow_another_vertex_order():
    with open(os.path.join(HERE, "expected_failures.json"), encoding="utf-8") as stream:
        expected = set(json.load(stream)["order"])
    for case in cases():
        meshes = [mesh for mesh in case.get("compare", []) if mesh["as"] == "mesh"]
        if meshes and all(mesh.get("freedoms") for mesh in meshes):
            assert case["id"] not in expected, case["id"]


def test_the_numpy_backend_differs_by_its_known_weaknesses_alone():
    operations = set(numpy_backend.OPERATIONS) | {"axis"}
    code, result, _ = conformance("--lines", *only(operations),
                                  backend=[sys.executable, os.path.join(HERE, "numpy_backend.py")])
    assert differing(result) == sorted(numpy_backend.KNOWN_WEAKNESSES)
    rows = {row["operation"]: row for row in result["operations"]}
    assert rows["axis"]["unsupported"] == rows["axis"]["cases"] > 0
    assert all(rows[name]["agree"] > 0 for name in numpy_backend.OPERATIONS)
    assert code == 3 and result["agree"] + result["differ"] + result["unsupported"] == result["cases"]


# What a broken backend does is reported, and does not stop the run.

FEW = ("--only", "cage edit")


def all_differ(backend, *words, expected=""):
    code, result, _ = conformance(*FEW, *words, backend=backend)
    own_cases = sorted(case["id"] for case in cases() if case["operation"] == "cage edit")
    assert differing(result) == own_cases and code == 3
    assert any(expected in row["difference"] for row in result["differences"]), result["differences"]


def test_a_crash():
    all_differ(script("import os; os.kill(os.getpid(), 11)"), expected="signal 11")


def test_a_crash_between_lines():
    all_differ(script("import sys, os; sys.stdin.readline(); os.kill(os.getpid(), 11)"), "--lines", expected="gave no answer")


def test_a_backend_that_reads_nothing():
    all_differ(script("pass"), "--lines")


def test_a_hang():
    all_differ(script("import time; time.sleep(60)"), "--time-limit", "0.3", expected="took more than")


def test_a_hang_between_lines():
    all_differ(script("import sys, time; sys.stdin.readline(); time.sleep(60)"), "--lines", "--time-limit", "0.3", expected="took more than")


def test_garbage():
    code, result, _ = conformance(*FEW, backend=script("print('no JSON')"))
    assert code == 3 and result["agree"] == 0 and result["differ"] == result["cases"]


def test_garbage_between_lines():
    all_differ(script("import sys\nfor line in sys.stdin: print('no JSON', flush=True)"), "--lines")


def test_an_answer_without_files():
    report = {"code": 0, "result": {"steps": 1, "moved": 8, "intersects": False}}
    all_differ(script(f"import sys, json\nfor line in sys.stdin: print(json.dumps({report!r}), flush=True)"), "--lines",
               expected="was not written")


def test_not_supported_is_counted():
    code, result, _ = conformance(*FEW, "--lines",
                                  backend=script("import sys\nfor line in sys.stdin: print('{\"code\": 4}', flush=True)"))
    assert code == 0 and result["unsupported"] == result["cases"] and result["differ"] == 0


def test_the_junit_file_has_the_counts():
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "results.xml")
        _, result, _ = conformance("--lines", "--junit", file, *only(set(numpy_backend.OPERATIONS) | {"axis"}),
                                   backend=[sys.executable, os.path.join(HERE, "numpy_backend.py")])
        suite = ElementTree.parse(file).getroot().find("testsuite")
    assert int(suite.get("tests")) == len(suite.findall("testcase")) == result["cases"]
    assert int(suite.get("failures")) == len(suite.findall("testcase/failure")) == result["differ"] > 0
    assert int(suite.get("skipped")) == len(suite.findall("testcase/skipped")) == result["unsupported"] > 0
    assert sorted(case.get("name") for case in suite.findall("testcase") if case.find("failure") is not None) == differing(result)


def main():
    failed = 0
    for name, test in sorted(globals().items()):
        if not name.startswith("test_") or (sys.argv[1:] and not any(word in name for word in sys.argv[1:])):
            continue
        try:
            test()
            print("passed", name, flush=True)
        except AssertionError as error:
            failed += 1
            print("FAILED", name, str(error)[:2000], flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())

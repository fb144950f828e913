"""doc/python.md, run in order in a fresh folder: what each block (python) shows is the block that follows it (text), as in a
notebook: what is printed, and the value of the last line. There "..." stands for lines that are left out, at the end of a line
for the rest of it. A block without one shows nothing."""

import ast
import contextlib
import io
import re

from conftest import SOURCE

PAGE = SOURCE / "doc" / "python.md"


def blocks():
    """Line, code and what is shown."""
    text = PAGE.read_text(encoding="utf-8")
    found = []
    for match in re.finditer(r"```(\w+)\n(.*?)```\n", text, re.DOTALL):
        if match[1] == "python":
            found.append([text.count("\n", 0, match.start()) + 2, match[2], ""])
        elif match[1] == "text":
            found[-1][2] = match[2]
    return found


def shown_by(code, names):
    body = ast.parse(code).body
    out = io.StringIO()
    with contextlib.redirect_stdout(out):
        last = body.pop() if isinstance(body[-1], ast.Expr) else None
        exec(compile(ast.Module(body, []), str(PAGE), "exec"), names)
        value = eval(compile(ast.Expression(last.value), str(PAGE), "eval"), names) if last else None
        if value is not None:
            print(repr(value))
    return out.getvalue()


def lines_of(text):
    return [line.rstrip() for line in text.rstrip().splitlines()]


def page_shows(page, printed):
    if not page:
        return not printed
    if page[0] == "...":
        return any(page_shows(page[1:], printed[count:]) for count in range(1, len(printed) + 1))
    if not printed:
        return False
    shortened = page[0].endswith("...")
    same = printed[0].startswith(page[0][:-3]) if shortened else printed[0] == page[0]
    return same and page_shows(page[1:], printed[1:])


def test_comparison_finds_what_drifted():
    assert page_shows(["a", "...", "b 2"], ["a", "b 1", "b 2"]) and page_shows(["a  b ..."], ["a  b  1"])
    assert not page_shows(["a", "b"], ["a"]) and not page_shows(["a"], ["a", "b"]) and not page_shows(["b 2"], ["b 1"])


def test_the_tutorial_shows_what_it_says(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "data").symlink_to(SOURCE / "data")
    names = {}
    steps = blocks()
    assert len(steps) >= 12
    for line, code, page in steps:
        printed = shown_by(code, names)
        assert page_shows(lines_of(page), lines_of(printed)), f"doc/python.md:{line}:\n{code}shows\n{printed}"

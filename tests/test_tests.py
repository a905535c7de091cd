"""Rules of the tests themselves."""

from __future__ import annotations

import ast
from collections import defaultdict
from pathlib import Path

from tests.test_layers import ROOMS, ROOT

APART = {"benchmarks"}
"""Folders of tests with names of their own: programs."""


def test_no_two_classes_of_tests_share_a_name() -> None:
    """Classes of one idea are one, in `tests/support` or the `conftest.py` of their folder."""
    tests = ROOT / "tests"
    paths = [p for p in tests.rglob("*.py") if p.relative_to(tests).parts[0] not in APART]
    named = defaultdict[str, list[str]](list)
    for path in paths:
        for node in ast.parse(path.read_text("utf-8")).body:
            if isinstance(node, ast.ClassDef):
                named[node.name].append(str(path.relative_to(tests)))
    assert len(named) > 100
    assert not {name: where for name, where in named.items() if len(where) > 1}


BESIDE = {
    "attack",
    "benchmarks",
    "course",
    "doctor_trial",
    "e2e",
    "javascript",
    "mutants",
    "package",
    "pictures",
    "release",
    "site",
    "support",
}
"""Folders of tests that belong to no room."""


def test_tests_mirror_the_rooms() -> None:
    tests = ROOT / "tests"
    rooms = {name.removeprefix("webviz."): ROOT / name.replace(".", "/") for name in ROOMS}
    rooms |= {"displays": ROOT / "displays/webviz_displays", "urdf": ROOT / "urdf", "sim": ROOT}
    modules = [path for path in tests.rglob("test_*.py") if "__pycache__" not in path.parts]
    folders = {path.parent.relative_to(tests) for path in modules} - {Path()}
    beyond = {str(f) for f in folders if f.parts[0] not in BESIDE and f.parts[0] not in rooms}
    assert beyond == set()
    of_rooms = (f for f in folders if f.parts[0] in rooms)
    missing = [str(f) for f in of_rooms if not rooms[f.parts[0]].joinpath(*f.parts[1:]).is_dir()]
    assert missing == [], "tests of folders that do not exist"


def test_no_fixture_only_returns_a_function() -> None:
    """It would be a function that tests import, without its type in the signature of each."""
    faults = []
    for path in (ROOT / "tests").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            match node:
                case ast.FunctionDef(
                    args=ast.arguments(args=[]), body=[*_, ast.FunctionDef(name=name), last]
                ) if any("fixture" in ast.unparse(each) for each in node.decorator_list):
                    if isinstance(last, ast.Return) and ast.unparse(last) == f"return {name}":
                        faults.append(f"{path.name}: {node.name}")
                case _:
                    pass
    assert faults == []

"""Tests of bug reports: they fail as the report did, and pass once the fault is repaired."""

from __future__ import annotations

import ast
import contextlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import msgspec
import pytest
import stories

from webviz.api.errors import Error
from webviz.files.opening import parse
from webviz.files.report import BugReport, write_report
from webviz.files.report.content import FindingEntry, StatusEntry
from webviz.shell.cli import main as cli
from webviz.shell.report.making import make_report
from webviz.shell.report.scenes import Pictured
from webviz.shell.report.writing import write_test
from webviz.sources.bag.history import BagHistory
from webviz.sources.player import Player


@pytest.fixture
def reported(tmp_path: Path) -> Callable[[stories.Fault], Path]:
    def make(fault: stories.Fault) -> Path:
        bag = stories.write(tmp_path / fault, fault)
        path = tmp_path / f"{fault}.zip"
        with contextlib.closing(Player(BagHistory(bag))) as source:
            make_report(parse(stories.CONFIG, "it"), source, Pictured(None), path)
        return path

    return make


@pytest.mark.parametrize(
    ("fault", "check", "sentence"),
    [
        ("turned", "finding", "The scan of 'base_scan' is rotated by 18"),
        ("misplaced", "status", "a shift by"),
        ("obstacle", "status", "The path leads through"),
    ],
)
def test_the_faults_of_the_course_become_tests(
    reported: Callable[[stories.Fault], Path],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    fault: stories.Fault,
    check: str,
    sentence: str,
) -> None:
    test = tmp_path / "test_bug.py"
    assert cli(["test", str(reported(fault)), "-o", str(test), "--check", check]) == 0
    functions = compiled(test)
    monkeypatch.delenv("WEBVIZ_BAG", raising=False)
    texts = [failure(function) for function in functions]
    assert any(sentence in text for text in texts), texts
    monkeypatch.setenv("WEBVIZ_BAG", str(stories.write(tmp_path / "repaired", "none")))
    assert [failure(function) for function in compiled(test)] == [""] * len(functions)


def compiled(test: Path) -> list[Callable[[], None]]:
    """The functions of a test file."""
    names: dict[str, Callable[[], None]] = {"__file__": str(test)}  # pyright: ignore[reportAssignmentType]
    exec(compile(test.read_text(), str(test), "exec"), names)
    return [value for name, value in names.items() if name.startswith("test_")]


def failure(function: Callable[[], None]) -> str:
    """The values with which a test fails, "" if it passes."""
    try:
        function()
    except AssertionError as error:
        frames = error.__traceback__
        assert frames is not None
        from webviz.testing import replay

        names = function.__globals__
        result = replay(names["BAG"], names["CONFIG"], names["AT_S"])
        texts = [status.text for each in result.statuses.values() for status in each.values()]
        return " ".join([*texts, *result.findings.values()])
    return ""


def test_strings_of_strangers_do_not_become_code(tmp_path: Path) -> None:
    evil = '"""\nimport os; os.system("touch evil")\n"""'
    path = zipped(
        tmp_path / "bug.zip",
        statuses=(StatusEntry(evil, evil, "error", evil),),
        findings=(FindingEntry(evil, "error", evil, evil, evil),),
    )
    for check in ("finding", "status"):
        test = tmp_path / "new" / check / f"test_{check}.py"  # folders are made
        assert cli(["test", str(path), "-o", str(test), "--check", check]) == 0
        tree = ast.parse(test.read_text())
        calls = {ast.unparse(n.func) for n in ast.walk(tree) if isinstance(n, ast.Call)}
        assert calls <= {"Path", "os.environ.get", "replay", "replay(BAG, CONFIG, AT_S).problem"}


def zipped(path: Path, **values: Any) -> Path:
    """A report with these statuses and findings."""
    report = BugReport(source="live", made=1.0, at_ns=1, first_ns=1, last_ns=2, **values)
    content = {"report.json": msgspec.json.encode(report), "config.yaml": b"", "slice.mcap": b""}
    write_report(path, content)
    return path


STATUSES = tuple(
    StatusEntry(display, status, level, "")
    for display, status, level in (
        ("", "Clocks", "error"),
        ("Scan", "Topic", "ok"),
        ("Scan", "Map", "warn"),
        ("Plan A", "!", "error"),
        ("é", "-", "error"),
        ("x" * 70, "y", "warn"),
    )
)
OF_STATUSES = ["test_1_scan_map", "test_2_plan_a", "test_3_it", f"test_4_{'x' * 60}"]


@pytest.mark.parametrize(
    ("severities", "names"),
    [
        ({"B": "error", "A 1": "warn", "C": "info"}, ["test_b", "test_a_1"]),
        ({"C": "info"}, OF_STATUSES),
        ({}, OF_STATUSES),
        ({f"F{number}": "warn" for number in range(21)}, [f"test_f{n}" for n in range(20)]),
    ],
)
def test_findings_are_tested_or_else_statuses(
    tmp_path: Path, severities: dict[str, str], names: list[str]
) -> None:
    results = [FindingEntry(id, severity, "", "", "") for id, severity in severities.items()]
    report = zipped(tmp_path / "bug.zip", statuses=STATUSES, findings=(*results, *results))
    test = tmp_path / "test_bug.py"
    part = "statuses" if names == OF_STATUSES else "findings"
    assert write_test(report, test, None) == f"wrote {test}, {len(names)} tests of {part}."
    tree = ast.parse(test.read_text())
    assert [each.name for each in tree.body if isinstance(each, ast.FunctionDef)] == names


def test_one_test_is_of_one_finding_and_none_of_another_part(tmp_path: Path) -> None:
    result = (FindingEntry("TF001", "error", "", "", ""),)
    report, test = zipped(tmp_path / "bug.zip", findings=result), tmp_path / "test_bug.py"
    with pytest.raises(Error, match="has no status to test"):
        write_test(report, test, "status")
    assert not test.exists()
    assert write_test(report, test, "finding") == f"wrote {test}, 1 test of a finding."


def test_nothing_is_overwritten(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "test_bug.mcap").touch()
    assert cli(["test", "bug.zip", "-o", str(tmp_path / "test_bug.py")]) == 1
    assert "test_bug.mcap exists already" in capfd.readouterr().err


def test_a_folder_that_cannot_be_made_is_one_sentence(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").touch()
    path = zipped(tmp_path / "bug.zip", findings=(FindingEntry("TF001", "error", "", "", ""),))
    assert cli(["test", str(path), "-o", str(tmp_path / "file" / "test_bug.py")]) == 1
    assert f"Cannot write {tmp_path / 'file' / 'test_bug.py'}: " in capfd.readouterr().err

"""The process that makes a shared file: what it says, and how it ends."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable
from pathlib import Path

import pytest
from waiting import until

from webviz.api.errors import Error
from webviz.engine.parts.part import HostProgram
from webviz.features.sharing import exporting
from webviz.features.sharing.exporting import SharedMoment, export

HANGS = """
import os, sys, time, pathlib
pathlib.Path({pid!r}).write_text(str(os.getpid()))
sys.stdout.write('{{"share": 0.25}}\\n')
sys.stdout.flush()
while True:
    time.sleep(1)
"""

Run = Callable[..., str]


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Export with another program in place of that which makes the file."""

    def run(program: str, **options: object) -> str:
        (tmp_path / "other_program.py").write_text(program)
        monkeypatch.setenv("PYTHONPATH", str(tmp_path))
        monkeypatch.setattr(exporting, "PROGRAM", "other_program")
        (exported_file := tmp_path / "run.html").write_text("the file")
        moment = SharedMoment(tmp_path / "run.mcap", tmp_path / "c.yaml", exported_file, "lab", 1.5)
        files: dict[str, bytes] = {}
        values = {"progress": lambda share: None, "stopped": threading.Event()} | options
        text = export(moment, HostProgram(files.__setitem__), **values)  # pyright: ignore
        assert files == {"run.html": b"the file"}
        return text

    return run


def test_the_exporting_process_gets_an_order_and_reports_progress(run: Run, tmp_path: Path) -> None:
    program = """
import json, sys, time
order = json.loads(sys.stdin.readline())
for share in (0.0, 0.5, 1.0):
    print(json.dumps({"share": share}), flush=True)
sys.stdout.write('{"done": "2 s of ')
sys.stdout.flush()
time.sleep(0.1)
print(order["name"], order["at_s"], order["bag"] + '"}', flush=True)
sys.stdin.read()
"""
    shares: list[float] = []
    assert run(program, progress=shares.append) == f"2 s of lab 1.5 {tmp_path}/run.mcap"
    assert shares == [0.0, 0.5, 1.0]


@pytest.mark.parametrize(
    ("program", "problem"),
    [
        ("""print('{"problem": "The disk is full."}')""", "^The disk is full.$"),
        ("raise SystemExit(3)", "ended unexpectedly, with status 3. Save the moment as a bag"),
        ("import os; os.close(0); raise SystemExit(4)", "ended unexpectedly, with status 4"),
        ("""import sys; sys.stdout.write('{"don'); sys.exit(5)""", "unexpectedly, with status 5"),
    ],
)
def test_failures_of_the_process_are_one_sentence(run: Run, program: str, problem: str) -> None:
    with pytest.raises(Error, match=problem):
        run(program)


@pytest.mark.parametrize("is_late", [False, True])
def test_one_that_is_stopped_ends_even_if_it_hangs(
    run: Run, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, is_late: bool
) -> None:
    monkeypatch.setattr(exporting, "ENDING_S", 0.1)
    stopped, shares = threading.Event(), list[float]()

    def progress(share: float) -> None:
        shares.append(share)
        if is_late:
            threading.Timer(0.3, stopped.set).start()
        else:
            stopped.set()

    with pytest.raises(Error, match=r"^Stopped\.$"):
        run(HANGS.format(pid=str(tmp_path / "pid")), progress=progress, stopped=stopped)
    assert shares == [0.25]
    number = int((tmp_path / "pid").read_text())
    until(lambda: not Path(f"/proc/{number}").exists())
    with pytest.raises(ProcessLookupError):
        os.kill(number, 0)

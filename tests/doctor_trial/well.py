"""Robots and bags that are well, in which the doctor must find nothing above a note."""

from __future__ import annotations

import subprocess
import sys
import time
from collections.abc import Iterable, Iterator
from pathlib import Path

import msgspec

from webviz.shell.doctor.report import DoctorReport

DOCTOR = [sys.executable, "-m", "webviz", "doctor", "--json"]
DEMO = (
    "ip link set lo up; mount -t tmpfs -o size=1g none /dev/shm; "
    f"{sys.executable} -m webviz_sim >&2 & sleep 4"
)


def demo(seconds: float) -> Iterator[str]:
    """Yield what is found in a demo that runs for some seconds."""
    until_s = time.monotonic() + seconds
    while time.monotonic() < until_s:
        command = f"{DEMO}; {' '.join(DOCTOR)} --seconds 60"
        yield from _findings(
            "demo", ["unshare", "-rnmpf", "--mount-proc", "--kill-child", "sh", "-c", command]
        )


def bags(paths: Iterable[Path]) -> Iterator[str]:
    """Yield what is found in bags."""
    for path in paths:
        yield from _findings(path.name, [*DOCTOR, "--bag", str(path)])


def _findings(name: str, command: list[str]) -> Iterator[str]:
    completed = subprocess.run(command, capture_output=True, text=True, check=False)
    report = msgspec.json.decode(completed.stdout, type=DoctorReport)
    for each in report.findings:
        if each.severity != "note":
            yield f"{name}: {each.id} {each.cause}"

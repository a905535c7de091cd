"""The table, and the facts of the machine above it."""

from __future__ import annotations

import importlib.metadata
import os
import platform
import subprocess
import timeit
from collections.abc import Iterator, Sequence
from pathlib import Path

import psutil

from side_by_side.figures import Figure, Row, ratio
from side_by_side.scenes import SCENES, Scene
from side_by_side.systems.registry import SYSTEMS

COLUMNS = {
    "p50_ms": "p50 ms",
    "p99_ms": "p99 ms",
    "shown_per_s": "shown /s",
    "left_out_per_s": "left out /s",
    "least_shown_per_s": "shown to the last /s",
    "cpu_percent": "CPU %",
    "megabytes_per_s": "MB/s",
    "resident_mb": "RSS MB",
    "join_s": "join s",
    "start_s": "start s",
    "start_cpu_s": "start CPU s",
    "others_percent": "others %",
}


def machine() -> dict[str, str]:
    """Return the properties of the machine that figures depend on."""
    memory = round(psutil.virtual_memory().total / 2**30)
    model = "unknown"
    for line in Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            model = line.partition(": ")[2]
    return {
        "processor": f"{os.cpu_count()} x {model}",
        "memory": f"{memory} GiB",
        "system": f"{platform.system()} {platform.release()}, Python {platform.python_version()}",
    }


def commit() -> str:
    """The commit of the checkout, marked if something has changed since."""
    command = ["git", "describe", "--always", "--dirty", "--exclude=*"]
    done = subprocess.run(command, cwd=Path(__file__).parent, capture_output=True, text=True)
    return done.stdout.strip() or "unknown"


def versions(systems: Sequence[str]) -> dict[str, str]:
    """Versions of the packages that matter."""
    packages = [package for name in systems for package in SYSTEMS[name].packages]
    return {package: importlib.metadata.version(package) for package in dict.fromkeys(packages)}


def copied(scene: Scene) -> tuple[float, float]:
    """Bytes published per second, and percent of a core that a copy of them takes."""
    size = seconds = 0.0
    for stream in scene.streams:
        message = stream.publication(0, 0)
        size += stream.hz * len(message)
        seconds += stream.hz * min(
            timeit.repeat(lambda m=message: bytearray(m), number=1, repeat=20)
        )
    return size, 100 * seconds


def markdown(rows: Sequence[Row], failures: Sequence[tuple[str, str, str]]) -> Iterator[str]:
    """The lines of a table for each scene."""
    for name in dict.fromkeys(row.scene for row in rows):
        yield f"\n### {name}: {SCENES[name].title}\n"
        size, share = copied(SCENES[name])
        yield f"{size / 1e6:.2f} MB/s are published; to copy them takes {share:.2g} % of a core.\n"
        yield "| clients | system | " + " | ".join(COLUMNS.values()) + " | CPU / webviz's |"
        yield "| --- | --- |" + " ---: |" * (len(COLUMNS) + 1)
        mine = [row for row in rows if row.scene == name]
        for row in sorted(mine, key=lambda row: (len(row.load), row.load)):
            cells = [_cell(row.figures[figure]) for figure in COLUMNS]
            cells.append(_ratio(rows, row))
            yield f"| {row.load} | {SYSTEMS[row.system].title} | " + " | ".join(cells) + " |"
        for scene, system, reason in failures:
            if scene == name:
                yield f"\n{SYSTEMS[system].title} has no figures in a round: {reason}."


def _ratio(rows: Sequence[Row], row: Row) -> str:
    value = ratio(rows, row, "cpu_percent", "webviz")
    return "" if value is None or row.system == "webviz" else f"x {value:.2g}"


def _cell(figure: Figure | None) -> str:
    if figure is None:
        return ""
    spread = (figure.most - figure.least) / 2
    text = _short(figure.median)
    return text if _short(spread) == "0" else f"{text} ± {_short(spread)}"


def _short(value: float) -> str:
    if abs(value) < 0.005:
        return "0"
    return (
        f"{value:.0f}" if abs(value) >= 100 else f"{value:.3g}" if value >= 10 else f"{value:.2g}"
    )

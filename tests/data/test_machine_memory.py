"""The memory of the machine or of the container."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest

from webviz.data import machine_memory


@pytest.fixture
def groups(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Control groups in which this process is in that of a container."""
    own = tmp_path / "own"
    own.write_text("1:name=systemd:/ignored\n0::/system.slice/robot.service\n")
    root = tmp_path / "groups"
    (root / "system.slice/robot.service").mkdir(parents=True)
    monkeypatch.setattr(machine_memory, "OWN", own)
    monkeypatch.setattr(machine_memory, "CGROUPS", root)
    machine_memory.memory_bytes.cache_clear()
    machine = SimpleNamespace(total=4_096_000_000)
    monkeypatch.setattr(machine_memory.psutil, "virtual_memory", lambda: machine)
    yield root
    machine_memory.memory_bytes.cache_clear()


@pytest.mark.parametrize(
    ("limits", "expected"),
    [
        ({}, 4_096_000_000),
        ({"system.slice/robot.service/memory.max": "max\n"}, 4_096_000_000),
        ({"system.slice/robot.service/memory.max": "1000000000\n"}, 1_000_000_000),
        ({"system.slice/memory.max": "700", "system.slice/robot.service/memory.high": "900"}, 700),
    ],
)
def test_the_least_limit_of_a_container_counts(
    groups: Path, limits: dict[str, str], expected: int
) -> None:
    for name, text in limits.items():
        (groups / name).write_text(text)
    assert machine_memory.memory_bytes() == expected


def test_without_control_groups_it_is_that_of_the_machine(groups: Path) -> None:
    machine_memory.OWN.unlink()
    assert machine_memory.memory_bytes() == 4_096_000_000

"""The list of doors is complete, and each of them is attacked."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.attack import doors
from tests.attack.doors import DOORS, doors_of, entries, modules

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

from tests.attack.run import KINDS


def test_each_module_that_reads_bytes_is_behind_a_door() -> None:
    unknown = [module for module in entries() if not doors_of(module)]
    assert not unknown, "add them to DOORS, with an attack"


def test_each_door_is_attacked_or_has_a_reason() -> None:
    for name, door in DOORS.items():
        assert set(door.attacks) <= set(KINDS), name
        assert bool(door.attacks) != bool(door.reason), name


def test_each_attack_is_on_a_door() -> None:
    assert {kind for door in DOORS.values() for kind in door.attacks} == set(KINDS)


def test_each_pattern_of_a_door_has_modules() -> None:
    result = [*modules()]
    for name, door in DOORS.items():
        for pattern in door.modules:
            assert any(doors.fnmatchcase(module, pattern) for module in result), (name, pattern)


@pytest.mark.parametrize(
    ("code", "is_door"),
    [
        ("from pathlib import Path\nPath('a').read_bytes()", True),
        ("import json\njson.loads('1')", True),
        ("import msgspec\nmsgspec.json.decode(b'1')", True),
        ("'a'.encode().decode()", False),
    ],
)
def test_a_new_module_that_reads_bytes_is_found(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, code: str, is_door: bool
) -> None:
    (tmp_path / "webviz").mkdir()
    (tmp_path / "webviz" / "new.py").write_text(code)
    monkeypatch.setattr(doors, "ROOT", tmp_path)
    assert [*entries()] == (["webviz/new.py"] if is_door else [])

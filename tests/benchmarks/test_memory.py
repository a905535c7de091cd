"""Memory stands still under load, also while a client has stopped reading."""

from __future__ import annotations

from pathlib import Path

import pytest

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

from side_by_side.memory import soak
from side_by_side.scenes import SCENES
from side_by_side.systems.registry import SYSTEMS

SECONDS = 40.0
MAX_MB_PER_MIN = 15.0
"""A leak of one stream's messages would be 20 (scans) to 77 MB a minute (costmaps). Heaps that
settle down after the warm-up were seen to add 2 (README)."""
LONGEST_GAP_S = 15.0
"""Every stream comes at least twice a second; the rest is for a machine that is busy otherwise."""


def test_a_stalled_client_takes_no_memory_and_delays_no_other(
    tmp_path: Path,
) -> None:
    scene = SCENES["G"]
    result = soak(SYSTEMS["webviz"], scene, SECONDS, tmp_path)
    assert result.slope < MAX_MB_PER_MIN
    assert result.gaps.keys() == {lane.number for lane in scene.lanes}
    assert max(result.gaps.values()) < LONGEST_GAP_S

"""Findings of viewers under test."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import building

from webviz import Finding, Severity
from webviz.api.finding import CauseLevel
from webviz.data.rotations import from_rpy
from webviz.shell.testing.harness import Harness
from webviz.shell.testing.live import LiveViewer
from webviz.shell.testing.messages import header
from webviz_sim.pose import Pose2D

HERE = Pose2D(-2.0, 0.0)
"""Pose of the robot in the simulator's building."""
SCAN = "sensor_msgs/msg/LaserScan"


def by_key(findings: Sequence[Finding], level: CauseLevel) -> dict[str, Finding]:
    """Findings on a level that are more than notes in their order, by id and subject."""
    worse = [each for each in findings if each.severity > Severity.NOTE and each.level is level]
    return {f"{each.id} {each.subject}".strip(): each for each in worse}


def live_findings(viewer: LiveViewer, level: CauseLevel) -> dict[str, Finding]:
    """The findings of a live viewer on one level."""
    return by_key(viewer.viewer.snapshot().findings, level)


def examined(
    stage: Harness,
    level: CauseLevel,
    seconds: float = 1.1,
    publish: Callable[[], object] = lambda: None,
) -> dict[str, Finding]:
    """The findings of a viewer on one level after some rounds.

    Args:
        stage: the viewer.
        level: of the causes.
        seconds: that pass between two turns.
        publish: called before each turn.
    """
    return by_key(stage.findings(seconds, publish), level)


def display(viewer: Harness | LiveViewer, name: str) -> str:
    """The id of a display."""
    return next(row.id for row in viewer.viewer.snapshot().rows if row.name == name)


def three_ranges(frame: str, stamp_ns: int) -> dict[str, Any]:
    """A scan."""
    return {
        "header": header(frame, stamp_ns),
        "angle_max": 1.0,
        "angle_increment": 0.5,
        "range_max": 10.0,
        "ranges": [1.0, 2.0, 1.5],
    }


def look(stage: Harness, pose: Pose2D, scan: Any = None, roll: float = 0.0) -> None:
    """Publish where the laser is said to be, the map, and what it sees from `HERE`."""
    w, x, y, z = from_rpy(roll, 0.0, pose.yaw)
    stage.transform("map", "laser", (pose.x, pose.y, 0.0), (x, y, z, w))
    now = stage.source.now
    stage.publish(
        "/map", "nav_msgs/msg/OccupancyGrid", {"header": header("map", now)} | building.grid()
    )
    scan = building.scan(HERE) if scan is None else scan
    stage.publish("/scan", SCAN, {"header": header("laser", now)} | scan)
    stage.turn()

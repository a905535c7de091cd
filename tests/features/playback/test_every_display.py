"""Seeks with every display: they show what playing to the same time shows."""

from __future__ import annotations

import random
from collections.abc import Mapping
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest
from bags import START_NS, TF, Bag, ns
from built_in_checks import built_in_checks

from webviz.api.declared import Topic, make
from webviz.api.display import inputs
from webviz.api.registry import display_types
from webviz.data.messages import encode
from webviz.files.config import Config, dump
from webviz.shell.testing import check_seeks
from webviz.shell.testing.messages import header, stamped_transform

CHECKS = built_in_checks()
MAX_STEP_S = 0.5
"""Longest time between two ticks of a scene."""
NOT_COMPARED = {"Grid", "Axes", "MotionPlanningTasks"}
"""Displays without messages, and an animation that goes on with the solution before until that has
ended."""
LATCHED = ("robot_description", "camera_info")
SHORT: dict[str, Mapping[str, Any]] = {
    # The range of depths is a median over the images that were shown.
    **{name: {"median_window": 1} for name in ("Camera", "Image", "ImagePlane")},
    **{
        name: {"scene_geometry": {"scene_display_time": 0.5}}
        for name in ("MotionPlanning", "PlanningScene")
    },
    "LaserScan": {"decay_time": 1.0},
    "MapCloud": {"decay_time": 1.5},
    "Odometry": {"keep": 9, "position_tolerance": 0.1},
    "Path": {"buffer_length": 3},
    "PointCloud": {"decay_time": 2.0},
    "PointCloud2": {"decay_time": 0.7},
    "PointStamped": {"history_length": 3},
    "PoseHistory": {"buffer_size": 3},
    "Range": {"buffer_length": 3},
    "Wrench": {"history_length": 3, "accept_nan_values": True},
}
"""Properties with which more than one message is shown but not all, and nothing is animated."""


class ExportWriter:
    """Records what a scene of a display publishes, as a bench does.

    Args:
        bag: to record to.
        display: of the scene.
        chance: which messages are lost, and when those that are not are recorded.
    """

    runner = SimpleNamespace(is_busy=lambda: False)

    def __init__(self, bag: Bag, display: Any, chance: random.Random) -> None:
        self.display = display
        self._bag = bag
        self._chance = chance
        self._at_s = 0.0
        self._has_sent = False

    @property
    def now_ns(self) -> int:
        return START_NS + ns(self._at_s)

    def transform(
        self,
        parent: str,
        child: str,
        xyz: tuple[float, float, float] = (0.0, 0.0, 0.0),
        xyzw: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0),
        *,
        stamp_ns: int | None = None,
    ) -> None:
        at_ns = self.now_ns if stamp_ns is None else stamp_ns
        transform = stamped_transform(parent, child, at_ns, xyz, xyzw)
        topic = "/tf_static" if stamp_ns is None else "/tf"
        self._put(topic, TF, {"transforms": [transform]}, is_kept=True)

    def send(
        self,
        type_name: str,
        values: Mapping[str, Any],
        *,
        frame: str | None = None,
        stamp_ns: int | None = None,
        topic: str = "",
    ) -> None:
        if frame is not None:
            values = {**values, "header": header(frame, stamp_ns or self.now_ns)}
        self.send_bytes(type_name, encode(type_name, values), topic)

    def send_bytes(self, type_name: str, cdr: bytes, topic: str = "") -> None:
        topic = topic or inputs(self.display)[0][2].name
        self._put(topic if topic.startswith("/") else f"/{topic}", type_name, cdr)

    def turn(self, seconds: float = 0.0) -> None:
        """Let time pass, if anything was published or the scene does."""
        if self._has_sent or seconds:
            self._at_s += min(seconds, MAX_STEP_S) + self._chance.uniform(0.01, 0.3)
        self._has_sent = False

    def settle(self) -> None:
        """Slow work is done when the bag is played."""

    def serve(self, *_: Any) -> None:
        """A bag has no services."""

    def offer(self, *_: Any) -> None:
        """Only topics with messages are in the bag."""

    def statuses(self) -> Mapping[str, tuple[str, str]]:
        """Return what a scene waits for."""
        return {"Path": ("OK", "Point 8 of 8")}

    def _put(self, topic: str, type_name: str, values: Any, is_kept: bool = False) -> None:
        if topic not in self._bag.topics:
            latched = topic == "/tf_static" or topic.endswith(LATCHED)
            self._bag.add(topic, type_name, latched=latched)
        self._has_sent = True
        if is_kept or self._chance.random() < 0.85:
            self._at_s += self._chance.uniform(0.0, 0.03)
            self._bag.put(self._at_s, topic, values)


@pytest.mark.parametrize("name", sorted(CHECKS.keys() - NOT_COMPARED))
def test_seeking_equals_playing_for_every_display(tmp_path: Path, name: str) -> None:
    display = make(display_types()[name], dict(SHORT.get(name, {})))
    for path, _, topic in inputs(display):
        setattr(display, path, Topic(topic.name or "/any", filter_size=100))
    chance = random.Random(name)
    bag = Bag()
    tape = ExportWriter(bag, display, chance)
    for _ in range(4):
        CHECKS[name].publish(cast("Any", tape))
        tape.turn(chance.uniform(0.0, 5.0))
    config = Config(displays=[display])
    config.set_fixed_frame("map")
    check_seeks(bag.write_file(tmp_path / "run.mcap"), dump(config), count=6, seed=1)

"""A viewer without ROS and browser: a source fed by hand and a scene that remembers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest
from rosbags.typesys import Stores, get_typestore

from webviz.config import Config, Settings
from webviz.display import Display
from webviz.nodes import Node, Pose
from webviz.sources import Inbox, Offer, Publisher, Raw, Subscription
from webviz.state import State
from webviz.viewer import Viewer

STORE = get_typestore(Stores.ROS2_JAZZY)
SECOND = 1_000_000_000


@dataclass
class RecordingScene:
    """Remembers what is drawn, as a browser would show it."""

    nodes: dict[str, dict[str, Node]] = field(default_factory=dict)
    poses: dict[str, Pose] = field(default_factory=dict)
    hidden: set[str] = field(default_factory=set)
    watched: bool = True
    upserts: int = 0

    def set_pose(self, group: str, pose: Pose) -> None:
        self.poses[group] = pose

    def set_visible(self, group: str, visible: bool) -> None:
        (self.hidden.discard if visible else self.hidden.add)(group)

    def upsert(self, group: str, key: str, node: Node) -> None:
        self.nodes.setdefault(group, {})[key] = node
        self.upserts += 1

    def remove(self, group: str, key: str) -> None:
        self.nodes.get(group, {}).pop(key, None)

    def remove_group(self, group: str) -> None:
        for table in (self.nodes, self.poses):
            table.pop(group, None)
        self.hidden.discard(group)

    def flush(self) -> None:
        pass

    def has_watchers(self) -> bool:
        return self.watched

    def visible(self) -> dict[str, Node]:
        """Every node that can be seen, by group and key."""
        return {
            f"{group}:{key}": node
            for group, nodes in self.nodes.items()
            if group not in self.hidden
            for key, node in nodes.items()
        }


@dataclass
class HandFedSource:
    """A source whose messages, publishers and time a test sets."""

    inbox: Inbox = field(default_factory=Inbox)
    wanted: Mapping[str, Subscription] = field(default_factory=dict)
    known: dict[str, Offer] = field(default_factory=dict)
    now: int = 100 * SECOND

    def want(self, subscriptions: Mapping[str, Subscription]) -> None:
        for topic in self.wanted.keys() - subscriptions.keys():
            self.inbox.close(topic)
        for topic in subscriptions.keys() - self.wanted.keys():
            self.inbox.open(topic, 1000)
        self.wanted = dict(subscriptions)

    def offers(self) -> Mapping[str, Offer]:
        return self.known

    def now_ns(self) -> int:
        return self.now

    def resolve(self, topic: str) -> str:
        if " " in topic:
            raise ValueError(f"{topic!r} is no topic name: it has a space")
        return f"/{topic.removeprefix('/')}"

    def close(self) -> None:
        pass


def message(type_name: str, values: Mapping[str, Any]) -> Any:
    """A rosbags message from nested mappings; what is left out is zero or empty."""
    cls = STORE.types[type_name]
    _, fields = STORE.fielddefs[type_name]
    return cls(**{name: _value(spec, values.get(name)) for name, spec in fields})


def _value(spec: Any, value: Any) -> Any:
    kind, detail = spec[0].name, spec[1]
    if kind == "NAME":
        return message(detail, value or {})
    if kind == "BASE":
        base = detail[0]
        return value if value is not None else ("" if base == "string" else 0)
    (item, length) = detail
    if item[0].name == "BASE" and item[1][0] != "string":
        dtype = np.dtype({"byte": "u1"}.get(item[1][0], item[1][0]))
        return np.asarray(np.zeros(length or 0) if value is None else value, dtype)
    return [_value(item, each) for each in (value or [])]


def header(frame: str, stamp_ns: int) -> dict[str, Any]:
    stamp = {"sec": stamp_ns // SECOND, "nanosec": stamp_ns % SECOND}
    return {"frame_id": frame, "stamp": stamp}


class Bench:
    """A viewer on a hand-fed source and a recording scene."""

    def __init__(self, *displays: Display, fixed_frame: str = "map", strict: bool = True) -> None:
        self.source = HandFedSource()
        self.scene = RecordingScene()
        self.states: list[State] = []
        self.clock = 1000.0
        config = Config(Settings(fixed_frame=fixed_frame), list(displays))
        self.viewer = Viewer(
            config,
            self.source,
            self.scene,
            self.states.append,
            strict=strict,
            clock=lambda: self.clock,
        )
        self.turn()

    def publish(self, topic: str, type_name: str, values: Mapping[str, Any]) -> None:
        cdr = bytes(STORE.serialize_cdr(message(type_name, values), type_name))
        if topic not in self.source.known:
            publisher = Publisher("/test", type_name, "reliable", "volatile")
            policies = ("reliable", "volatile")
            self.source.known[topic] = Offer((publisher,), policies)
        self.source.inbox.put(topic, Raw(cdr, self.source.now))

    def transform(
        self, parent: str, child: str, stamp_ns: int, x: float = 0.0, *, static: bool = False
    ) -> None:
        transform = {"translation": {"x": x}, "rotation": {"w": 1.0}}
        stamped = {
            "header": header(parent, stamp_ns),
            "child_frame_id": child,
            "transform": transform,
        }
        topic = "/tf_static" if static else "/tf"
        self.publish(topic, "tf2_msgs/msg/TFMessage", {"transforms": [stamped]})

    def pose(self, topic: str, frame: str, stamp_ns: int, x: float = 0.0) -> None:
        pose = {"position": {"x": x}, "orientation": {"w": 1.0}}
        values = {"header": header(frame, stamp_ns), "pose": pose}
        self.publish(topic, "geometry_msgs/msg/PoseStamped", values)

    def turn(self) -> None:
        self.viewer.turn()

    def statuses(self, index: int = 0) -> dict[str, tuple[str, str]]:
        """Level and sentence by key of one display, as a panel would show them now."""
        self.viewer._next_panel = 0.0
        self.turn()
        row = self.states[-1].rows[index]
        return {key: (status.level.name, status.text) for key, status in row.statuses.items()}


@pytest.fixture
def bench() -> Iterator[Callable[..., Bench]]:
    made: list[Bench] = []

    def make(*displays: Display, **options: Any) -> Bench:
        made.append(Bench(*displays, **options))
        return made[-1]

    yield make
    for each in made:
        each.viewer._workers.close()

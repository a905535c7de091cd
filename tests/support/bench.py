"""A viewer without ROS and browser: a source fed by hand and a scene that remembers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any

from recording import RecordingScene
from ros_messages import SECOND, header, serialized

from webviz.config import Config, Settings
from webviz.display import Display
from webviz.sources import Inbox, Offer, Publisher, Raw, Subscription
from webviz.state import State
from webviz.viewer import Viewer


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
        cdr = serialized(type_name, values)
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


@contextmanager
def benches() -> Iterator[Callable[..., Bench]]:
    """Makes benches, and ends them all."""
    made: list[Bench] = []

    def make(*displays: Display, **options: Any) -> Bench:
        made.append(Bench(*displays, **options))
        return made[-1]

    yield make
    for each in made:
        each.viewer._workers.close()

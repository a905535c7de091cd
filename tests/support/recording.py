"""A scene that remembers what is drawn, where `webviz.scene.Scene` would send it to browsers."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from dataclasses import dataclass, field

from webviz.frames import compose
from webviz.nodes import Node, Pose, Rgb


@dataclass
class RecordingScene:
    """Groups of nodes as a browser would have them."""

    groups: dict[str, dict[str, tuple[Node, Pose]]] = field(default_factory=dict)
    poses: dict[str, Pose] = field(default_factory=dict)
    hidden: set[str] = field(default_factory=set)
    watched: bool = True
    upserts: int = 0
    background: Rgb | None = None

    def set_background(self, rgb: Rgb) -> None:
        self.background = rgb

    def set_pose(self, group: str, pose: Pose) -> None:
        self.poses[group] = pose

    def set_visible(self, group: str, visible: bool) -> None:
        (self.hidden.discard if visible else self.hidden.add)(group)

    def upsert(self, group: str, key: str, node: Node, pose: Pose) -> None:
        self.groups.setdefault(group, {})[key] = (node, pose)
        self.upserts += 1

    def remove(self, group: str, key: str) -> None:
        self.groups.get(group, {}).pop(key, None)

    def remove_group(self, group: str) -> None:
        self.groups.pop(group, None)
        self.poses.pop(group, None)
        self.hidden.discard(group)

    def flush(self) -> None:
        pass

    def has_watchers(self) -> bool:
        return self.watched

    def visible(self) -> Iterator[tuple[str, Pose, Node]]:
        """Key, pose in the fixed frame and node of all that can be seen.

        A key that is used in several groups gets a number.
        """
        numbers: dict[str, Iterator[int]] = {}
        for group, nodes in self.groups.items():
            if group in self.hidden:
                continue
            for key, (node, pose) in nodes.items():
                number = next(numbers.setdefault(key, itertools.count()))
                whole = compose(self.poses.get(group, Pose()), pose)
                yield (f"{key} {number}" if number else key), whole, node

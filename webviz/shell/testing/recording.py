"""A scene that remembers what is drawn, and passes it on to a browser when there is one."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Protocol

from webviz.api.bounds import Box, bounds, union
from webviz.api.frames import compose
from webviz.api.nodes import Node, Pose, Rgb
from webviz.engine.scene import Cameras, NoCameras, Scene


class Target(Scene, Protocol):
    """Where to pass everything on to; see `webviz.edges.scene.Scene`."""

    def clear(self) -> None:
        """Remove everything."""
        ...


@dataclass
class RecordingScene:
    """Groups of nodes as a browser would have them.

    Whoever looks from another thread than the one that draws holds `lock`, and so does that one
    from one flush to the next.
    """

    groups: dict[str, dict[str, tuple[Node, Pose]]] = field(default_factory=dict)
    poses: dict[str, Pose] = field(default_factory=dict)
    hidden: set[str] = field(default_factory=set)
    watched: bool = True
    upserts: int = 0
    background: Rgb | None = None
    lock: threading.RLock = field(default_factory=threading.RLock)
    cameras: Cameras = field(default_factory=NoCameras)
    _target: Target | None = None

    def attach(self, target: Target) -> None:
        """Draw everything there as well, now and from now on."""
        with self.lock:
            self._target = target
            if self.background:
                target.set_background(self.background)
            for group, nodes in self.groups.items():
                for key, (node, pose) in nodes.items():
                    target.upsert(group, key, node, pose)
            for group, pose in self.poses.items():
                target.set_pose(group, pose)
            for group in self.hidden:
                target.set_visible(group, False)
            target.flush()

    def detach(self) -> None:
        """Remove everything there, and draw there no more."""
        with self.lock:
            if self._target is not None:
                self._target.clear()
                self._target.flush()
            self._target = None

    def bounds(self, prefix: str) -> Box | None:
        """The box around all that is visible of the groups of a prefix."""
        return union(
            box.moved(pose).moved(self.poses.get(name, Pose()))
            for name, nodes in self.groups.items()
            if name.startswith(prefix) and name not in self.hidden
            for node, pose in nodes.values()
            if (box := bounds(node)) is not None
        )

    def set_background(self, rgb: Rgb) -> None:
        """Fill what lies behind everything with one colour."""
        self.background = rgb
        if self._target is not None:
            self._target.set_background(rgb)

    def set_pose(self, group: str, pose: Pose) -> None:
        """Place a group in the fixed frame."""
        self.poses[group] = pose
        if self._target is not None:
            self._target.set_pose(group, pose)

    def set_visible(self, group: str, visible: bool) -> None:
        """Show or hide a group."""
        (self.hidden.discard if visible else self.hidden.add)(group)
        if self._target is not None:
            self._target.set_visible(group, visible)

    def upsert(self, group: str, key: str, node: Node, pose: Pose) -> None:
        """Draw a node at a pose in its group, in place of the one with this key."""
        self.groups.setdefault(group, {})[key] = (node, pose)
        self.upserts += 1
        if self._target is not None:
            self._target.upsert(group, key, node, pose)

    def remove(self, group: str, key: str) -> None:
        """Remove a node."""
        self.groups.get(group, {}).pop(key, None)
        if self._target is not None:
            self._target.remove(group, key)

    def remove_group(self, group: str) -> None:
        """Remove a group with all its nodes."""
        self.groups.pop(group, None)
        self.poses.pop(group, None)
        self.hidden.discard(group)
        if self._target is not None:
            self._target.remove_group(group)

    def flush(self) -> None:
        """Pass on what was changed."""
        if self._target is not None:
            self._target.flush()

    def has_watchers(self) -> bool:
        """A test watches."""
        return self.watched

    def visible(self, prefix: str = "") -> Iterator[tuple[str, Pose, Node]]:
        """Key, pose in the fixed frame and node of all that can be seen.

        A key that is used in several groups gets a number.

        Args:
            prefix: of group names.
        """
        numbers: dict[str, Iterator[int]] = {}
        for group, nodes in self.groups.items():
            if group in self.hidden or not group.startswith(prefix):
                continue
            for key, (node, pose) in nodes.items():
                number = next(numbers.setdefault(key, itertools.count()))
                whole = compose(self.poses.get(group, Pose()), pose)
                yield (f"{key} {number}" if number else key), whole, node

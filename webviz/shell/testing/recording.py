"""A scene that records what is drawn, and forwards it to a browser if one is attached."""

from __future__ import annotations

import itertools
import threading
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from webviz.api.bounds import Box, box_around
from webviz.api.frames import compose
from webviz.api.nodes import POINTS_HELD, Node, Pose, Rgb
from webviz.engine.pipeline.browsers import Browsers, NoBrowsers
from webviz.engine.pipeline.scene import Cameras, NoCameras

if TYPE_CHECKING:
    from webviz.scene import ViserScene


@dataclass
class RecordingScene:
    """Groups of nodes as in a browser.

    Hold `lock` to read it in another thread than the one that draws. That thread holds it from one
    flush to the next.
    """

    groups: dict[str, dict[str, tuple[Node, Pose]]] = field(default_factory=dict)
    poses: dict[str, Pose] = field(default_factory=dict)
    hidden: set[str] = field(default_factory=set)
    watched: bool = True
    upserts: int = 0
    max_points: int = POINTS_HELD
    unseen: set[str] = field(default_factory=set)
    """Ids of displays whose panes are hidden."""
    background: Rgb | None = None
    lock: threading.RLock = field(default_factory=threading.RLock)
    cameras: Cameras = field(default_factory=NoCameras)
    browsers: Browsers = field(default_factory=NoBrowsers)
    _targets: list[ViserScene] = field(default_factory=list)
    """The attached scene, if any."""

    def attach(self, target: ViserScene) -> None:
        """Draw everything in another scene as well, from now on."""
        with self.lock:
            self._targets = [target]
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
        """Clear the attached scene, and stop drawing there."""
        with self.lock:
            for target in self._targets:
                target.clear()
                target.flush()
            self._targets = []

    def bounds(self, prefix: str, most: int = 0) -> Box | None:
        """Return the bounding box of all visible groups with a prefix."""
        placed = [
            (node, pose, self.poses.get(name, Pose()))
            for name, nodes in self.groups.items()
            if name.startswith(prefix) and name not in self.hidden
            for node, pose in nodes.values()
        ]
        return box_around(placed, most)

    def set_background(self, rgb: Rgb | None) -> None:
        """Set the background to one colour; None is that of each page, which follows its theme."""
        self.background = rgb
        for target in self._targets:
            target.set_background(rgb)

    def set_pose(self, group: str, pose: Pose) -> None:
        """Place a group in the fixed frame."""
        self.poses[group] = pose
        for target in self._targets:
            target.set_pose(group, pose)

    def set_visible(self, group: str, visible: bool) -> None:
        """Show or hide a group."""
        (self.hidden.discard if visible else self.hidden.add)(group)
        for target in self._targets:
            target.set_visible(group, visible)

    def upsert(self, group: str, key: str, node: Node, pose: Pose) -> None:
        """Draw a node at a pose in a group, in place of the one with the same key."""
        self.groups.setdefault(group, {})[key] = (node, pose)
        self.upserts += 1
        for target in self._targets:
            target.upsert(group, key, node, pose)

    def remove(self, group: str, key: str) -> None:
        """Remove a node."""
        self.groups.get(group, {}).pop(key, None)
        for target in self._targets:
            target.remove(group, key)

    def remove_group(self, group: str) -> None:
        """Remove a group with its nodes."""
        self.groups.pop(group, None)
        self.poses.pop(group, None)
        self.hidden.discard(group)
        for target in self._targets:
            target.remove_group(group)

    def flush(self) -> None:
        """Send the changes."""
        for target in self._targets:
            target.flush()

    def has_watchers(self) -> bool:
        """Return whether viewers draw."""
        return self.watched

    def is_unseen(self, display: str) -> bool:
        """Return whether pages have a pane for a display, but none shows it."""
        return display in self.unseen

    def points_held(self) -> int:
        """Return the number of points browsers draw fast enough."""
        return self.max_points

    def visible(self, prefix: str = "") -> Iterator[tuple[str, Pose, Node]]:
        """Key, pose in the fixed frame and node of all visible nodes.

        Duplicate keys of several groups are numbered.

        Args:
            prefix: of the names of groups.
        """
        numbers: dict[str, Iterator[int]] = {}
        for group, nodes in self.groups.items():
            if group in self.hidden or not group.startswith(prefix):
                continue
            for key, (node, pose) in nodes.items():
                number = next(numbers.setdefault(key, itertools.count()))
                whole = compose(self.poses.get(group, Pose()), pose)
                yield (f"{key} {number}" if number else key), whole, node

"""The scene of all browsers: rigid groups of nodes."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

import viser

from webviz.api.bounds import Box, box_around
from webviz.api.nodes import (
    Arrows,
    Axes,
    Glb,
    Image,
    Instances,
    Labels,
    Lines,
    Mesh,
    Models,
    Node,
    Pane,
    Points,
    Pose,
    Rgb,
)
from webviz.engine.pipeline.browsers import Browsers
from webviz.scene.adapter import Adapter, Move, Position, Wxyz
from webviz.scene.adapter.image import set_background
from webviz.scene.axes import AxesVisual
from webviz.scene.browsers import ViserBrowsers
from webviz.scene.cameras import ViserCameras
from webviz.scene.capacity import PointCapacities
from webviz.scene.images import ImageVisual
from webviz.scene.instances import InstancesVisual
from webviz.scene.labels import LabelsVisual
from webviz.scene.lines import ArrowsVisual, LinesVisual
from webviz.scene.meshes import GlbVisual, MeshVisual, ModelsVisual
from webviz.scene.names import ROOT, display_of, node_path
from webviz.scene.points import PointsVisual, keep_shaders
from webviz.scene.visual import NodeVisual


class PaneVisual:
    """A picture in the pane of its display; nothing of it is in the scene of viser."""

    def __init__(self, link: Adapter, name: str) -> None:
        self._link = link
        self._display = display_of(name)
        self._node: Pane | None = None
        self._is_visible = True

    def draw(self, node: Pane) -> None:
        """Show another picture."""
        self._node = node
        if self._is_visible:
            self._link.pictures.show(self._display, node)

    def set_visible(self, visible: bool) -> None:
        """Hides or shows the picture."""
        if visible == self._is_visible:
            return
        self._is_visible = visible
        if not visible:
            self.remove()
        elif self._node is not None:
            self.draw(self._node)

    def remove(self) -> None:
        """Forgets the picture."""
        self._link.pictures.remove(self._display)


_VISUALS: dict[type, Callable[[Adapter, str], NodeVisual[Any]]] = {
    Points: PointsVisual,
    Lines: LinesVisual,
    Arrows: ArrowsVisual,
    Axes: AxesVisual,
    Labels: LabelsVisual,
    Mesh: MeshVisual,
    Instances: InstancesVisual,
    Models: ModelsVisual,
    Glb: GlbVisual,
    Image: ImageVisual,
    Pane: PaneVisual,
}

_IDENTITY = Pose()


class ViserScene:
    """Groups of nodes, each with one pose in the fixed frame.

    Methods only record changes; `flush` compares the result with what was sent and sends the
    difference in one piece. All methods belong to one thread.

    Args:
        server: as from `open_server`.
    """

    def __init__(self, server: viser.ViserServer) -> None:
        self.link = Adapter(server)
        self._groups: dict[str, _Group] = {}
        self._dirty: dict[str, _Group] = {}
        self._removals: list[_Group] = []
        keep_shaders(server.scene, ROOT)
        self.cameras = ViserCameras(self.link)
        self._capacities = PointCapacities(self.link)
        self.browsers: Browsers = ViserBrowsers(self.link, self.cameras, self._capacities.reports)
        self.attended_until_s = 0.0
        """Monotonic time until which a program looks, without a browser."""

    def has_watchers(self) -> bool:
        """Return whether any browser is connected, or a program attends."""
        return self.link.watchers > 0 or time.monotonic() < self.attended_until_s

    def is_unseen(self, display: str) -> bool:
        """Return whether pages have a pane for a display id, but none has shown it for a while."""
        return self.link.pictures.is_unseen(display)

    def points_held(self) -> int:
        """Return the number of points every connected browser draws fast enough."""
        return self._capacities.points()

    def set_background(self, rgb: Rgb | None) -> None:
        """Set the background to one colour; None is that of each page, which follows its theme."""
        set_background(self.link.server, rgb)

    def set_pose(self, group: str, pose: Pose) -> None:
        """Places a group in the fixed frame; a new group is at the identity.

        Raises:
            ValueError: the pose is not finite.
        """
        entry = self._groups.get(group)
        if entry is not None and entry.pose == pose:
            return
        if not math.isfinite(sum(pose.position) + sum(pose.wxyz)):
            raise ValueError(f"The pose of {group!r} is not finite.")
        self._touch(group).pose = pose

    def upsert(self, group: str, key: str, node: Node, pose: Pose = _IDENTITY) -> None:
        """Draws a node at a pose in a group, in place of the one with the same key."""
        contents = self._touch(group)
        contents.nodes[key] = (node, pose)
        contents.dirty[key] = None

    def remove(self, group: str, key: str) -> None:
        """Remove a node, if it exists."""
        if group in self._groups and key in self._groups[group].nodes:
            contents = self._touch(group)
            del contents.nodes[key]
            contents.dirty[key] = None

    def remove_group(self, group: str) -> None:
        """Remove a group with its nodes and pose, if it exists."""
        self._dirty.pop(group, None)
        if group in self._groups:
            self._removals.append(self._groups.pop(group))

    def set_visible(self, group: str, visible: bool) -> None:
        """Hides or shows a group; hidden nodes may be changed."""
        self._touch(group).visible = visible

    def bounds(self, prefix: str, most: int = 0) -> Box | None:
        """Return the bounding box in the fixed frame of all visible groups with a prefix."""
        placed = [
            (node, pose, group.pose)
            for name, group in self._groups.items()
            if name.startswith(prefix) and group.visible
            for node, pose in group.nodes.values()
        ]
        return box_around(placed, most)

    def clear(self) -> None:
        """Remove every group."""
        for group in tuple(self._groups):
            self.remove_group(group)

    def flush(self) -> None:
        """Send everything that changed since the last flush, in one piece.

        Raises:
            Exception: a node is malformed. It is dropped and named in a note; the rest follows in
                the next flush.
        """
        self.link.deferred.deliver()
        texts = self.link.label_budget
        if not self._dirty and not self._removals and not texts.is_waiting:
            return
        moves: list[Move] = []
        with self.link.atomic():
            while self._removals:
                self._removals.pop().remove(self.link)
            texts.deliver()
            try:
                for name, group in tuple(self._dirty.items()):
                    group.send(self.link, moves)
                    del self._dirty[name]
            finally:
                self.link.place(moves)
        if texts.is_unfinished:
            self.link.deferred.wake()

    def acknowledge(self, timeout: float) -> None:
        """Wait until every browser has applied everything that was flushed.

        Raises:
            TimeoutError: it takes longer than `timeout` seconds.
        """
        self.complete(timeout)
        self.link.acknowledge(timeout)

    def complete(self, timeout: float) -> None:
        """Queue everything for browsers that was flushed and is still being made.

        Raises:
            TimeoutError: it takes longer than `timeout` seconds.
        """
        self.link.deferred.finish(timeout)
        while self.link.label_budget.is_unfinished:
            self.flush()

    def _touch(self, name: str) -> _Group:
        group = self._groups.get(name)
        if group is None:
            group = self._groups[name] = _Group(name)
        self._dirty[name] = group
        return group


class _Group:
    """A rigid group: its wanted state, and the state in the browsers."""

    def __init__(self, name: str) -> None:
        self.pose = Pose()
        self.visible = True
        self.nodes: dict[str, tuple[Node, Pose]] = {}
        self.dirty: dict[str, None] = {}
        self._name = name
        self._path = node_path(name)
        self._handle: viser.FrameHandle | None = None
        self._sent_position: Position | None = None
        self._sent_wxyz: Wxyz | None = None
        self._sent_visible = True
        self._visuals: dict[str, tuple[Node, Pose, NodeVisual[Any]]] = {}

    def send(self, link: Adapter, moves: list[Move]) -> None:
        """Send the changes, except for the pose of the group, which is added to `moves`."""
        if self._handle is None:
            self._handle = link.server.scene.add_frame(self._path, show_axes=False)
        position = self.pose.position
        is_moved, is_turned = position != self._sent_position, self.pose.wxyz != self._sent_wxyz
        if is_moved or is_turned:
            self._sent_position, self._sent_wxyz = position, self.pose.wxyz
            wxyz = self.pose.wxyz if is_turned else None
            moves.append((self._path, position if is_moved else None, wxyz))
        if self.visible != self._sent_visible:
            self._handle.visible = self._sent_visible = self.visible
        for key in tuple(self.dirty):
            del self.dirty[key]
            try:
                self._send_node(link, key)
            except Exception as error:
                error.add_note(f"while drawing {key!r} of {self._name!r}")
                raise
        for pane in self._panes():
            pane.set_visible(self.visible)

    def _send_node(self, link: Adapter, key: str) -> None:
        entry, former = self.nodes.get(key), self._visuals.get(key)
        if former is not None and (entry is None or type(entry[0]) is not type(former[0])):
            former[2].remove()
            link.count_removals(1)
            del self._visuals[key]
            former = None
        if entry is None:
            return
        node, pose = entry
        path = node_path(self._name, key)
        handle = _VISUALS[type(node)](link, path) if former is None else former[2]
        is_new = former is None or node != former[0]
        if is_new:
            handle.draw(node)
        # Some primitives recreate their viser node when drawn, at the identity.
        if pose != (_IDENTITY if former is None else former[1]) or (is_new and pose != _IDENTITY):
            link.set_position(path, pose.position)
            link.set_orientation(path, pose.wxyz)
        self._visuals[key] = (node, pose, handle)

    def _panes(self) -> list[PaneVisual]:
        return [pane for _, _, pane in self._visuals.values() if isinstance(pane, PaneVisual)]

    def remove(self, link: Adapter) -> None:
        link.deferred.drop(self._path)
        for _, _, handle in self._visuals.values():  # all others are below the frame of the group
            if isinstance(handle, PaneVisual):
                handle.remove()
            elif isinstance(handle, LabelsVisual):
                handle.forget()
        if self._handle is not None:
            self._handle.remove()
            link.count_removals(1 + len(self._visuals))

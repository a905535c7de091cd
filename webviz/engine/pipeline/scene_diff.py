"""The groups of one display in the scene, updated by their differences."""

from __future__ import annotations

import itertools
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import fields
from typing import Protocol

import msgspec
import numpy as np

from webviz.api.context import Context, Group, Placement
from webviz.api.frames import Frames, compose
from webviz.api.nodes import Node, Pose, has_content
from webviz.api.sample import Sample
from webviz.engine.commands import NodePicks
from webviz.engine.pipeline.baking import Position, bake
from webviz.engine.pipeline.picking import PickedItem, SceneSnapshot, found_in

KEPT_S = 3.0
"""Longer than a picture is under way to a browser."""
MAX_BYTES = 64_000_000
"""Limit in bytes of arrays; the messages that they were made of take about as much again."""
MAX_SNAPSHOTS = 200


class RecentSnapshots:
    """Keeps what was replaced, for some seconds.

    Args:
        clock: monotonic time in seconds.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._snapshots: deque[tuple[float, str, SceneSnapshot, int]] = deque()
        self._bytes = 0

    def keep(self, scope: str, snapshot: SceneSnapshot) -> None:
        """Keep what was drawn in a scope until now."""
        size = _size(snapshot)
        self._bytes += size
        self._snapshots.append((self._clock(), scope, snapshot, size))
        self._trim()

    def of(self, scope: str) -> Iterator[SceneSnapshot]:
        """Yield the pictures of a scope, newest first."""
        self._trim()
        return (snapshot for _, name, snapshot, _ in reversed(self._snapshots) if name == scope)

    def _trim(self) -> None:
        oldest = self._clock() - KEPT_S
        while self._snapshots and (
            self._snapshots[0][0] < oldest
            or self._bytes > MAX_BYTES
            or len(self._snapshots) > MAX_SNAPSHOTS
        ):
            self._bytes -= self._snapshots.popleft()[3]


def _size(snapshot: SceneSnapshot) -> int:
    nodes = (node for group in snapshot.groups.values() for node in group.nodes.values())
    values = (getattr(node, f.name) for node in nodes for f in fields(node))
    return sum(value.nbytes for value in values if isinstance(value, np.ndarray))


_IDENTITY = Pose()


class SceneWriter(Protocol):
    """Draws groups of nodes; see `webviz.scene.ViserScene`."""

    def set_pose(self, group: str, pose: Pose) -> None:
        """Place a group in the fixed frame."""
        ...

    def set_visible(self, group: str, visible: bool) -> None:
        """Show or hide a group."""
        ...

    def upsert(self, group: str, key: str, node: Node, pose: Pose) -> None:
        """Draw a node at a pose in its group, replacing the node with this key."""
        ...

    def remove(self, group: str, key: str) -> None:
        """Remove a node."""
        ...

    def remove_group(self, group: str) -> None:
        """Remove a group with all its nodes."""
        ...


class _SceneGroup(msgspec.Struct):
    """A group in the scene.

    Args:
        group: as the display drew it last.
        origin: of the coordinates that were sent, if poses were baked into them.
        pose: last pose of the frame that the group follows.
        moved_ns: time of that pose.
        fixed_frame: of that pose.
        visible: None before anything was sent.
    """

    group: Group
    origin: Position = (0.0, 0.0, 0.0)
    pose: Pose | None = None
    moved_ns: int = 0
    fixed_frame: str = ""
    visible: bool | None = None


class _Followers(msgspec.Struct):
    """Groups that follow one frame in the same way.

    Args:
        placement: of one of them; the offsets of others differ.
        groups: with their names.
        pose: of the frame when all of them were moved last.
        fixed_frame: of that pose; "" before.
    """

    placement: Placement
    groups: list[tuple[str, _SceneGroup]] = msgspec.field(default_factory=list)
    pose: Pose | None = None
    fixed_frame: str = ""


def groups_of(context: Context) -> dict[str, Group]:
    """Return the context itself by "", and its groups that follow frames by their keys."""
    return {"": context, **context.groups}


class SceneDiff:
    """The groups that one display draws, by scope; each call of a hook fills one scope.

    Args:
        scene: where to draw.
        prefix: of group names, unique to the display.
    """

    def __init__(self, scene: SceneWriter, prefix: str) -> None:
        self._scene = scene
        self._prefix = prefix
        self._scopes: dict[str, dict[str, _SceneGroup]] = {}
        self._drawn_from: dict[str, tuple[Sequence[Sample], str]] = {}
        """Samples and fixed frame of each scope, from which it was drawn."""
        self._recent: RecentSnapshots | None = None
        self.tint: Callable[[Node], Node] | None = None
        """Gives nodes another look; None for their own."""
        self._followers: list[_Followers] | None = None
        """All groups that follow frames; None if they have changed."""

    def remember(self, is_wanted: bool) -> None:
        """Keep what is replaced for some seconds, for `find`."""
        if is_wanted != (self._recent is not None):
            self._recent = RecentSnapshots() if is_wanted else None

    def find(self, picks: NodePicks) -> dict[int, PickedItem]:
        """Return the items browsers picked, by id; none that was on no recent screen."""
        scope, _, group = picks.group.removeprefix(f"{self._prefix}/").partition("/")
        snapshots = [self._snapshot(scope)] if scope in self._scopes else []
        items: dict[int, PickedItem] = {}
        for snapshot in itertools.chain(snapshots, self._recent.of(scope) if self._recent else ()):
            missing = [item for item in picks.items if item[0] not in items]
            if not missing:
                break
            items |= found_in(snapshot, group, picks.key, missing)
        return items

    def snapshots(self) -> Iterator[tuple[str, str, SceneSnapshot]]:
        """Yield the name of each group, its key, and the picture that it is a part of."""
        for scope in self._scopes:
            snapshot = self._snapshot(scope)
            for key in snapshot.groups:
                yield self._name(scope, key), key, snapshot

    def replace(self, scope: str, context: Context, samples: Sequence[Sample] = ()) -> None:
        """Make the content of a scope exactly what a context collected from samples."""
        self._keep(scope)
        self._followers = None
        self._drawn_from[scope] = samples, context.frames.fixed_frame
        before = self._scopes.get(scope, {})
        after: dict[str, _SceneGroup] = {}
        for key, group in groups_of(context).items():
            if not group.nodes:
                continue
            name, entry = self._name(scope, key), before.get(key)
            if entry is None:
                entry = _SceneGroup(group)
            elif entry.group is group:  # as it was drawn before
                after[key] = entry
                continue
            else:
                for old in entry.group.nodes.keys() - group.nodes.keys():
                    self._scene.remove(name, old)
                if entry.group.placement != group.placement:
                    entry.pose = None
                entry.group = group
            self._put(name, entry, context.frames)
            after[key] = entry
        for key in before.keys() - after.keys():
            self._scene.remove_group(self._name(scope, key))
        self._scopes[scope] = after

    def origins(self, scope: str) -> dict[str, Position]:
        """Return the origins of the coordinates that were sent last, by group; see `baking`."""
        return {key: entry.origin for key, entry in self._scopes.get(scope, {}).items()}

    def remove(self, scope: str) -> None:
        """Remove the content of a scope."""
        self._keep(scope)
        self._followers = None
        self._drawn_from.pop(scope, None)
        for key in self._scopes.pop(scope, {}):
            self._scene.remove_group(self._name(scope, key))

    def clear(self) -> None:
        """Remove everything."""
        for scope in list(self._scopes):
            self.remove(scope)

    def followed(self) -> set[str]:
        """Return the frames whose poses `move` needs."""
        return {each.placement.frame for each in self._following() if each.placement.frame}

    def move(self, frames: Frames) -> None:
        """Move all groups with the frames that they follow."""
        for each in self._following():
            pose = _pose(each.placement, frames)
            is_placed = pose is each.pose and each.fixed_frame == frames.fixed_frame
            if is_placed and not each.placement.interval_s:
                continue
            for name, entry in each.groups:
                self._follow(name, entry, frames)
            each.pose, each.fixed_frame = pose, frames.fixed_frame

    def forget_poses(self) -> None:
        """Keep no pose where frames were, such as after a jump of time back."""
        for groups in self._scopes.values():
            for entry in groups.values():
                entry.pose, entry.fixed_frame = None, ""
        self._followers = None

    def is_empty(self) -> bool:
        """Return whether nothing of the display is visible."""
        return not any(
            entry.visible and any(map(has_content, entry.group.nodes.values()))
            for groups in self._scopes.values()
            for entry in groups.values()
        )

    def unplaced_frames(self, frames: Frames) -> list[str]:
        """Return the frames without a pose that hidden groups follow."""
        placements = [each.placement for each in self._following()]
        return sorted(
            {p.frame for p in placements if p.frame and not p.keep_last and not _pose(p, frames)}
        )

    def _following(self) -> list[_Followers]:
        if self._followers is None:
            by_way: dict[object, _Followers] = {}
            for scope, groups in self._scopes.items():
                for key, entry in groups.items():
                    p = entry.group.placement
                    if p.frame is not None:
                        way = p.frame, p.when, p.keep_last, p.interval_s
                        followers = by_way.setdefault(way, _Followers(p))
                        followers.groups.append((self._name(scope, key), entry))
            self._followers = list(by_way.values())
        return self._followers

    def _keep(self, scope: str) -> None:
        if self._recent is not None and scope in self._scopes:
            self._recent.keep(scope, self._snapshot(scope))

    def _snapshot(self, scope: str) -> SceneSnapshot:
        entries = self._scopes[scope].items()
        samples, fixed_frame = self._drawn_from[scope]
        return SceneSnapshot({key: each.group for key, each in entries}, samples, fixed_frame)

    def _put(self, name: str, entry: _SceneGroup, frames: Frames) -> None:
        """Send a group that is new or changed."""
        group = entry.group
        if self.tint is not None and not group.is_tinted:
            group.nodes = {key: self.tint(node) for key, node in group.nodes.items()}
            group.is_tinted = True
        if group.placement.frame is not None:
            self._follow(name, entry, frames)
        else:
            entry.origin = bake(group, entry.origin)
            self._scene.set_pose(name, group.placement.offset)
            self._show(name, entry, True)
        for key, node in group.nodes.items():
            self._scene.upsert(name, key, node, group.poses.get(key, Pose()))

    def _follow(self, name: str, entry: _SceneGroup, frames: Frames) -> None:
        placement = entry.group.placement
        is_placed = entry.pose is not None and entry.fixed_frame == frames.fixed_frame
        rest = entry.moved_ns + placement.interval_s * 1e9 - frames.now_ns
        if is_placed and placement.interval_s and rest > 0:
            return
        pose = _pose(placement, frames)
        if pose is None and placement.keep_last and placement.frame and entry.pose is None:
            pose = frames.passed(placement.frame)
        if pose is None:
            stays = placement.keep_last and entry.fixed_frame == frames.fixed_frame
            self._show(name, entry, stays)
            return
        if pose is not entry.pose or not is_placed:
            offset = placement.offset
            self._scene.set_pose(name, pose if offset == _IDENTITY else compose(pose, offset))
            entry.pose, entry.fixed_frame = pose, frames.fixed_frame
        entry.moved_ns = frames.now_ns
        self._show(name, entry, True)

    def _show(self, name: str, entry: _SceneGroup, visible: bool) -> None:
        if entry.visible != visible:
            entry.visible = visible
            self._scene.set_visible(name, visible)

    def _name(self, scope: str, key: str) -> str:
        return f"{self._prefix}/{scope}/{key}"


def _pose(placement: Placement, frames: Frames) -> Pose | None:
    frame = placement.frame
    if frame is None:
        return Pose()
    return frames.latest(frame) if placement.when == "latest" else frames.now(frame)

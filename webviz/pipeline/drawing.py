"""What one display has in the scene, changed by as little as possible."""

from __future__ import annotations

from typing import Protocol

from webviz.context import Context, Group, Placement
from webviz.frames import Frames, compose
from webviz.nodes import Node, Pose, has_content
from webviz.pipeline.baking import Position, baked, can_bake, origin_near


class Scene(Protocol):
    """Draws groups of nodes; see `webviz.scene.Scene`."""

    def set_pose(self, group: str, pose: Pose) -> None:
        """Place a group in the fixed frame."""
        ...

    def set_visible(self, group: str, visible: bool) -> None:
        """Show or hide a group."""
        ...

    def upsert(self, group: str, key: str, node: Node) -> None:
        """Draw a node, in place of the one with this key."""
        ...

    def remove(self, group: str, key: str) -> None:
        """Remove a node."""
        ...

    def remove_group(self, group: str) -> None:
        """Remove a group with all its nodes."""
        ...


class Drawing:
    """The groups that one display draws, by scope: one call of a hook fills one scope.

    Args:
        scene: where to draw.
        prefix: of group names, unique to the display.
    """

    def __init__(self, scene: Scene, prefix: str) -> None:
        self._scene = scene
        self._prefix = prefix
        self._scopes: dict[str, dict[str, Group]] = {}
        self._shown: dict[str, bool] = {}
        self._origins: dict[str, Position] = {}

    def replace(self, scope: str, context: Context) -> None:
        """Make a scope exactly what a context collected."""
        before = self._scopes.get(scope, {})
        after = {key: group for key, group in context.groups.items() if group.nodes}
        for key in before.keys() - after.keys():
            self._drop(self._name(scope, key))
        for key, group in after.items():
            name = self._name(scope, key)
            for old in before[key].nodes.keys() - group.nodes.keys() if key in before else ():
                self._scene.remove(name, old)
            self._put(name, group, context.frames)
        if after:
            self._scopes[scope] = after
        else:
            self._scopes.pop(scope, None)

    def remove(self, scope: str) -> None:
        """Remove all that a scope drew."""
        for key in self._scopes.pop(scope, {}):
            self._drop(self._name(scope, key))

    def clear(self) -> None:
        """Remove everything."""
        for scope in list(self._scopes):
            self.remove(scope)

    def move(self, frames: Frames) -> None:
        """Bring all groups that follow a frame to where it is now."""
        for scope, groups in self._scopes.items():
            for key, group in groups.items():
                if group.placement.frame is not None:
                    self._place(self._name(scope, key), group.placement, frames)

    def is_empty(self) -> bool:
        """Whether nothing of the display can be seen."""
        return not any(
            self._shown.get(self._name(scope, key))
            for scope, groups in self._scopes.items()
            for key, group in groups.items()
            if any(map(has_content, group.nodes.values()))
        )

    def lost(self, frames: Frames) -> list[str]:
        """The frames that hidden groups follow in vain."""
        return sorted(
            {
                group.placement.frame
                for groups in self._scopes.values()
                for group in groups.values()
                if group.placement.frame
                and not group.placement.keep_last
                and _pose(group.placement, frames) is None
            }
        )

    def _put(self, name: str, group: Group, frames: Frames) -> None:
        """Send a group that is new or changed."""
        nodes, placement = group.nodes, group.placement
        if placement.frame is None and all(map(can_bake, nodes.values())):
            origin = origin_near(
                placement.offset.position, self._origins.get(name, (0.0, 0.0, 0.0))
            )
            self._origins[name] = origin
            nodes = {key: baked(node, placement.offset, origin) for key, node in nodes.items()}
            placement = Placement(offset=Pose(origin))
        self._place(name, placement, frames)
        for key, node in nodes.items():
            self._scene.upsert(name, key, node)

    def _drop(self, name: str) -> None:
        self._scene.remove_group(name)
        self._shown.pop(name, None)
        self._origins.pop(name, None)

    def _place(self, name: str, placement: Placement, frames: Frames) -> None:
        pose = _pose(placement, frames)
        if pose is not None:
            self._scene.set_pose(name, compose(pose, placement.offset))
        visible = pose is not None or (placement.keep_last and name in self._shown)
        if self._shown.get(name) != visible:
            self._shown[name] = visible
            self._scene.set_visible(name, visible)

    def _name(self, scope: str, key: str) -> str:
        return f"{self._prefix}/{scope}/{key}"


def _pose(placement: Placement, frames: Frames) -> Pose | None:
    frame = placement.frame
    if frame is None:
        return Pose()
    if placement.when == "latest":
        return frames.latest(frame)
    return frames.now(frame)

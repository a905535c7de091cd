"""A planning scene, as the messages of MoveIt change it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import msgspec
from msgspec.structs import replace

from webviz import Lookback, Pose
from webviz_displays.moveit.bodies import Body, body_of, named
from webviz_displays.moveit.joints import JointValues, joints_of, pose_of

ADD, REMOVE, APPEND, MOVE = range(4)
"""Operations of moveit_msgs/CollisionObject."""
MAX_BYTES = 256 << 20
"""Limit in bytes of the objects of a scene; a message that would exceed it is not applied to
them."""
MAX_NAMES = 20_000
"""Objects, colours and transforms of each kind."""
MAX_HELD = 500
"""Objects that a robot holds: they are placed anew whenever it moves."""
LONGEST_KEY = 10_000
"""Characters of a name; things with longer ones are ignored."""

Rgba = tuple[float, float, float, float]


class Attached(msgspec.Struct, frozen=True, eq=False):
    """An object that a link holds; its pose is that in the frame of the link."""

    link: str
    body: Body


class KnownScene(msgspec.Struct, frozen=True, eq=False):
    """Known state of a scene. Mappings that a message does not change stay the same objects.

    Args:
        name: of the scene.
        robot: name of the robot's model.
        frame: that everything is given in, "" if unknown.
        is_whole: whether a message with the whole scene was received.
        joints: of the robot.
        objects: by id.
        removed: ids of objects that were removed.
        attached: by id of the object.
        loose: ids of objects that were detached.
        colors: of objects by id, 0 to 1.
        octomap: octomap_msgs/OctomapWithPose, None if there is none.
        transforms: poses of further frames in `frame`.
        faults: what was wrong with the newest message, sentences.
    """

    name: str = ""
    robot: str = ""
    frame: str = ""
    is_whole: bool = False
    joints: JointValues = msgspec.field(default_factory=JointValues)
    objects: Mapping[str, Body] = msgspec.field(default_factory=dict)
    removed: frozenset[str] = frozenset()
    attached: Mapping[str, Attached] = msgspec.field(default_factory=dict)
    loose: frozenset[str] = frozenset()
    colors: Mapping[str, Rgba] = msgspec.field(default_factory=dict)
    octomap: Any = None
    transforms: Mapping[str, Pose] = msgspec.field(default_factory=dict)
    faults: tuple[str, ...] = ()

    def over(self, base: KnownScene) -> KnownScene:
        """Return this scene, which has changes only, applied to a whole one."""
        objects = {key: each for key, each in base.objects.items() if key not in self.removed}
        attached = {key: each for key, each in base.attached.items() if key not in self.loose}
        return replace(
            self,
            name=self.name or base.name,
            robot=self.robot or base.robot,
            frame=base.frame or self.frame,
            joints=self.joints.over(base.joints),
            objects={**objects, **self.objects},
            attached={**attached, **self.attached},
            colors={**base.colors, **self.colors},
            octomap=base.octomap if self.octomap is None else self.octomap,
            transforms={**base.transforms, **self.transforms},
        )


SINCE_WHOLE = Lookback(starts_over=lambda message, _: not message.is_diff)
"""Lookback of scenes: all changes since the last whole one."""


def updated(scene: KnownScene, message: Any) -> KnownScene:
    """Return a scene after a moveit_msgs/PlanningScene: the whole of it, or changes."""
    if not message.is_diff:
        scene = KnownScene(is_whole=True)
    edit = _Edit(scene)
    edit.state(message.robot_state)
    for each in message.object_colors:
        edit.color(each.id, each.color)
    for each in message.world.collision_objects:
        edit.object(each)
    for each in message.fixed_frame_transforms:
        edit.transform(each)
    octomap = message.world.octomap if message.world.octomap.octomap.id else scene.octomap
    return replace(
        edit.result(),
        name=message.name or scene.name,
        robot=message.robot_model_name or scene.robot,
        frame=edit.joints.frame or _parent(message.fixed_frame_transforms) or scene.frame,
        octomap=octomap,
    )


def updated_state(scene: KnownScene, state: Any) -> KnownScene:
    """Return a scene after a moveit_msgs/RobotState, with what the robot holds."""
    edit = _Edit(scene)
    edit.state(state)
    return replace(edit.result(), frame=edit.joints.frame or scene.frame)


def _parent(transforms: Iterable[Any]) -> str:
    return next((each.parent.lstrip("/") for each in transforms), "")


class _Edit:
    """Changes to a scene; what they do not touch is not copied."""

    def __init__(self, scene: KnownScene) -> None:
        self._scene = scene
        self.joints = scene.joints
        self._objects: dict[str, Body] | None = None
        self._attached: dict[str, Attached] | None = None
        self._colors: dict[str, Rgba] | None = None
        self._transforms: dict[str, Pose] | None = None
        self._removed, self._loose = set(scene.removed), set(scene.loose)
        self._faults: list[str] = []
        self._size = 0

    def result(self) -> KnownScene:
        """Return the scene with all changes."""
        before = self._scene
        return replace(
            before,
            joints=self.joints,
            objects=before.objects if self._objects is None else self._objects,
            removed=frozenset(self._removed),
            attached=before.attached if self._attached is None else self._attached,
            loose=frozenset(self._loose),
            colors=before.colors if self._colors is None else self._colors,
            transforms=before.transforms if self._transforms is None else self._transforms,
            faults=tuple(dict.fromkeys([*self.joints.faults, *self._faults])),
        )

    def state(self, state: Any) -> None:
        """Take a moveit_msgs/RobotState."""
        joints = joints_of(state)
        self.joints = joints.over(self.joints)
        if not state.is_diff and self._scene.attached and not joints.is_empty:
            self._attachments().clear()
        for each in state.attached_collision_objects:
            if each.object.operation == REMOVE:
                self._detach(each)
            else:
                self._attach(each)

    def object(self, message: Any) -> None:
        """Take an object of the world."""
        key, operation = message.id, int(message.operation)
        if operation == REMOVE and not key:
            self._removed |= self._world().keys()
            self._world().clear()
            self._size = 0
        elif operation == REMOVE:
            self._drop(key)
        elif operation == MOVE:
            self._move(message)
        elif operation in (ADD, APPEND):
            body = self._read(message)
            if body is None:
                return
            if operation == APPEND and (before := self._world().get(key)):
                body = before.joined(body)
            self._put(body)
        else:
            self._faults.append(f"Object {named(key)} has the unknown operation {operation}.")

    def color(self, key: str, color: Any) -> None:
        """Take the colour of an object."""
        rgba = (float(color.r), float(color.g), float(color.b), float(color.a))
        if not all(0.0 <= part <= 1.0 for part in rgba):
            self._faults.append(f"The colour of object {named(key)} is not in 0 to 1.")
        elif self._fits(key, self._colors or self._scene.colors):
            if self._colors is None:
                self._colors = dict(self._scene.colors)
            self._colors[key] = rgba

    def transform(self, each: Any) -> None:
        """Take the pose of a frame in that of the scene."""
        x, y, z, w = each.rotation
        pose = pose_of(each.translation, (w, x, y, z))
        child = each.child.lstrip("/")
        if pose is not None and self._fits(child, self._transforms or self._scene.transforms):
            if self._transforms is None:
                self._transforms = dict(self._scene.transforms)
            self._transforms[child] = pose

    def _attach(self, message: Any) -> None:
        key = message.object.id
        if not self._fits(key, self._attachments(), MAX_HELD):
            return
        there = self._world().get(key)
        has_shapes = any(map(len, (message.object.primitives, message.object.meshes)))
        if not has_shapes and there is not None:
            # What the world has is taken from where it is; the link's frame is known when drawn.
            body = there
        elif (body := self._read(message.object)) is None:
            return
        self._drop(key)
        self._attachments()[key] = Attached(message.link_name.lstrip("/"), body)
        self._loose.discard(key)

    def _detach(self, message: Any) -> None:
        """Back into the world: one object, all of a link, or all."""
        key, link = message.object.id, message.link_name.lstrip("/")
        attached_objects = self._attachments()
        keys = (
            [key] if key else [k for k, each in attached_objects.items() if link in ("", each.link)]
        )
        for each in keys:
            self._loose.add(each)
            if (attached := attached_objects.pop(each, None)) is not None:
                self._put(replace(attached.body, frame=attached.body.frame or attached.link))

    def _move(self, message: Any) -> None:
        key = message.id
        before = self._world().get(key)
        if before is None:
            self._faults.append(f"Object {named(key)} cannot be moved, as it is not known.")
        elif (body := body_of(message)) is None:
            self._faults.append(f"Object {named(key)} has an invalid pose.")
        else:
            self._put(replace(before, pose=body.pose, frame=body.frame))

    def _read(self, message: Any) -> Body | None:
        body = body_of(message)
        if body is None:
            self._faults.append(f"Object {named(message.id)} has an invalid pose.")
            return None
        if not body.shapes and not body.faults:
            self._faults.append(f"Object {named(message.id)} has no shapes.")
            return None
        return body

    def _put(self, body: Body) -> None:
        if not self._fits(body.id, self._world()):
            return
        world = self._world()
        before = world.get(body.id)
        size = self._size + body.size - (before.size if before else 0)
        if size > MAX_BYTES:
            self._faults.append(f"The objects take more than {MAX_BYTES >> 20} MB.")
            return
        self._size = size
        world[body.id] = body
        self._removed.discard(body.id)

    def _drop(self, key: str) -> None:
        if (before := self._world().pop(key, None)) is not None:
            self._size -= before.size
        if self._fits(key, self._removed):
            self._removed.add(key)

    def _fits(self, key: str, among: Any, most: int = MAX_NAMES) -> bool:
        if len(key) > LONGEST_KEY:
            self._faults.append(f"The name {named(key)} has {len(key)} characters.")
            return False
        if key not in among and len(among) >= most:
            which = "attached objects" if among is self._attached else "objects"
            self._faults.append(f"Only the first {most} {which} are kept.")
            return False
        return True

    def _world(self) -> dict[str, Body]:
        if self._objects is None:
            self._objects = dict(self._scene.objects)
            self._size = sum(each.size for each in self._objects.values())
        return self._objects

    def _attachments(self) -> dict[str, Attached]:
        if self._attached is None:
            self._attached = dict(self._scene.attached)
        return self._attached

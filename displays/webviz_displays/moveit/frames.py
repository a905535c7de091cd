"""Poses of the objects of a scene: in the frame of the scene, once and for all.

An object may be given in any frame: of a link, of another object or one of its subframes, or of a
transform. As in MoveIt it is placed when it arrives, and does not move with that frame later.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping

import msgspec

from webviz import Frames, Pose, compose
from webviz_displays.moveit.bodies import Body
from webviz_displays.moveit.scene import KnownScene
from webviz_displays.shared.geometry import inverse

Links = Mapping[str, Pose]
"""Poses of a robot's links in the frame of the scene, by name."""
_HERE = Pose()


class Places(msgspec.Struct):
    """The places of objects, as far as they are known.

    Args:
        world: of objects in the frame of the scene, with the object.
        attached_objects: of attached objects in the frame of their link, with the object.
    """

    world: dict[str, tuple[Body, Pose]] = msgspec.field(default_factory=dict)
    attached_objects: dict[str, tuple[Body, Pose]] = msgspec.field(default_factory=dict)

    def update(self, scene: KnownScene, frame: str, links: Links, frames: Frames) -> list[Body]:
        """Place what is new; the objects whose frame is unknown."""
        self.world = _still(self.world, scene.objects)
        self.attached_objects = _still(
            self.attached_objects, {key: each.body for key, each in scene.attached.items()}
        )
        new = [body for key, body in scene.objects.items() if key not in self.world]
        if new:
            self.world = dict(self.world)
        unplaced = self._place(new, scene, frame, links, frames)
        for key, attached in scene.attached.items():
            if key in self.attached_objects:
                continue
            body, link = attached.body, links.get(attached.link)
            base = self.base(body.frame or attached.link, scene, frame, links, frames)
            if body.frame in ("", attached.link):
                self.attached_objects[key] = body, body.pose
            elif base is None or link is None:
                unplaced.append(body)
            else:
                self.attached_objects[key] = body, compose(inverse(link), compose(base, body.pose))
        return unplaced

    def _place(
        self, bodies: list[Body], scene: KnownScene, frame: str, links: Links, frames: Frames
    ) -> list[Body]:
        """Add bodies to the world; those whose frame is unknown."""
        outside: dict[str, Pose | None] = {}
        waiting: dict[str, list[Body]] = {}
        """Bodies that are given relative to others of the same message, by the names of those."""
        ready = deque(bodies)
        while ready:
            body = ready.popleft()
            if body.id in self.world:
                continue
            base = self._pose_of(body.frame, scene, frame, links)
            if base is None:
                if body.frame not in outside:
                    outside[body.frame] = _between(frame, body.frame, frames)
                base = outside[body.frame]
            if base is None:
                for name in {body.frame, body.frame.partition("/")[0]}:
                    waiting.setdefault(name, []).append(body)
            else:
                pose = body.pose if base is _HERE else compose(base, body.pose)
                self.world[body.id] = body, pose
                ready += waiting.pop(body.id, ())
        return [body for body in bodies if body.id not in self.world]

    def attached(self, scene: KnownScene, links: Links) -> dict[str, Pose]:
        """Return the poses of attached objects in the scene's frame, where the link has one."""
        return {
            key: compose(links[attached.link], self.attached_objects[key][1])
            for key, attached in scene.attached.items()
            if key in self.attached_objects and attached.link in links
        }

    def base(
        self, name: str, scene: KnownScene, frame: str, links: Links, frames: Frames
    ) -> Pose | None:
        """Return the pose of a frame in that of the scene."""
        return self._pose_of(name, scene, frame, links) or _between(frame, name, frames)

    def _pose_of(self, name: str, scene: KnownScene, frame: str, links: Links) -> Pose | None:
        """Return the pose of a frame of the scene, robot or object in the scene's frame."""
        if name in ("", frame):
            return _HERE
        if (link_pose := links.get(name) or scene.transforms.get(name)) is not None:
            return link_pose
        key, _, subframe = name.partition("/")
        for whole, part in ((name, ""), (key, subframe)):
            if whole in self.world:
                body, pose = self.world[whole]
                inner = body.subframes.get(part) if part else _HERE
                return inner and compose(pose, inner)
        return None


def _between(frame: str, name: str, frames: Frames) -> Pose | None:
    """Return the pose of a frame in `frame`, by transforms."""
    here, there = frames.latest(frame), frames.latest(name)
    return compose(inverse(here), there) if here and there else None


def _still(
    poses: dict[str, tuple[Body, Pose]], bodies: Mapping[str, Body]
) -> dict[str, tuple[Body, Pose]]:
    """Return the poses of unchanged bodies, as the same mapping if all are."""
    if all(bodies.get(key) is each[0] for key, each in poses.items()):
        return poses
    return {key: each for key, each in poses.items() if bodies.get(key) is each[0]}

"""Where the objects of a scene are: in the frame of the scene, once and for all.

An object may be given in any frame: of a link, of another object or one of its subframes, or of a
transform. As in MoveIt it is placed when it arrives, and does not move with that frame later.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from webviz import Frames, Pose, compose
from webviz_displays.moveit.bodies import Body
from webviz_displays.moveit.scene import KnownScene
from webviz_displays.shared.geometry import inverse

Links = Mapping[str, Pose]
"""Poses of a robot's links in the frame of the scene, by name."""


@dataclass
class Places:
    """The places of objects, as far as they are known.

    Args:
        world: of objects in the frame of the scene, with the object.
        held: of attached objects in the frame of their link, with the object.
    """

    world: dict[str, tuple[Body, Pose]] = field(default_factory=dict)
    held: dict[str, tuple[Body, Pose]] = field(default_factory=dict)

    def update(self, scene: KnownScene, frame: str, links: Links, frames: Frames) -> list[Body]:
        """Place what is new; the objects whose frame is unknown."""
        self.world = _still(self.world, scene.objects)
        self.held = _still(self.held, {key: each.body for key, each in scene.attached.items()})
        lost: list[Body] = []
        waiting = [body for key, body in scene.objects.items() if key not in self.world]
        # Objects may be given relative to others of the same message.
        while waiting:
            bases = [self.base(body.frame, scene, frame, links, frames) for body in waiting]
            found = {
                body.id: (body, compose(base, body.pose))
                for body, base in zip(waiting, bases, strict=True)
                if base is not None
            }
            waiting = [body for body in waiting if body.id not in found]
            if not found:
                lost += waiting
                break
            self.world = {**self.world, **found}
        for key, attached in scene.attached.items():
            if key in self.held:
                continue
            body, link = attached.body, links.get(attached.link)
            base = self.base(body.frame or attached.link, scene, frame, links, frames)
            if body.frame in ("", attached.link):
                self.held[key] = body, body.pose
            elif base is None or link is None:
                lost.append(body)
            else:
                self.held[key] = body, compose(inverse(link), compose(base, body.pose))
        return lost

    def attached(self, scene: KnownScene, links: Links) -> dict[str, Pose]:
        """The poses of attached objects in the frame of the scene, where the link has one."""
        return {
            key: compose(links[attached.link], self.held[key][1])
            for key, attached in scene.attached.items()
            if key in self.held and attached.link in links
        }

    def base(
        self, name: str, scene: KnownScene, frame: str, links: Links, frames: Frames
    ) -> Pose | None:
        """The pose of a frame in that of the scene."""
        if name in ("", frame):
            return Pose()
        if (known := links.get(name) or scene.transforms.get(name)) is not None:
            return known
        key, _, subframe = name.partition("/")
        for whole, part in ((name, ""), (key, subframe)):
            if whole in self.world:
                body, pose = self.world[whole]
                inner = body.subframes.get(part) if part else Pose()
                return inner and compose(pose, inner)
        here, there = frames.latest(frame), frames.latest(name)
        return compose(inverse(here), there) if here and there else None


def _still(
    known: dict[str, tuple[Body, Pose]], bodies: Mapping[str, Body]
) -> dict[str, tuple[Body, Pose]]:
    """Those that are the same as before; the same mapping if all are."""
    if all(bodies.get(key) is each[0] for key, each in known.items()):
        return known
    return {key: each for key, each in known.items() if bodies.get(key) is each[0]}

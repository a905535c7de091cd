"""Drawing of a robot in many poses at once: each of its shapes is sent once."""

from __future__ import annotations

import msgspec
import numpy as np

from webviz import Context, Details, Glb, Hit, Instances, Mesh, Models, Node, Pose, Shape
from webviz.data.rotations import multiply_many
from webviz_displays.moveit.bodies import Primitives
from webviz_displays.moveit.joints import F64
from webviz_displays.moveit.paths import JointPath
from webviz_displays.moveit.robots import RobotLook, Robots
from webviz_displays.robot_model.parts import parts_of
from webviz_displays.shared.geometry import transformed
from webviz_urdf import glb_parts

MAX_STATES = 100
"""States of the robot in a trail."""
KEY = "trail "


class PathTrail(msgspec.Struct):
    """Poses of the robot on its path.

    Args:
        owners: link of each node by its key.
    """

    owners: dict[str, str] = msgspec.field(default_factory=dict)
    _of: tuple[JointPath, int] | None = None
    _rows: list[int] = msgspec.field(default_factory=list)
    _poses: dict[str, tuple[F64, F64]] = msgspec.field(default_factory=dict)
    _nodes: dict[int, tuple[Node, Shape | tuple[bytes, ...]]] = msgspec.field(default_factory=dict)

    def draw(
        self,
        robots: Robots,
        path: JointPath,
        step: int,
        last: int,
        look: RobotLook,
        frame: str,
        ctx: Context,
    ) -> None:
        """Draw every `step`th state and the last one, as far as `last`.

        Args:
            robots: with a model.
            path: with points.
            step: from one state to the next.
            last: number of the last point that may be drawn.
            look: of the robot.
            frame: that places it.
            ctx: receives the nodes.
        """
        model = robots.model
        assert model is not None
        if self._of != (path, step):
            self._of = path, step
            self._place(robots, path, step)
        count = sum(row <= last for row in self._rows)
        group = ctx.follow(frame, key=KEY)
        self.owners.clear()
        made_before, self._nodes = self._nodes, {}
        for part in parts_of(model.robot, model.full, look.choices, robots.paint):
            node = robots.paint(part.node, color=look.color_of(part.link))
            if not isinstance(node, Mesh | Glb) or part.link not in self._poses:
                continue
            xyz, wxyz = (each[:count] for each in self._poses[part.link])
            here = _moved(xyz, wxyz, part.pose)
            before = made_before.get(id(node))
            same = before[1] if before and before[0] is node else _repeatable(node)
            self._nodes[id(node)] = node, same
            for number, each in enumerate(_repeated(node, same, here)):
                key = f"{KEY}{part.key} {number}"
                group.add(key, each)
                self.owners[key] = part.link

    def inspect(self, hit: Hit) -> Details | None:
        """Return a link in a state of the trail."""
        if hit.key not in self.owners or hit.id is None:
            return None
        return Details(f"Link {self.owners[hit.key]}", {"Point": str(self._rows[hit.id] + 1)})

    def _place(self, robots: Robots, path: JointPath, step: int) -> None:
        assert robots.model is not None
        poser, end = robots.model.poser, len(path) - 1
        self._rows = sorted({*range(0, end, step), end})
        states = [poser.place(path.values[row], path.poses[row]) for row in self._rows]
        self._poses = {
            link: (
                np.array([state[link].position for state in states]),
                np.array([state[link].wxyz for state in states]),
            )
            for link in robots.model.robot.links
            if all(link in state for state in states)
        }


def _moved(xyz: F64, wxyz: F64, pose: Pose) -> Primitives:
    """Return a pose given relative to many."""
    turned = [transformed(Pose(wxyz=tuple(turn)), pose.position) for turn in wxyz.tolist()]
    places = xyz + np.array(turned).reshape(-1, 3)
    return Primitives(places, multiply_many(wxyz, np.array(pose.wxyz)), np.ones_like(places))


def _repeatable(node: Mesh | Glb) -> Shape | tuple[bytes, ...]:
    if isinstance(node, Mesh):
        return Shape(node.vertices, node.faces)
    return glb_parts(node.data)


def _repeated(node: Node, same: Shape | tuple[bytes, ...], at: Primitives) -> list[Node]:
    places, turns, scales = (each.astype(np.float32) for each in at)
    if isinstance(same, Shape):
        assert isinstance(node, Mesh)
        return [Instances(places, scales, node.color, same, turns, node.opacity)]
    return [Models(places, turns, scales, data) for data in same]

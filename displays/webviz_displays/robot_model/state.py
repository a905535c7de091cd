"""The robot that a display shows, and what follows from it."""

from __future__ import annotations

import msgspec

from webviz import Frames
from webviz.data.transforms import Explanation
from webviz_displays.robot_model.loading import Loadings, Written
from webviz_displays.robot_model.parts import Paint
from webviz_displays.robot_model.placing import JointPlacer, Placing
from webviz_displays.shared.trails import Trails
from webviz_urdf import Robot


class LoadedRobot(msgspec.Struct, frozen=True, eq=False):
    """A loaded robot.

    Args:
        robot: without collision shapes.
        full: with them; None if they are switched off or still loading.
        placing: where its links are.
        shown: links that are switched on.
    """

    robot: Robot
    full: Robot | None
    placing: Placing
    shown: tuple[str, ...]

    def lost(self, frames: Frames) -> list[str]:
        """Return enabled links without a pose."""
        pose = self.placing.pose
        return [link for link in self.shown if pose(link, frames) is None]


class RobotDrawing(msgspec.Struct):
    """The robot that is shown, and what follows from it.

    Args:
        loading: what is being loaded.
        written: when the description file was.
        model: the robot, None until one is loaded.
        grey: links that were drawn without a transform, None before anything was drawn.
        paint: the colours of parts.
        reasons: why links are lost.
        reasons_of: which links, and at which second that was asked.
        trails: of links, in `trails_frame`.
        trails_frame: fixed frame.
        owners: the link of each part that was drawn, by its key.
        placer: places the robot by its joints.
    """

    loading: Loadings = msgspec.field(default_factory=dict)
    written: Written = msgspec.field(default_factory=Written)
    model: LoadedRobot | None = None
    grey: set[str] | None = None
    paint: Paint = msgspec.field(default_factory=Paint)
    reasons: dict[str, Explanation] = msgspec.field(default_factory=dict)
    reasons_of: tuple[list[str], int] | None = None
    trails: Trails = msgspec.field(default_factory=Trails)
    trails_frame: str = ""
    owners: dict[str, str] = msgspec.field(default_factory=dict)
    placer: JointPlacer | None = None

"""A static frame in another pose: where would its data be if it were mounted like that?"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.api.errors import Error
from webviz.api.frames import compose, is_placeable, to_pose
from webviz.api.nodes import Pose
from webviz.data.rotations import conjugate, to_rpy, w_last
from webviz.data.transforms import TransformException
from webviz.data.transforms.pinned import is_pinned, pin, unpin
from webviz.data.transforms.tree import ancestors
from webviz.engine.commands import Command, EndTrial, FindFrame, Sender, TryFrame
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.part import Core, Handler, Part
from webviz.engine.pipeline import Runner, Services
from webviz.engine.pipeline.frame_handle import FrameHandle, FrameTrial
from webviz.engine.state import WhatIf

ID = "whatif"
"""Of the display with the handle."""
NO_SCAN = (
    "Not found: no laser scan of this frame is compared with a map. Add displays of both, and wait "
    "until they are drawn."
)


class WhatIfPart(Part):
    """Tries one static frame at a time in another pose, for this viewer alone.

    Args:
        core: shared by all parts.
        displays: all of them.
        services: for the handle.
    """

    name = "What if"

    def __init__(self, core: Core, displays: DisplaysPart, services: Services) -> None:
        super().__init__(core)
        self._displays = displays
        self._services = services
        self._trial: FrameTrial | None = None
        self._browser: int | None = None

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """The handler of each command."""
        return {TryFrame: self._try, FindFrame: self._find, EndTrial: self._end}

    def keep_up(self, commanded: bool) -> None:
        """End when the frame is not a static one any more."""
        trial = self._trial
        if trial and not is_pinned(self.core.buffer, trial.frame):
            self._leave()

    def state(self) -> Mapping[str, Any]:
        """Return the trial, and how well scans fit."""
        trial = self._trial
        if trial is None:
            return {"what_if": None}
        names = {
            runner.id: runner.display.name or type(runner.display).__name__
            for runner in self._displays.list.active()
        }
        fits = {
            names[id]: (fit.fit.share, fit.fit.points, fit.map_topic)
            for id, fit in self._displays.consistency.fits.items()
            if id in names and self._carries(fit.frame)
        }
        rpy = to_rpy(trial.pose.wxyz)
        found = WhatIf(trial.frame, trial.parent, trial.pose.position, rpy, fits, self._browser)
        return {"what_if": found}

    def close(self) -> None:
        """End the trial."""
        self._leave()

    def _try(self, command: TryFrame, sender: Sender) -> None:
        self._leave()
        buffer, frame = self.core.buffer, command.frame
        link = buffer.link(frame)
        if link is None or not link.is_static:
            raise Error(f"'{frame}' does not have a static transform. Choose one that has.")
        pose = to_pose(link.transform)
        if not is_placeable(pose):
            raise Error(f"'{frame}' is too far away, or its pose is not finite.")
        trial = FrameTrial(frame, link.parent, pose, pose, self._move)
        self._trial, self._browser = trial, sender.browser
        self._move(pose)
        self._displays.list.aids[:] = [Runner(ID, FrameHandle(trial=trial), self._services)]

    def _move(self, pose: Pose) -> None:
        trial = self._trial
        if trial is None or not is_placeable(pose):
            return
        x, y, z, w = w_last(pose.wxyz)
        pin(self.core.buffer, trial.frame, (*pose.position, x, y, z, w))
        trial.pose = pose
        trial.version += 1
        self._displays.consistency.hurry()

    def _find(self, command: FindFrame, sender: Sender) -> None:
        trial = self._trial
        if trial is None:
            raise Error("No frame is being tried. Choose one in the panel TF.")
        buffer = self.core.buffer
        below = {frame for frame in buffer.frames() if self._carries(frame)}
        found = self._displays.consistency.aligned(below)
        if found is None:
            raise Error(NO_SCAN)
        try:
            parent = to_pose(buffer.lookup(found.map_frame, trial.parent, found.stamp_ns))
        except TransformException as error:
            raise Error(NO_SCAN) from error
        # The correction in the map, applied to the tried frame as a whole.
        on_map = compose(parent, trial.pose)
        moved = compose(compose(found.after, _inverse(found.before)), on_map)
        self._move(compose(_inverse(parent), moved))

    def _end(self, command: EndTrial, sender: Sender) -> None:
        self._leave()

    def _leave(self) -> None:
        trial, self._trial = self._trial, None
        if trial is None:
            return
        unpin(self.core.buffer, trial.frame)
        for runner in self._displays.list.aids:
            runner.close()
        self._displays.list.aids.clear()
        self._displays.consistency.hurry()

    def _carries(self, frame: str) -> bool:
        """Return whether a frame moves with the one that is tried."""
        trial = self._trial
        return trial is not None and trial.frame in ancestors(self.core.buffer.tree, frame)


def _inverse(pose: Pose) -> Pose:
    w, x, y, z = conjugate(pose.wxyz).tolist()
    px, py, pz = pose.position
    return compose(Pose(wxyz=(w, x, y, z)), Pose((-px, -py, -pz)))

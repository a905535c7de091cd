"""The handles of all displays, and which browser holds each."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import msgspec

from webviz.api.errors import Error
from webviz.api.frames import is_placeable
from webviz.api.handles import Drag, Handle
from webviz.api.nodes import Pose
from webviz.engine.commands import Command, DragHandle, Sender
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.part import Core, Handler, Part
from webviz.engine.pipeline import Runner

SILENCE_S = 3.0
"""After which a browser that holds a handle is taken to be gone; it reports every half second."""


class _Hold(msgspec.Struct):
    """A handle in the hands of a browser.

    Args:
        browser: that holds it.
        drag: its newest.
        heard_s: when that came, monotonic.
    """

    browser: int | None
    drag: Drag
    heard_s: float


class HandlesPart(Part):
    """Passes on what browsers do with handles; each is held by one browser at a time.

    Args:
        core: shared by all parts.
        displays: all of them.
    """

    name = "Handles"

    def __init__(self, core: Core, displays: DisplaysPart) -> None:
        super().__init__(core)
        self._displays = displays
        self._holds: dict[tuple[str, str], _Hold] = {}
        self._found: Mapping[tuple[str, str], tuple[Handle, int | None]] = {}
        self._found_of: object = None
        """Inputs of these."""

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """The handler of each command."""
        return {DragHandle: self._drag}

    def keep_up(self, commanded: bool) -> None:
        """Release what silent browsers hold, and forget handles that are gone."""
        for (display, key), hold in list(self._holds.items()):
            runner = self._runner(display)
            if runner is None or key not in runner.handles():
                del self._holds[display, key]
            elif self.core.clock() - hold.heard_s > SILENCE_S:
                del self._holds[display, key]
                drag = replace(hold.drag, kind="release", pose=None, point=None)
                runner.drag(drag, self.core.frames)

    def state(self) -> Mapping[str, Any]:
        """All handles, with the browsers that hold them."""
        sample_buffers = {place: hold.browser for place, hold in self._holds.items()}
        of = (
            [(runner.id, runner.handles()) for runner in self._displays.list.active()],
            sample_buffers,
        )
        if self._found_of != of:  # quick, as unchanged handles are the same mapping
            self._found_of = of
            self._found = {
                (display, key): (handle, sample_buffers.get((display, key)))
                for display, handles in of[0]
                for key, handle in handles.items()
            }
        return {"handles": self._found}

    def _drag(self, command: DragHandle, sender: Sender) -> None:
        drag, place = _checked(command.drag), (command.display, command.drag.handle)
        runner = self._runner(command.display)
        handle = runner.handles().get(drag.handle) if runner else None
        if runner is None or handle is None or not 0 <= drag.control < len(handle.controls):
            raise Error("This handle no longer exists.")
        if handle.refusal:
            raise Error(handle.refusal)
        hold = self._holds.get(place)
        if hold is not None and hold.browser != sender.browser:
            raise Error(
                f"{handle.name}: in use by browser {hold.browser}. Wait until it is released."
            )
        if drag.kind == "press":
            if hold is not None:  # whose release got lost
                runner.drag(replace(hold.drag, kind="release", pose=None), self.core.frames)
            self._holds[place] = _Hold(sender.browser, drag, self.core.clock())
        elif drag.kind == "release":
            if self._holds.pop(place, None) is None:
                return
        elif drag.kind != "choose":
            if hold is None or hold.drag.control != drag.control:
                return  # it was taken from a browser that was silent for too long
            hold.drag, hold.heard_s = drag, self.core.clock()
        runner.drag(drag, self.core.frames)

    def _runner(self, id: str) -> Runner | None:
        return next((each for each in self._displays.list.active() if each.id == id), None)


def _checked(drag: Drag) -> Drag:
    """Return a drag with a finite pose and point within reach, and a unit quaternion."""
    pose = drag.pose
    if pose is not None:
        length = math.hypot(*pose.wxyz)
        if not (is_placeable(pose) and length > 1e-6):
            raise Error("Not moved: the pose is not finite, or too far away.")
        w, x, y, z = (value / length for value in pose.wxyz)
        pose = Pose(pose.position, (w, x, y, z))
    if drag.point is not None and not is_placeable(Pose(drag.point)):
        drag = replace(drag, point=None)
    if not math.isfinite(drag.turned):
        raise Error("Not moved: the angle is not finite.")
    return replace(drag, pose=pose, turned=math.remainder(drag.turned, 4 * math.pi))

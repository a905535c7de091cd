"""The runner of one display: passes it messages, calls its hooks, draws the result."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from webviz.api.capabilities import Comparable, capability
from webviz.api.consistency import ConsistencyInput
from webviz.api.declared import set_property
from webviz.api.display import Display, inputs, overrides
from webviz.api.frames import Frames
from webviz.api.handles import Drag, Handle
from webviz.api.observation import InputSeen
from webviz.api.picking import Details
from webviz.api.robots import NamespacedRobot, RobotFrames, robot_of
from webviz.api.status import LOADING, Level, OtherFixedFrame, Status, worst
from webviz.engine.commands import NodePicks
from webviz.engine.error_boundary import ErrorBoundary
from webviz.engine.pipeline.dragging import Dragging
from webviz.engine.pipeline.history import held_samples
from webviz.engine.pipeline.picking import PickedItem
from webviz.engine.pipeline.renderer import DrawReport, Renderer
from webviz.engine.pipeline.sample_buffer import SampleBuffer
from webviz.engine.pipeline.scene_diff import SceneDiff
from webviz.engine.pipeline.services import DisplayServices
from webviz.engine.pipeline.tinting import Tint
from webviz.sources import Advertisement, Offer, Raw, Subscription, merged

NOTHING_TO_DRAW = Status(
    Level.WARN,
    "Nothing to draw: the data is empty or the properties hide it. Check both.",
)
WORKING = Status(Level.IDLE, "Loading.")
WAITING = Status(Level.IDLE, "Waiting for the transforms at the time of the data.")
NO_BROWSER = Status(Level.OK, "Nothing is drawn until a browser connects.")


class Runner:
    """One running display.

    Args:
        id: unique name in the scene.
        display: changed through `set` only.
        services: shared by all.
    """

    def __init__(self, id: str, display: Display, services: DisplayServices) -> None:
        self.id = id
        self.display = display
        self.external_statuses: dict[str, Status] = {}
        """Statuses from elsewhere, shown with those of the display."""
        self._services = services
        self.scene_diff = SceneDiff(services.scene, id)
        """Nodes that are drawn."""
        self._renderer = Renderer(id, self.scene_diff, services.workers, services.points)
        self._dragging = Dragging(id, display, services)
        self._comparable = capability(display, Comparable)
        self._boundary = self._new_boundary()
        self._sample_buffer = self._new_sample_buffer()
        self._robot: NamespacedRobot | None = None
        self._known_by: object = None
        """Key by which the robot was found."""

    # Configuration

    def set(self, path: str, value: Any) -> None:
        """Change a property; the display is redrawn without waiting for a message.

        Raises:
            msgspec.ValidationError: the value is invalid; nothing was changed.
            AttributeError: the property does not exist.
        """
        topics = {name: topic for name, _, topic in inputs(self.display)}
        set_property(self.display, path, value)
        if topics != {name: topic for name, _, topic in inputs(self.display)}:
            self.reset()
            self._sample_buffer = self._new_sample_buffer()
        if not self.display.enabled:
            self.hide()
        self._renderer.is_stale = True

    def replace(self, display: Display) -> None:
        """Continue as an instance of another class, keeping messages and what is drawn.

        Messages are discarded if the inputs of the new class differ or it folds them.
        """
        old, self.display = self.display, display
        self._boundary = self._new_boundary()
        self._dragging.replace(display)
        self._comparable = capability(display, Comparable)
        if _sample_source(old) != _sample_source(display):
            self.reset()
            self._sample_buffer = self._new_sample_buffer()
        else:
            self._sample_buffer.replace(display, self._boundary)
        self._renderer.replace(display)

    @property
    def has_received(self) -> bool | None:
        """Return whether a message has arrived; None of a display without topics."""
        active = self._sample_buffer.inputs.active().values()
        return any(each.has_received for each in active) if active else None

    @property
    def order(self) -> int:
        """Place of the display in the list of displays."""
        return self._renderer.order

    @order.setter
    def order(self, order: int) -> None:
        self._renderer.is_stale |= order != self._renderer.order
        self._renderer.order = order

    def hide(self) -> None:
        """Draw nothing until the next call of `draw`; messages are kept, latched ones read anew."""
        self._sample_buffer.inputs.ask()
        self._renderer.hide()
        self._dragging.hide()

    def subscriptions(self) -> dict[str, Subscription]:
        """Return the subscriptions by topic, none while the display is disabled."""
        if not self.display.enabled:
            return {}
        return merged([self._sample_buffer.inputs.subscriptions(), self._dragging.subscriptions()])

    def advertisements(self) -> list[Advertisement]:
        """Return the publishers of the display, none while it is disabled."""
        return self._dragging.advertisements() if self.display.enabled else []

    def reset(self) -> None:
        """Discard all messages, such as after a jump of time."""
        self._sample_buffer.reset()
        self._services.tracer.forget(self.id)
        self._renderer.forget()
        self._dragging.hide()

    def close(self) -> None:
        """Remove everything from the scene, and end the slow work."""
        self._dragging.hide()
        self._renderer.close()
        self._services.tracer.forget(self.id)

    # One turn

    def take(
        self, batches: Mapping[str, Iterable[Raw]], frames: Frames, offers: Mapping[str, Offer]
    ) -> None:
        """Take the messages of this turn; cheap, also called without browsers."""
        if self.display.enabled:
            with self._services.tracer.timed(self.id):
                self._boundary("take", self._sample_buffer.take, batches, self._own(frames), offers)
            self._dragging.take(batches, offers)

    def draw(self, frames: Frames) -> None:
        """Update the scene."""
        if self.display.enabled:
            with self._services.tracer.timed(self.id):
                self._boundary("scene", self._draw, self._own(frames))

    def is_waiting(self) -> bool:
        """Return whether the newest message of an input waits for its transform."""
        return self.display.enabled and self._sample_buffer.inputs.is_waiting()

    def is_late(self) -> bool:
        """Return whether messages wait until a large one is merged."""
        return self.display.enabled and bool(self._sample_buffer.busy_with)

    def is_busy(self) -> bool:
        """Return whether the result of slow work is not drawn yet."""
        is_busy = (
            self._sample_buffer.busy_with or self._renderer.is_busy() or self._dragging.is_busy()
        )
        return self.display.enabled and bool(is_busy)

    def followed(self) -> set[str]:
        """Return the frames whose poses `draw` needs."""
        if not self.display.enabled:
            return set()
        return self.scene_diff.followed() | self._dragging.followed()

    def report(self) -> DrawReport:
        """Return what the display says of what it draws; no colours or credits if that is empty."""
        report = self._renderer.report()
        return (
            DrawReport(report.statuses, offered=report.offered)
            if self.scene_diff.is_empty()
            else report
        )

    def consistency_input(self, frames: Frames) -> ConsistencyInput | None:
        """Return the inputs of the consistency check; None if nothing of it can be seen."""
        if self._comparable is None or self.scene_diff.is_empty():
            return None
        context = self._renderer.context(self.display, self._boundary, self._own(frames))
        if context is None:
            return None
        samples = held_samples(self._sample_buffer.histories)
        return self._boundary.attempt(
            "consistency_input", None, self._comparable.consistency_input, samples, context
        )

    def observed(self) -> tuple[InputSeen, ...]:
        """Its inputs, as the checks of the doctor see them."""
        return self._sample_buffer.observed()

    # Handles

    def handles(self) -> Mapping[str, Handle]:
        """Return the handles browsers can drag, by key; another object only after a change."""
        return self._dragging.handles

    def drag(self, drag: Drag, frames: Frames) -> None:
        """Let the display take up what a browser does with a handle."""
        if context := self._renderer.context(self.display, self._boundary, self._own(frames)):
            self._dragging.drag(drag, self._boundary, context)

    # Selection

    def find(self, picks: NodePicks) -> dict[int, PickedItem]:
        """Return the items browsers picked, by id; none that was on no recent screen."""
        return self._boundary.attempt("selection", {}, self.scene_diff.find, picks)

    def inspect(self, item: PickedItem, frames: Frames) -> Details | None:
        """Return the details the display reports of a selected item, if it still exists."""
        return self._renderer.inspect(self.display, self._boundary, item.hit, self._own(frames))

    def shows(self, item: PickedItem) -> bool:
        """Return whether the message that something was drawn from is still drawn."""
        samples = item.hit.samples
        return not samples or self._renderer.has(samples[-1])

    def statuses(
        self,
        offers: Mapping[str, Offer],
        frames: Frames,
        dropped: Callable[[str], int],
        is_watched: bool,
    ) -> dict[str, Status]:
        """All statuses of the display, its own and the framework's, by key."""
        if not self.display.enabled:
            return {}
        own = self._own(frames)
        result = self._boundary.attempt("statuses", {}, self._statuses, offers, own, dropped)
        for text in self._boundary.crashes.values():
            result["Display"] = Status(Level.ERROR, text)
        result |= self.external_statuses
        is_missing = self.scene_diff.is_empty() and not type(self.display).reports_only
        if worst(result.values()) is Level.OK and is_missing:
            if not is_watched:
                result["Display"] = NO_BROWSER
            elif self.is_busy():
                result[LOADING] = WORKING
            elif self._sample_buffer.inputs.is_waiting():
                result["Transform"] = WAITING
            else:
                result["Display"] = NOTHING_TO_DRAW
        return result

    # Internal

    def _own(self, frames: Frames) -> Frames:
        """Return the frames by the names of the robot whose topics the display has."""
        robots = self._services.robots()
        if not robots:
            return frames
        known_by = robots, self._sample_buffer, self._dragging.topics()
        if known_by != self._known_by:
            self._known_by = known_by
            self._robot = robot_of([*self._sample_buffer.inputs.topics(), *known_by[-1]], robots)
            self.scene_diff.tint = self._tint()
        return RobotFrames(frames, self._robot) if self._robot else frames

    def _tint(self) -> Tint | None:
        """Return the look of the robot, None if it has none of its own."""
        robot = self._robot
        if robot is None or (robot.tint is None and robot.opacity == 1.0):
            return None
        return Tint(robot.tint, robot.opacity)

    def _new_boundary(self) -> ErrorBoundary:
        who = type(self.display).__name__
        return ErrorBoundary(who, self._services.strict, name=lambda: self.display.name)

    def _new_sample_buffer(self) -> SampleBuffer:
        return SampleBuffer(self.id, self.display, self._boundary, self._services)

    def _draw(self, frames: Frames) -> None:
        self._renderer.is_stale |= self._sample_buffer.prepare(frames)
        if context := self._renderer.context(self.display, self._boundary, frames):
            self._dragging.communicate(self._boundary, context)
        self._renderer.draw(self.display, self._boundary, self._sample_buffer.histories, frames)
        if self._services.tracer.wants(self.id) and not self._renderer.busy_with:
            self._services.tracer.drawn(self.id)

    def _statuses(
        self, offers: Mapping[str, Offer], frames: Frames, dropped: Callable[[str], int]
    ) -> dict[str, Status]:
        result = self._sample_buffer.statuses(offers, frames, dropped)
        if unplaced := self.scene_diff.unplaced_frames(frames):
            reason = frames.explain(unplaced[0])
            remedy = OtherFixedFrame.of(reason)
            result["Transform"] = Status(Level.ERROR, reason.sentence, remedy, reason)
        size = self._sample_buffer.busy_with or self._renderer.busy_with
        if size:
            level = Level.IDLE if self.scene_diff.is_empty() else Level.OK
            result[LOADING] = Status(level, f"Loading a message of {round(size / 1e6, 1):g} MB.")
        if self._sample_buffer.busy_with and self._sample_buffer.is_empty:
            return result  # the display would say that no message was received
        return {**result, **self._renderer.report().statuses}


def _sample_source(display: Display) -> tuple[object, ...]:
    """Return what must be equal for samples of one class to serve another."""
    return inputs(display), type(display).sync, overrides(display, "fold")

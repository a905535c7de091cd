"""Runs one display: feeds it messages, calls its hooks, draws what they say."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from webviz.api.declared import set_property
from webviz.api.display import Display, Keep, inputs, overrides
from webviz.api.frames import Frames
from webviz.api.nodes import Pose
from webviz.api.sample import Sample
from webviz.api.status import Level, Status, worst
from webviz.data.messages import MessageError, decode
from webviz.engine.pipeline.background import Workers
from webviz.engine.pipeline.drawing import Scene
from webviz.engine.pipeline.guard import CRASHED, Guard
from webviz.engine.pipeline.history import History
from webviz.engine.pipeline.intake import Arrival, Intake, intakes_of
from webviz.engine.pipeline.painter import Painter
from webviz.engine.sources import Offer, Raw, Subscription

NOTHING_TO_DRAW = Status(Level.WARN, "There is nothing to draw.")
NOBODY_WATCHES = Status(Level.OK, "Nothing is drawn until somebody opens the page.")


@dataclass(frozen=True)
class Services:
    """What all runners share.

    Args:
        scene: where to draw.
        workers: for slow work.
        resolve: the full name of a topic; raises ValueError.
        strict: raise what a display raises, as tests want it.
        clock: monotonic time in seconds, for rates and ages.
    """

    scene: Scene
    workers: Workers
    resolve: Callable[[str], str]
    strict: bool = False
    clock: Callable[[], float] = time.monotonic


class Runner:
    """One display at work.

    Args:
        id: unique name in the scene.
        display: its properties may be changed through `set` only.
        services: shared by all.
    """

    def __init__(self, id: str, display: Display, services: Services) -> None:
        self.id = id
        self.display = display
        self.remarks: dict[str, Status] = {}
        """What others have to say of the display, shown with its own statuses."""
        self._services = services
        self._painter = Painter(id, services.scene, services.workers)
        self._guard = self._new_guard()
        self._history = History()
        self._newest: Arrival | None = None
        self._folded: Any = None
        self._fixed_frame = ""
        self._intakes = intakes_of(self.display, self._services.resolve)
        self._every_message_counts = overrides(display, "fold") or overrides(display, "accept")

    # Configuration

    def set(self, path: str, value: Any) -> None:
        """Change a property; what is drawn follows without waiting for a message.

        Raises:
            msgspec.ValidationError: the value does not fit; nothing was changed.
            AttributeError: there is no such property.
        """
        topics = {name: topic for name, _, topic in inputs(self.display)}
        set_property(self.display, path, value)
        if topics != {name: topic for name, _, topic in inputs(self.display)}:
            self.reset()
            self._intakes = intakes_of(self.display, self._services.resolve)
        if not self.display.enabled:
            self.hide()
        self._painter.is_stale = True

    def replace(self, display: Display) -> None:
        """Go on as an instance of another class, with the messages and the picture there are.

        The messages are forgotten if the new class hears others or folds them.
        """
        old, self.display = self.display, display
        if inputs(old) != inputs(display) or overrides(old, "fold") != overrides(display, "fold"):
            self.reset()
            self._intakes = intakes_of(self.display, self._services.resolve)
        self._every_message_counts = overrides(display, "fold") or overrides(display, "accept")
        self._guard = self._new_guard()
        self._painter.replace(display)

    @property
    def order(self) -> int:
        """Place of the display in the list of displays."""
        return self._painter.order

    @order.setter
    def order(self, order: int) -> None:
        self._painter.is_stale |= order != self._painter.order
        self._painter.order = order

    def hide(self) -> None:
        """Draw nothing until `draw` is called again, and forget nothing."""
        self._painter.hide()

    def subscriptions(self) -> dict[str, Subscription]:
        """What the display needs to hear by topic, nothing while it is disabled."""
        if not self.display.enabled:
            return {}
        return {i.name: i.subscription() for i in self._heard().values() if i.name}

    def reset(self) -> None:
        """Forget all messages, as after a jump of time."""
        for intake in self._intakes.values():
            intake.reset()
        self._history = History()
        self._newest = self._folded = None
        self._painter.forget()

    def close(self) -> None:
        """Remove everything from the scene, and end the slow work."""
        self._painter.close()

    # One tick

    def take(
        self, batches: Mapping[str, Iterable[Raw]], frames: Frames, offers: Mapping[str, Offer]
    ) -> None:
        """Let the messages of this tick in; cheap, also when nobody watches."""
        if self.display.enabled:
            self._guard("take", self._take, batches, frames, offers)

    def draw(self, frames: Frames) -> None:
        """Bring the scene up to date."""
        if self.display.enabled:
            self._guard("scene", self._draw, frames)

    def is_waiting(self) -> bool:
        """Whether the newest message of an input waits for its transform."""
        return self.display.enabled and any(i.is_waiting for i in self._heard().values())

    def is_busy(self) -> bool:
        """Whether slow work of the display is still to be drawn."""
        return self.display.enabled and self._painter.is_busy()

    def followed(self) -> set[str]:
        """The frames whose poses `draw` will ask for."""
        return self._painter.followed() if self.display.enabled else set()

    def statuses(
        self,
        offers: Mapping[str, Offer],
        frames: Frames,
        dropped: Callable[[str], int],
        is_watched: bool,
    ) -> dict[str, Status]:
        """Everything the display and the framework have to say, by key."""
        if not self.display.enabled:
            return {}
        result = self._guard.attempt("statuses", {}, self._statuses, offers, frames, dropped)
        for text in self._guard.crashes.values():
            result["Display"] = Status(Level.ERROR, text)
        result |= self.remarks
        if worst(result.values()) is Level.OK and self._painter.is_empty():
            result["Display"] = NOTHING_TO_DRAW if is_watched else NOBODY_WATCHES
        return result

    # Inside

    def _new_guard(self) -> Guard:
        who = type(self.display).__name__
        return Guard(who, self._services.strict, name=lambda: self.display.name)

    def _take(
        self, batches: Mapping[str, Iterable[Raw]], frames: Frames, offers: Mapping[str, Offer]
    ) -> None:
        clock = self._services.clock()
        primary = next(iter(self._intakes), "")
        counting: list[tuple[str, Intake, Arrival]] = []
        for name, intake in self._heard().items():
            raws = batches.get(intake.name, ())
            waits = self._waits(name)
            arrivals = intake.take(raws, frames, offers.get(intake.name), clock, waits)
            if not arrivals:
                continue
            # How long messages go on shows once one is decoded, and the next ones wait for that.
            is_unknown = overrides(self.display, "duration_ns") and not intake.duration_ns
            if self._every_message_counts or is_unknown or self._keep() != Keep():
                counting += [(name, intake, arrival) for arrival in arrivals]
            elif name == primary:
                self._newest = arrivals[-1]
        for name, intake, arrival in sorted(counting, key=lambda item: item[2].raw.received_ns):
            self._let_in(name, intake, arrival, frames)
        if counting:
            self._history.trim(self._keep(), frames.now_ns)  # also while nobody watches

    def _draw(self, frames: Frames) -> None:
        if self._newest is not None:
            name, intake = next(iter(self._intakes.items()))
            arrival, self._newest = self._newest, None
            self._let_in(name, intake, arrival, frames)
        if frames.fixed_frame != self._fixed_frame:
            if self._fixed_frame:
                timed = self._waits(next(iter(self._intakes), ""))
                self._history.move(frames, self._fixed_frame, timed)
            self._fixed_frame = frames.fixed_frame
            self._painter.is_stale = True
        self._history.trim(self._keep(), frames.now_ns)
        self._painter.draw(self.display, self._guard, self._history, frames)

    def _statuses(
        self, offers: Mapping[str, Offer], frames: Frames, dropped: Callable[[str], int]
    ) -> dict[str, Status]:
        result: dict[str, Status] = {}
        clock = self._services.clock()
        for name, intake in self._heard().items():
            said = intake.statuses(offers, dropped(intake.name), frames, clock)
            title = "" if name == "topic" else f" ({name})"
            result |= {f"{key}{title}": status for key, status in said.items()}
        if lost := self._painter.lost(frames):
            result["Transform"] = Status(Level.ERROR, frames.why_not(lost[0]))
        if shortage := self._history.shortage(self._keep(), frames.now_ns):
            result["History"] = Status(Level.WARN, shortage)
        return result | self._painter.statuses()

    def _keep(self) -> Keep:
        keep = self._guard("history", self.display.history)
        return keep if isinstance(keep, Keep) else Keep()

    def _heard(self) -> dict[str, Intake]:
        if not overrides(self.display, "listens"):
            return self._intakes
        listens = self.display.listens
        heard = {name: self._guard("listens", listens, name) for name in self._intakes}
        return {name: i for name, i in self._intakes.items() if heard[name] is not False}

    def _waits(self, name: str) -> bool:
        return self._guard("waits", self.display.waits, name) is not False

    def _let_in(self, name: str, intake: Intake, arrival: Arrival, frames: Frames) -> None:
        """Decode a message and hold it, if the display wants it."""
        if not arrival.frame:
            pose = Pose()
        elif self._waits(name):
            pose = frames.at(arrival.frame, arrival.stamp_ns)
        else:
            pose = frames.now(arrival.frame) or Pose()
        if pose is None:
            return  # the buffer was cleared since; newer messages will tell
        try:
            message = decode(intake.spec.type, arrival.raw.cdr)
        except MessageError as error:
            intake.refuse(str(error))
            return
        intake.accepted()
        duration_ns = self._guard("duration", self.display.duration_ns, message)
        intake.measure(duration_ns if isinstance(duration_ns, int) else 0)
        sample = Sample(
            message, arrival.frame, arrival.stamp_ns, arrival.raw.received_ns, arrival.number, pose
        )
        if overrides(self.display, "fold"):
            self._fold(name, sample, len(arrival.raw.cdr))
            return
        verdict = self._guard("accept", self.display.accept, sample, self._history.samples())
        if isinstance(verdict, str):
            intake.refuse(verdict)
        elif verdict is True:
            self._history.add(sample, len(arrival.raw.cdr), self._keep())

    def _fold(self, name: str, sample: Sample, size: int) -> None:
        folded = self._guard("fold", self.display.fold, name, sample, self._folded)
        if folded is None or folded is CRASHED:
            return
        self._folded = folded
        self._history.add(replace(sample, message=folded), size, self._keep())

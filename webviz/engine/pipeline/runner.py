"""Runs one display: passes it messages, calls its hooks, draws the result."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from webviz.api.context import ColorScale
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
from webviz.engine.pipeline.history import Histories, History
from webviz.engine.pipeline.inputs import Inputs, Set
from webviz.engine.pipeline.intake import Arrival
from webviz.engine.pipeline.painter import Painter
from webviz.engine.sources import Offer, Raw, Subscription
from webviz.engine.trace import Tracer

NOTHING_TO_DRAW = Status(
    Level.WARN,
    "Nothing to draw: the data is empty or the properties hide it. Check both.",
)
NO_BROWSER = Status(Level.OK, "Nothing is drawn until a browser connects.")


@dataclass(frozen=True)
class Services:
    """Shared by all runners.

    Args:
        scene: where to draw.
        workers: for slow work.
        resolve: the full name of a topic; raises ValueError.
        strict: let exceptions of displays through, for tests.
        clock: monotonic time in seconds, for rates and ages.
        tracer: traces samples on request.
    """

    scene: Scene
    workers: Workers
    resolve: Callable[[str], str]
    strict: bool = False
    clock: Callable[[], float] = time.monotonic
    tracer: Tracer = field(default_factory=lambda: Tracer(time.monotonic))


class Runner:
    """One running display.

    Args:
        id: unique name in the scene.
        display: changed through `set` only.
        services: shared by all.
    """

    def __init__(self, id: str, display: Display, services: Services) -> None:
        self.id = id
        self.display = display
        self.remarks: dict[str, Status] = {}
        """Statuses from elsewhere, shown with those of the display."""
        self._services = services
        self._painter = Painter(id, services.scene, services.workers)
        self._guard = self._new_guard()
        self._inputs = self._new_inputs()
        self._histories = self._no_histories()
        self._newest: dict[str, Set] = {}
        self._ready_s: dict[str, float] = {}
        self._folded: Any = None
        self._fixed_frame = ""

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
            self._inputs = self._new_inputs()
        if not self.display.enabled:
            self.hide()
        self._painter.is_stale = True

    def replace(self, display: Display) -> None:
        """Continue as an instance of another class, keeping messages and what is drawn.

        Messages are discarded if the inputs of the new class differ or it folds them.
        """
        old, self.display = self.display, display
        self._guard = self._new_guard()
        if _sample_source(old) != _sample_source(display):
            self.reset()
            self._inputs = self._new_inputs()
        else:
            self._inputs.replace(display, self._guard)
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
        """Draw nothing until the next call of `draw`; messages are kept."""
        self._painter.hide()

    def subscriptions(self) -> dict[str, Subscription]:
        """The subscriptions by topic, none while the display is disabled."""
        if not self.display.enabled:
            return {}
        return self._inputs.subscriptions()

    def reset(self) -> None:
        """Discard all messages, such as after a jump of time."""
        self._inputs.reset()
        self._histories = self._no_histories()
        self._newest.clear()
        self._services.tracer.forget(self.id)
        self._folded = None
        self._painter.forget()

    def close(self) -> None:
        """Remove everything from the scene, and end the slow work."""
        self._painter.close()
        self._services.tracer.forget(self.id)

    # One turn

    def take(
        self, batches: Mapping[str, Iterable[Raw]], frames: Frames, offers: Mapping[str, Offer]
    ) -> None:
        """Take the messages of this turn; cheap, also called without browsers."""
        if self.display.enabled:
            self._guard("take", self._take, batches, frames, offers)

    def draw(self, frames: Frames) -> None:
        """Update the scene."""
        if self.display.enabled:
            self._guard("scene", self._draw, frames)

    def is_waiting(self) -> bool:
        """Whether the newest message of an input waits for its transform."""
        return self.display.enabled and self._inputs.is_waiting()

    def is_busy(self) -> bool:
        """Whether the result of slow work is not drawn yet."""
        return self.display.enabled and self._painter.is_busy()

    def followed(self) -> set[str]:
        """The frames whose poses `draw` needs."""
        return self._painter.followed() if self.display.enabled else set()

    def color_scale(self) -> ColorScale | None:
        """Which values colours stand for, None if nothing of them can be seen."""
        return None if self._painter.is_empty() else self._painter.color_scale()

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
        result = self._guard.attempt("statuses", {}, self._statuses, offers, frames, dropped)
        for text in self._guard.crashes.values():
            result["Display"] = Status(Level.ERROR, text)
        result |= self.remarks
        if worst(result.values()) is Level.OK and self._painter.is_empty():
            result["Display"] = NOTHING_TO_DRAW if is_watched else NO_BROWSER
        return result

    # Internal

    def _new_guard(self) -> Guard:
        who = type(self.display).__name__
        return Guard(who, self._services.strict, name=lambda: self.display.name)

    def _new_inputs(self) -> Inputs:
        return Inputs(self.display, self._guard, self._services.resolve)

    def _no_histories(self) -> Histories:
        names = list(self._inputs.intakes)
        if overrides(self.display, "fold"):
            names = names[:1]  # all inputs are folded into one sample
        return {name: History(len(names)) for name in names}

    def _take(
        self, batches: Mapping[str, Iterable[Raw]], frames: Frames, offers: Mapping[str, Offer]
    ) -> None:
        clock = self._services.clock()
        arrived = self._inputs.take(batches, frames, offers, clock)
        if not arrived:
            return
        display, keep = self.display, self._keep()
        every_one = overrides(display, "fold") or overrides(display, "accept") or keep != Keep()
        for found in arrived:
            name = next(iter(found))
            self._ready_s[name] = clock
            # The duration is known once a message is decoded; the next ones wait for that.
            is_unknown = (
                overrides(display, "duration_ns") and not self._inputs.intakes[name].duration_ns
            )
            if every_one or is_unknown:
                self._admit(found, keep, frames)
            else:
                self._newest[name] = found
        self._trim(keep, frames)  # also without browsers

    def _trim(self, keep: Keep, frames: Frames) -> None:
        for history in self._histories.values():
            history.trim(keep, frames.now_ns)

    def _draw(self, frames: Frames) -> None:
        keep = self._keep()
        newest, self._newest = self._newest, {}
        for found in newest.values():
            self._admit(found, keep, frames)
        if frames.fixed_frame != self._fixed_frame:
            if self._fixed_frame:
                for history in self._histories.values():
                    history.move(frames, self._fixed_frame, self._inputs.waits)
            self._fixed_frame = frames.fixed_frame
            self._painter.is_stale = True
        self._trim(keep, frames)
        self._painter.draw(self.display, self._guard, self._histories, frames)
        if self._services.tracer.wants(self.id):
            self._services.tracer.drawn(self.id)

    def _statuses(
        self, offers: Mapping[str, Offer], frames: Frames, dropped: Callable[[str], int]
    ) -> dict[str, Status]:
        result = self._inputs.statuses(offers, frames, dropped, self._services.clock())
        if lost := self._painter.lost(frames):
            result["Transform"] = Status(Level.ERROR, frames.why_not(lost[0]))
        for history in self._histories.values():
            if shortage := history.shortage(self._keep(), frames.now_ns):
                result["History"] = Status(Level.WARN, shortage)
        return result | self._painter.statuses()

    def _keep(self) -> Keep:
        keep = self._guard("history", self.display.history)
        return keep if isinstance(keep, Keep) else Keep()

    def _admit(self, found: Set, keep: Keep, frames: Frames) -> None:
        """Decode the messages of a set and hold it, if the display accepts it."""
        samples: dict[str, Sample] = {}
        for name, arrival in found.items():
            if (sample := self._sample(name, arrival, frames)) is None:
                return
            samples[name] = sample
        name, *others = samples
        sample = samples[name]
        if others:
            sample = replace(sample, synced={other: samples[other] for other in others})
        size = sum(len(arrival.raw.cdr) for arrival in found.values())
        tracer = self._services.tracer
        decoded_s = tracer.clock() if tracer.wants(self.id) else None
        is_held = self._hold(sample, size, keep)
        if is_held and decoded_s is not None:
            tracer.decoded(self.id, sample, found[name].raw, self._ready_s[name], decoded_s)

    def _hold(self, sample: Sample, size: int, keep: Keep) -> bool:
        """Fold a sample, or hold it if the display accepts it; whether the history changed."""
        if overrides(self.display, "fold"):
            return self._fold(sample, size, keep)
        history = self._histories[sample.input]
        verdict = self._guard("accept", self.display.accept, sample, history.samples())
        if isinstance(verdict, str):
            self._inputs.intakes[sample.input].refuse(verdict)
        elif verdict is True:
            history.add(sample, size, keep)
        return verdict is True

    def _sample(self, name: str, arrival: Arrival, frames: Frames) -> Sample | None:
        """A decoded message, None if it cannot be shown."""
        intake = self._inputs.intakes[name]
        if not arrival.frame:
            pose = Pose()
        elif self._inputs.waits(name):
            pose = frames.at(arrival.frame, arrival.stamp_ns)
        else:
            pose = frames.now(arrival.frame) or Pose()
        if pose is None:
            return None  # the buffer was cleared meanwhile
        raw = arrival.raw
        try:
            message = decode(intake.spec.type, raw.cdr)
        except MessageError as error:
            intake.refuse(str(error))
            return None
        intake.accepted()
        duration_ns = self._guard("duration", self.display.duration_ns, message)
        intake.measure(duration_ns if isinstance(duration_ns, int) else 0)
        return Sample(
            message, arrival.frame, arrival.stamp_ns, raw.received_ns, arrival.number, pose, name
        )

    def _fold(self, sample: Sample, size: int, keep: Keep) -> bool:
        folded = self._guard("fold", self.display.fold, sample.input, sample, self._folded)
        if folded is None or folded is CRASHED:
            return False
        self._folded = folded
        history = next(iter(self._histories.values()))
        history.add(replace(sample, message=folded), size, keep)
        return True


def _sample_source(display: Display) -> tuple[object, ...]:
    """Samples of one class serve another if this is equal."""
    return inputs(display), type(display).sync, overrides(display, "fold")

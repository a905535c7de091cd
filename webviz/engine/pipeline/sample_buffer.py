"""The messages of one display: received, decoded, and held as long as the display requests."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace

from webviz.api.capabilities import Selective, SelfPlacing, capability
from webviz.api.display import Display, Keep, overrides
from webviz.api.frames import Frames
from webviz.api.nodes import Pose
from webviz.api.observation import InputSeen
from webviz.api.sample import KeepsNewest, Sample
from webviz.api.status import Level, Status
from webviz.data.messages import MessageError, decode, is_message
from webviz.engine.error_boundary import ErrorBoundary
from webviz.engine.pipeline.folding import Folding, Received
from webviz.engine.pipeline.history import Histories, SampleHistory, held_samples
from webviz.engine.pipeline.input_subscription import Arrival
from webviz.engine.pipeline.inputs import Inputs, Set
from webviz.engine.pipeline.services import DisplayServices
from webviz.sources import Offer, Raw


class SampleBuffer:
    """Takes the messages of one display, decodes them and holds them.

    Args:
        id: of the display, for traces.
        display: has the topics, and decides what is held.
        boundary: around its hooks.
        services: shared by all.
    """

    def __init__(
        self, id: str, display: Display, boundary: ErrorBoundary, services: DisplayServices
    ) -> None:
        self.inputs = Inputs(display, boundary, services.resolve)
        self._id = id
        self._display = display
        self._selective = capability(display, Selective)
        self._placing = capability(display, SelfPlacing)
        self._placed_at: tuple[int, str] = -1, ""
        """Version of the transforms and fixed frame, when what is folded was placed."""
        self._boundary = boundary
        self._services = services
        self.histories = self._no_histories()
        self._newest: dict[str, Set] = {}
        self._ready_s: dict[str, float] = {}
        self._folding = self._new_folding()
        self._fixed_frame = ""

    def replace(self, display: Display, boundary: ErrorBoundary) -> None:
        """Continue with another instance that has the same inputs."""
        self._display = display
        self._selective = capability(display, Selective)
        self._placing = capability(display, SelfPlacing)
        self._boundary = boundary
        self.inputs.replace(display, boundary)

    def reset(self) -> None:
        """Discard all messages."""
        self.inputs.reset()
        self.histories = self._no_histories()
        self._newest.clear()
        self._folding = self._new_folding()

    def take(
        self, batches: Mapping[str, Iterable[Raw]], frames: Frames, offers: Mapping[str, Offer]
    ) -> None:
        """Take the messages of this turn; most are only decoded once they are drawn."""
        clock = self._services.clock()
        arrived = self.inputs.take(batches, frames, offers, clock)
        if arrived or self._folding.busy_with:
            self._hold(arrived, frames)
        self._place(frames, bool(arrived))

    def _hold(self, arrived: Iterable[Set], frames: Frames) -> None:
        """Hold the messages that arrived, or what is folded of them."""
        display, keep = self._display, self._keep()
        every_one = overrides(display, "fold") or self._selective or keep != Keep()
        for arrivals in arrived:
            name = next(iter(arrivals))
            self._ready_s[name] = self._services.tracer.clock()
            if every_one:
                self._admit(arrivals, keep, frames)
            else:
                self._newest[name] = arrivals
        for folded in self._folding.results(display, self._boundary):
            self._add(next(iter(self.histories.values())), folded, keep)
        self._trim(keep, frames)  # also without browsers

    def _place(self, frames: Frames, is_new: bool) -> None:
        """Let the display place what it has folded, if that or the transforms changed."""
        folded = self._folding.state
        if self._placing is None or folded is None:
            return
        if self._folding.busy_with and self._display.is_threaded:
            return  # a worker reads it
        now = frames.buffer.version, frames.fixed_frame
        if is_new or now != self._placed_at:
            self._placed_at = now
            self._boundary("place", self._placing.place, folded, frames)

    @property
    def busy_with(self) -> int:
        """Size of the message that is merged in a worker, in bytes; 0 if none is."""
        return self._folding.busy_with.size if self._folding.busy_with else 0

    @property
    def is_empty(self) -> bool:
        """Return whether no message is held."""
        return not any(history.entries for history in self.histories.values())

    def prepare(self, frames: Frames) -> bool:
        """Hold what is to be drawn now; whether all of it must be drawn anew."""
        keep = self._keep()
        newest, self._newest = self._newest, {}
        for arrivals in newest.values():
            self._admit(arrivals, keep, frames)
        before, self._fixed_frame = self._fixed_frame, frames.fixed_frame
        is_moved = before != frames.fixed_frame
        if is_moved and before:
            for history in self.histories.values():
                history.move(frames, before, self.inputs.waits)
        self._trim(keep, frames)
        return is_moved

    def observed(self) -> tuple[InputSeen, ...]:
        """Return the inputs that the display listens to, as the checks of the doctor see them."""
        newest: dict[str, Sample] = {}
        folds = overrides(self._display, "fold")  # so that a sample need not be a message
        for each in held_samples(self.histories):
            if sample := _received(each) if folds else each:
                newest |= {sample.input: sample, **sample.synced}
        return tuple(
            input_subscription.observed(newest.get(name))
            for name, input_subscription in self.inputs.active().items()
        )

    def statuses(
        self, offers: Mapping[str, Offer], frames: Frames, dropped: Callable[[str], int]
    ) -> dict[str, Status]:
        """Statuses of topics, messages, transforms, stamps and history."""
        waited_in_vain = self._folding.dropped

        def all_dropped(topic: str) -> int:
            names = [
                name
                for name in waited_in_vain
                if self.inputs.input_subscriptions[name].name == topic
            ]
            return dropped(topic) + sum(waited_in_vain[name] for name in names)

        result = self.inputs.statuses(offers, frames, all_dropped, self._services.clock())
        for history in self.histories.values():
            if shortage := history.shortage(self._keep(), frames.now_ns):
                result["History"] = Status(Level.WARN, shortage)
        return result

    def _no_histories(self) -> Histories:
        names = list(self.inputs.input_subscriptions)
        if overrides(self._display, "fold"):
            names = names[:1]  # all inputs are folded into one sample
        return {name: SampleHistory(self._services.histories, len(names)) for name in names}

    def _new_folding(self) -> Folding:
        return Folding(self._services.workers, self._judge)

    def _judge(self, name: str, refusal: str) -> None:
        """Note whether a message could be read."""
        input_subscription = self.inputs.input_subscriptions[name]
        input_subscription.refuse(refusal) if refusal else input_subscription.accepted()

    def _keep(self) -> Keep:
        keep = self._boundary("history", self._display.history)
        return keep if isinstance(keep, Keep) else Keep()

    def _trim(self, keep: Keep, frames: Frames) -> None:
        for history in self.histories.values():
            history.trim(keep, frames.now_ns)

    def _admit(self, arrivals: Set, keep: Keep, frames: Frames) -> None:
        """Decode the messages of a set and hold it, if the display accepts it.

        One that is folded is decoded there, in a worker if it is large.
        """
        samples: dict[str, Sample] = {}
        is_folded = overrides(self._display, "fold")
        for name, arrival in arrivals.items():
            is_decoded_later = is_folded and len(arrivals) == 1
            if (sample := self._sample(name, arrival, frames, is_decoded_later)) is None:
                return
            samples[name] = sample
        name, *others = samples
        sample = samples[name]
        if others:
            sample = replace(sample, synced={other: samples[other] for other in others})
        size = sum(len(arrival.raw.cdr) for arrival in arrivals.values())
        decoded_s = self._services.tracer.clock()
        received = Received(sample, size, arrivals[name].raw, self._ready_s[name], decoded_s)
        if is_folded:
            self._folding.put(received)
            return
        history = self.histories[name]
        verdict: object = True
        if self._selective:
            verdict = self._boundary("accept", self._selective.accept, sample, history.samples())
        if isinstance(verdict, str):
            self.inputs.input_subscriptions[name].refuse(verdict)
        elif verdict is True:
            self._add(history, received, keep)

    def _add(self, history: SampleHistory, received: Received, keep: Keep) -> None:
        """Hold a sample."""
        history.add(received.sample, received.size, keep)
        if self._services.tracer.wants(self._id):
            self._services.tracer.decoded(
                self._id, received.sample, received.raw, received.ready_s, received.decoded_s
            )

    def _sample(
        self, name: str, arrival: Arrival, frames: Frames, is_decoded_later: bool
    ) -> Sample | None:
        """Return a message with its pose, None if it cannot be shown."""
        input_subscription = self.inputs.input_subscriptions[name]
        if not arrival.frame:
            pose = Pose()
        elif self.inputs.waits(name):
            pose = frames.at(arrival.frame, arrival.stamp_ns)
        else:
            pose = frames.now(arrival.frame) or Pose()
        if pose is None:
            return None  # the buffer was cleared meanwhile
        raw, message = arrival.raw, arrival.message
        try:
            if message is None and not is_decoded_later:
                message = decode(input_subscription.type, raw.cdr, raw.types)
        except MessageError as error:
            input_subscription.refuse(str(error))
            return None
        input_subscription.accepted()
        return Sample(
            message,
            arrival.frame,
            arrival.stamp_ns,
            raw.received_ns,
            arrival.number,
            pose,
            name,
            type=input_subscription.type,
        )


def _received(sample: Sample) -> Sample | None:
    """Return the sample of a message that a fold has kept as it came, None if it has not."""
    newest = sample.message.newest if isinstance(sample.message, KeepsNewest) else sample
    if not isinstance(newest, Sample) or not newest.type:
        return None
    return newest if is_message(newest.message, newest.type) else None

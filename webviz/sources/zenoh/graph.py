"""Output over Zenoh: publishing, service calls and goals."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from concurrent.futures import Future
from typing import Protocol

from webviz.sources.goals import Goals
from webviz.sources.graph import Advertisement, Goal
from webviz.sources.zenoh.calls import ZenohCalls
from webviz.sources.zenoh.discovered import GraphSnapshot
from webviz.sources.zenoh.link import ZenohLink


class Speaker(Protocol):
    """The part of the source that the graph uses, in the thread of the link."""

    @property
    def link(self) -> ZenohLink:
        """The session."""
        ...

    @property
    def snapshot(self) -> GraphSnapshot:
        """The newest graph; from any thread."""
        ...

    @property
    def calls(self) -> ZenohCalls:
        """The pending calls."""
        ...

    def advertise(self, advertisements: Collection[Advertisement]) -> None:
        """Make the advertised publishers exactly these; anew in each session."""
        ...

    def publish(self, advertisement: Advertisement, cdr: bytes) -> int:
        """Publish a message; the number of matched subscriptions; raises NotConnected."""
        ...

    def listen(self, topic: str, type: str, arrive: Callable[[bytes], None]) -> Callable[[], bool]:
        """See `webviz.sources.goals.ListenToFeedback`."""
        ...


class ZenohGraph:
    """Publishes, calls services and sends goals over Zenoh; see `webviz.sources.Graph`.

    Args:
        speaker: the source.
    """

    def __init__(self, speaker: Speaker) -> None:
        self._speaker = speaker
        self._goals = Goals(self.call, speaker.calls.send, speaker.listen)

    def advertise(self, advertisements: Collection[Advertisement]) -> Future[None]:
        """Make the advertised publishers exactly these; anew after the link was broken."""
        frozen = frozenset(advertisements)
        return self._speaker.link.do(lambda: self._speaker.advertise(frozen))

    def publish(self, advertisement: Advertisement, cdr: bytes) -> Future[int]:
        """Publish a message unless it would be late; the number of matched subscriptions."""
        return self._speaker.link.do(lambda: self._speaker.publish(advertisement, cdr))

    def call(self, service: str, type: str, request: bytes, timeout_s: float) -> Future[bytes]:
        """Call a service; the serialised response."""
        answer: Future[bytes] = Future()
        send = self._speaker.calls.send
        self._start(answer, lambda: send(service, type, request, timeout_s, answer))
        return answer

    def send_goal(
        self, action: str, type: str, goal: bytes, feedback: Callable[[bytes], object]
    ) -> Goal:
        """Send a goal to an action."""
        goal_handle = self._goals.new(action)
        self._start(
            goal_handle.accepted,
            lambda: self._goals.send(action, type, goal, goal_handle, feedback),
        )
        return goal_handle

    def nodes(self) -> tuple[str, ...]:
        """Full names of the nodes of the graph, sorted."""
        return self._speaker.snapshot.nodes

    def services(self) -> Mapping[str, str]:
        """Types of the services of the graph by name, without those that actions consist of."""
        return self._speaker.snapshot.services

    def _start(self, answer: Future, do: Callable[[], None]) -> None:
        """Call `do` in the thread of the link, and pass its error to the answer."""

        def pass_on(started: Future[None]) -> None:
            if (error := started.exception()) and not answer.done():
                answer.set_exception(error)

        def start() -> None:
            self._speaker.link.session  # noqa: B018 - raises NotConnected
            self._speaker.link.require_fresh()
            do()

        self._speaker.link.do(start).add_done_callback(pass_on)

"""One connection to rosbridge, with rosapi beside it."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from concurrent.futures import Future
from typing import Any

from webviz.api.bridge import BridgeParameters
from webviz.api.errors import Error
from webviz.api.offer import Publisher
from webviz.data.messages import Clock, MessageError, decode
from webviz.data.words import plain
from webviz.sources.bridge import rosbridge_wire as wire
from webviz.sources.bridge.rosapi import Rosapi
from webviz.sources.bridge.rosbridge_values import from_values, to_values
from webviz.sources.bridge.session import (
    CarriedTopic,
    Host,
    WireError,
    fail,
    succeed,
    usual_durability,
)
from webviz.sources.graph import UNKNOWN, Advertisement, Missing, NotConnected
from webviz.sources.source import Subscription

MAX_PENDING = 1000
"""Calls whose answers are outstanding."""
MAX_STATUSES = 8
"""Warnings of the bridge that are kept, the newest."""
CLOCK = "/clock"
CLOCK_TYPE = "rosgraph_msgs/msg/Clock"
AWAKE_MS, RESTING_MS = 20, 3_600_000
"""Least time between two messages of a topic that takes turns. At rest it stays subscribed to, so
that a message comes as soon as its turn comes; without the first, rosbridge would send that twice,
as it subscribes anew for each change."""
NO_ASSETS = (
    "rosbridge sends no files. Install the package with the meshes on this machine, or use "
    "foxglove_bridge."
)
LIMITS = (
    "rosbridge does not report the QoS of publishers; it subscribes with a matching one.",
    "rosbridge does not report which nodes publish a topic, or whether any does.",
    "Messages above its max_message_size, 10 MB unless set, do not arrive.",
    "A topic that another client of rosbridge reads as JSON does not arrive.",
    "While a service takes its time, rosbridge publishes nothing; its parameter "
    "call_services_in_new_thread changes that.",
    "Goals for actions and files do not pass it.",
)


class RosbridgeSession:
    """Topics and services of rosbridge; see `BridgeSession`.

    Args:
        host: of the connection.
        api: what the first connection knows, None for the first.
    """

    protocol = "rosbridge"

    def __init__(self, host: Host, api: Rosapi | None = None) -> None:
        self._host = host
        self._is_first = api is None
        self._api = api or Rosapi(self._ask, self._take_changes)
        self._subscriptions: Mapping[str, Subscription] = {}
        self._resting: Collection[str] = ()
        self._lines: dict[str, tuple[str, int]] = {}
        """Types, and `resubscriptions` of the subscription, by subscribed topic."""
        self._throttles: dict[str, int] = {}
        """Least time between two messages in ms, by subscribed topic."""
        self._advertised: set[Advertisement] = set()
        self._calls: dict[str, Callable[[wire.RosbridgeResponse], object]] = {}
        """Calls of rosapi by their id."""
        self._pending: dict[str, tuple[Future[bytes], str, str]] = {}
        """Answers by the id of their call, the service, and the type of the response."""
        self._fragments = wire.Fragments()
        self._statuses: dict[str, None] = {}
        self._next_id = 1

    # For the source

    @property
    def topics(self) -> Mapping[str, CarriedTopic]:
        """All topics, by name."""
        return {topic: self._carried(topic, type) for topic, type in self._api.types.items()}

    @property
    def nodes(self) -> tuple[str, ...]:
        """Full names of the nodes, sorted."""
        return self._api.nodes

    @property
    def parameters(self) -> BridgeParameters:
        """The nodes with services for parameters."""
        return BridgeParameters(self._api.with_parameters)

    @property
    def remarks(self) -> Sequence[str]:
        """Sentences: lacks of the bridge and of rosapi, and warnings of the bridge."""
        missing = [] if wire.is_readable() else [f"{wire.MISSING}."]
        return [*missing, *self._api.remarks(), *self._statuses]

    @property
    def limits(self) -> Sequence[str]:
        """Limits of rosbridge."""
        return LIMITS

    def start(self) -> None:
        """Ask for the topics, and again and again; on the first connection."""
        if self._is_first:
            self._api.start()

    def beside(self, host: Host) -> RosbridgeSession:
        """Return a session for a second connection, for large topics."""
        return RosbridgeSession(host, self._api)

    def receive(self, frame: str | bytes) -> None:
        """Take a frame; raises WireError."""
        if isinstance(frame, bytes):
            if wire.is_readable():
                self._take_message(wire.read_binary(frame))
            return
        message = wire.read_text(frame)
        if isinstance(message, wire.Fragment):
            whole = self._fragments.add(message)
            message = None if whole is None else wire.read_text(whole)
        match message:
            case wire.RosbridgeResponse():
                self._take_response(message)
            case wire.RosbridgeStatus():
                self._note(message)
            case _:
                return

    def want(
        self, subscriptions: Mapping[str, Subscription], resting: Collection[str] = frozenset()
    ) -> None:
        """Make the subscriptions exactly these, as far as they are offered."""
        self._subscriptions, self._resting = subscriptions, resting
        targets = {
            topic: (subscription.type, subscription.resubscriptions)
            for topic, subscription in subscriptions.items()
        }
        if self._is_first and self._api.types.get(CLOCK) == CLOCK_TYPE:
            targets.setdefault(CLOCK, (CLOCK_TYPE, 0))
        lines = {topic: line for topic, line in targets.items() if self._can_read(topic, line[0])}
        for topic, line in list(self._lines.items()):
            if lines.get(topic) != line:
                self._host.send(wire.unsubscribe(topic))
                del self._lines[topic]
                self._throttles.pop(topic, None)
        for topic, line in lines.items():
            self._subscribe(topic, line)

    def _subscribe(self, topic: str, line: tuple[str, int]) -> None:
        """Subscribe to a topic, or change how often its messages come."""
        is_resting = topic in self._resting
        if is_resting and topic not in self._lines:
            return  # the first message would come at once
        former = self._throttles.get(topic)
        throttle = RESTING_MS if is_resting else AWAKE_MS if former else 0
        if throttle != former:
            self._host.send(wire.subscribe(topic, line[0], throttle))
            self._lines[topic], self._throttles[topic] = line, throttle

    def advertise(self, advertisements: Collection[Advertisement]) -> None:
        """Make the advertised publishers exactly these."""
        for each in self._advertised - set(advertisements):
            self._host.send(wire.unadvertise(each.topic))
            self._advertised.discard(each)
        for each in advertisements:
            self._advertise(each)

    def publish(self, advertisement: Advertisement, cdr: bytes) -> int:
        """Publish a message; raises NotConnected."""
        values = _values(advertisement.type, cdr)
        self._advertise(advertisement)
        self._host.send(
            wire.publish(advertisement.topic, values, **_publishing(advertisement)),
        )
        return UNKNOWN

    def call(self, service: str, type: str, request: bytes, answer: Future[bytes]) -> None:
        """Call a service; raises NotConnected."""
        if len(self._pending) >= MAX_PENDING:
            raise NotConnected(f"The bridge owes {MAX_PENDING} answers. Try again later.")
        values = _values(f"{type}_Request", request)
        id = self._new_id()
        self._pending[id] = answer, service, f"{type}_Response"
        self._host.send(wire.call(id, service, values))

    def forget(self, answer: Future[bytes]) -> None:
        """Expect the response of a call no longer."""
        self._pending = {id: each for id, each in self._pending.items() if each[0] is not answer}

    def fetch(self, uri: str, answer: Future[bytes]) -> None:
        """Refuse: it sends no files."""
        raise NotConnected(NO_ASSETS)

    def close(self, problem: str) -> None:
        """Fail everything that is pending."""
        if self._is_first:
            self._api.close()
        for answer, _, _ in self._pending.values():
            fail(answer, problem)
        self._pending.clear()
        self._calls.clear()

    # Frames

    def _take_message(self, message: wire.RosbridgeMessage) -> None:
        # Messages on their way when a subscription ended are ignored.
        if message.topic not in self._lines:
            return
        if message.topic == CLOCK and self._lines[CLOCK][0] == CLOCK_TYPE:
            self._take_clock(message.cdr)
        if message.topic in self._subscriptions:
            self._host.arrive(message.topic, message.cdr, message.stamp_ns)

    def _take_clock(self, cdr: bytes) -> None:
        try:
            clock: Clock = decode(CLOCK_TYPE, cdr)
        except MessageError as error:
            raise WireError(str(error).rstrip(".")) from error
        self._host.set_time(clock.clock.ns)

    def _take_response(self, response: wire.RosbridgeResponse) -> None:
        if take := self._calls.pop(response.id, None):
            take(response)
            return
        answer, service, type = self._pending.pop(response.id, (None, "", ""))
        if answer is None:
            return
        if not response.result:
            reason = plain(str(response.values), 300) or "the bridge gives no reason"
            missing = Missing(f"The bridge finds no service {service}.")
            is_missing = reason.endswith("does not exist")
            fail(answer, missing if is_missing else f"The call has failed: {reason}")
            return
        try:
            succeed(answer, from_values(type, response.values or {}))
        except Error as error:
            fail(answer, f"The response cannot be read: {error}")

    def _note(self, status: wire.RosbridgeStatus) -> None:
        if status.level in ("error", "warning"):
            text = f"The bridge reports: {plain(status.msg, 300)}"
            self._statuses.pop(text, None)
            self._statuses[text] = None
            while len(self._statuses) > MAX_STATUSES:
                del self._statuses[next(iter(self._statuses))]
            self._host.look()

    # Topics

    def _take_changes(self) -> None:
        """Subscribe to what rosapi lists now."""
        self.want(self._subscriptions, self._resting)
        self._host.look()

    def _ask(
        self,
        service: str,
        values: Mapping[str, Any],
        take: Callable[[wire.RosbridgeResponse], object],
    ) -> None:
        id = self._new_id()
        self._calls[id] = take
        self._host.send(wire.call(id, service, values))

    def _can_read(self, topic: str, type: str) -> bool:
        """Return whether a topic is offered with this type, whose definition is known."""
        texts = self._api.texts
        if self._api.types.get(topic) != type or type not in texts or not wire.is_readable():
            return False
        if topic in self._lines and self._lines[topic][0] == type:
            return True
        return not self._host.learn(topic, type, texts[type])

    def _carried(self, topic: str, type: str) -> CarriedTopic:
        durability = usual_durability(topic, type)
        publisher = Publisher("", type, "reliable", durability, is_qos_known=False)
        return CarriedTopic((publisher,), "" if wire.is_readable() else wire.MISSING)

    def _advertise(self, advertisement: Advertisement) -> None:
        if advertisement not in self._advertised:
            self._advertised.add(advertisement)
            self._host.send(
                wire.advertise(
                    advertisement.topic, advertisement.type, **_publishing(advertisement)
                )
            )

    def _new_id(self) -> str:
        self._next_id += 1
        return f"webviz:{self._next_id}"


def _publishing(advertisement: Advertisement) -> dict[str, Any]:
    """Return the QoS, as far as rosbridge takes it."""
    is_latched = advertisement.durability == "transient_local"
    return {"is_latched": is_latched, "depth": advertisement.depth}


def _values(type: str, cdr: bytes) -> dict[str, Any]:
    try:
        return to_values(type, cdr)
    except MessageError as error:
        raise NotConnected(
            f"rosbridge needs messages as JSON, but this one cannot be converted: {error}"
        ) from error

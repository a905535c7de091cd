"""Live topics over Zenoh as a source."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from typing import Any

from webviz.api.bridge import Bridge
from webviz.api.declared import Topic
from webviz.api.offer import Offer
from webviz.data.messages import MessageError, decode
from webviz.data.words import Problem
from webviz.sources.bridge.clock import BridgeClock
from webviz.sources.bridge.definitions import Definitions
from webviz.sources.graph import Advertisement, NotConnected
from webviz.sources.inbox import MAX_TOTAL, Inbox, Raw
from webviz.sources.names import resolved
from webviz.sources.source import Subscription
from webviz.sources.zenoh.address import ZenohAddress
from webviz.sources.zenoh.attachment import Attachment, gid_of, read_attachment, write_attachment
from webviz.sources.zenoh.calls import ZenohCalls
from webviz.sources.zenoh.describing import limits, remarks
from webviz.sources.zenoh.descriptions import UNDEFINED, TypeDescriptions
from webviz.sources.zenoh.discovered import DiscoveredGraph, GraphSnapshot
from webviz.sources.zenoh.endpoints import OwnNode
from webviz.sources.zenoh.engine import directly, engine
from webviz.sources.zenoh.graph import ZenohGraph
from webviz.sources.zenoh.link import NEVER, STALLED_S, ZenohLink
from webviz.sources.zenoh.publishers import ZenohPublishers
from webviz.sources.zenoh.subscriptions import (
    ZenohSubscriptions,
    requested_durability,
    requested_reliability,
)
from webviz.sources.zenoh.survey import DomainSurvey
from webviz.sources.zenoh.tokens import BRIDGED_PATTERN, graph_pattern

INBOX_LIMIT = 1000
TF_LIMIT = 20_000
"""Every transform counts: room for the 10 s that the buffer keeps, at 2 kHz."""
TF_TYPE = "tf2_msgs/msg/TFMessage"
CLOCK, CLOCK_TYPE = "/clock", "rosgraph_msgs/msg/Clock"
MAX_FEEDBACK = 100
"""Actions whose feedback is received."""
SETTLE_S = 1.0
"""Time for the tokens to come again over a link that is back."""
LOOK_S = 0.1
"""Pause in seconds between two readings of the graph, which may change for each of many tokens."""


class ZenohSource:
    """Messages over Zenoh, as raw bytes in an inbox.

    The engine calls back in threads of its own, where each payload is copied once; one thread has
    the session. The methods are thread-safe.

    Args:
        address: of the routers or robots.
        remappings: of full topic names.
        inbox: for the messages.
    """

    def __init__(
        self,
        address: ZenohAddress,
        remappings: Mapping[str, str] | None = None,
        inbox: Inbox | None = None,
    ) -> None:
        self.inbox = Inbox() if inbox is None else inbox
        self.clock = BridgeClock()
        self._clock_lock = threading.Lock()
        self._address = address
        self._remappings = dict(remappings or {})
        self._graph = DiscoveredGraph()
        self.snapshot = GraphSnapshot()
        """The newest graph."""
        self._problem: Problem | None = NEVER
        """The problem of the link that the offers state."""
        self._definitions = Definitions(UNDEFINED)
        self._topics: Mapping[str, Subscription] = {}
        self._opened: dict[str, str] = {}
        """Types by topic, of the topics that are open in the inbox."""
        self._is_wish_new = False
        self._next_look_s = self._settled_s = 0.0
        self._offers: Mapping[str, Offer] = {}
        self._bridges = (Bridge(address.name, problem=NEVER.cause, remedy=NEVER.remedy),)
        self._too_large: dict[str, str] = {}
        self._clock_ns: int | None = None
        self._clock_messages = 0
        self._advertised: Collection[Advertisement] = ()
        self._subscriptions: ZenohSubscriptions | None = None
        self._publishers: ZenohPublishers | None = None
        self._feedback: dict[str, tuple[str, Callable[[bytes], None]]] = {}
        """Types and functions by the topics of feedback."""
        self._requests = 0
        self.calls = ZenohCalls(lambda: self.snapshot, self._request_attachment)
        self._descriptions = TypeDescriptions(self.calls, self._learn)
        self._survey = DomainSurvey(address.domain)
        self._listening: list[Any] = []
        """Subscriptions to tokens, which end with what refers to them."""
        self.link = ZenohLink(address, self)
        self.graph = ZenohGraph(self)
        self.link.start()

    # The interface of webviz.sources.Source

    def want(self, subscriptions: Mapping[str, Subscription]) -> None:
        """Replace all subscriptions; takes effect soon."""
        if subscriptions != self._topics:
            self._topics = dict(subscriptions)
            self._is_wish_new = True
            self.link.wake()

    def offers(self) -> Mapping[str, Offer]:
        """All topics of the graph; while the link is broken, those of before."""
        return self._offers

    @property
    def bridges(self) -> Sequence[Bridge]:
        """The link to the router."""
        return self._bridges

    def now_ns(self) -> int:
        """ROS time: that of /clock if it is published, else of this machine."""
        return time.time_ns() if self._clock_ns is None else self._clock_ns

    def clock_messages(self) -> int | None:
        """Return the number of /clock messages; None while time is wall time."""
        return None if self._clock_ns is None else self._clock_messages

    def resolve(self, topic: str) -> str:
        """Return the full name of a topic, remapped; raises ValueError."""
        return resolved(topic, self._remappings)

    def stop(self) -> None:
        """Begin to close the session."""
        self.link.stop()

    def close(self) -> None:
        """Close the session and end the thread."""
        self.link.close()

    # The interface of webviz.sources.zenoh.link.LinkUser, in the thread of the link

    def joined(self, session: Any) -> None:
        """Begin a session with what the last one had."""
        self._graph.clear()
        self.clock.start()
        node = OwnNode(session, self._address.domain)
        domain = self._address.domain
        self._subscriptions = ZenohSubscriptions(session, node, domain, self._arrive)
        self._publishers = ZenohPublishers(session, node, domain)
        listen = session.liveliness().declare_subscriber
        self._listening = [
            listen(pattern, directly(self._token), history=True)
            for pattern in (graph_pattern(domain), BRIDGED_PATTERN)
        ]
        self._survey = DomainSurvey(domain)
        self._is_wish_new = True

    def turn(self) -> None:
        """Follow the graph and the subscriptions, and advance pending calls."""
        now_s = time.monotonic()
        if self._is_wish_new or now_s >= self._next_look_s:
            self._next_look_s = now_s + LOOK_S
            self._look()
        try:
            session = self.link.session
        except NotConnected:
            session = None
        else:
            self._survey.turn(session, self.snapshot.is_empty)
        self.calls.turn(session)

    def on_disconnect(self, problem: str) -> None:
        """Fail what is pending."""
        self.calls.close(problem)

    # The interface of webviz.sources.zenoh.graph.Speaker, in the thread of the link

    def advertise(self, advertisements: Collection[Advertisement]) -> None:
        """Make the advertised publishers exactly these; anew in each session."""
        self._advertised = advertisements
        if self._publishers is not None:
            self._publishers.advertise(advertisements, self.snapshot)

    def publish(self, advertisement: Advertisement, cdr: bytes) -> int:
        """Publish a message; the number of matched subscriptions; raises NotConnected."""
        self.link.session  # noqa: B018 - raises NotConnected
        self.link.require_fresh()
        assert self._publishers is not None
        return self._publishers.publish(advertisement, cdr, self.snapshot)

    def listen(self, topic: str, type: str, arrive: Callable[[bytes], None]) -> Callable[[], bool]:
        """See `webviz.sources.goals.ListenToFeedback`."""
        if topic not in self._feedback and len(self._feedback) >= MAX_FEEDBACK:
            del self._feedback[next(iter(self._feedback))]
        self._feedback[topic] = type, arrive
        self._is_wish_new = True
        action = topic.partition("/_action/")[0]
        return lambda: topic in self.snapshot.publishers or action in self.snapshot.actions

    # In threads of the engine

    def _token(self, sample: Any) -> None:
        token = str(sample.key_expr)
        if sample.kind == engine().SampleKind.DELETE:
            self._graph.remove(token)
        else:
            self._graph.add(token)

    def _arrive(self, topic: str, sample: Any, is_old: bool) -> None:
        """Take a message."""
        payload = sample.payload
        if len(payload) > MAX_TOTAL:
            self._too_large[topic] = (
                f"a message of {len(payload) >> 20} MB is above the limit of {MAX_TOTAL >> 20} MB; "
                "publish smaller ones"
            )
            self._is_wish_new = True
            return
        cdr = payload.to_bytes()
        feedback = self._feedback.get(topic)
        if feedback is not None:
            feedback[1](cdr)
        if topic == CLOCK:
            self._set_time(cdr)
        if not is_old and sample.attachment is not None and self._clock_ns is None:
            sender = read_attachment(sample.attachment.to_bytes())
            if sender is not None:
                with self._clock_lock:
                    self.clock.note(sender.stamp_ns, time.time_ns())
        if topic in self._opened:
            cdr, types = self._definitions.read(topic, cdr)
            self.inbox.put(topic, Raw(cdr, self.now_ns(), types=types))

    def _set_time(self, cdr: bytes) -> None:
        try:
            stamp = decode(CLOCK_TYPE, cdr).clock
        except MessageError:
            return
        self._clock_ns = stamp.sec * 10**9 + stamp.nanosec
        self._clock_messages += 1
        self.inbox.arrived.set()

    # The graph

    def _request_attachment(self) -> bytes:
        """Return the attachment of the next request."""
        self._requests += 1
        gid = gid_of(f"{id(self)}/{self._address.name}")
        return write_attachment(Attachment(self._requests, time.time_ns(), gid))

    def _look(self) -> None:
        """Read the graph, subscribe, and describe what there is."""
        is_new, self._is_wish_new = self._is_wish_new, False
        problem, now_s = self.link.problem, time.monotonic()
        if problem is not None and self._bridges[0].was_up:
            self._settled_s = now_s + SETTLE_S
        # While the link is broken, what was known holds; and then until the tokens are there again.
        is_settled = problem is None and now_s >= self._settled_s
        snapshot = self._graph.snapshot() if is_settled else None
        if snapshot is not None:
            self.snapshot = snapshot
        if is_new:
            self._open_topics()
        is_new = is_new or snapshot is not None
        if is_new and problem is None and self._subscriptions is not None:
            self._descriptions.ask(self._opened, self.snapshot)
            self._subscriptions.want(self._all_wishes(), self.snapshot)
            self.advertise(self._advertised)
            if CLOCK not in self.snapshot.topics:
                self._clock_ns = None
        if is_new or problem is not self._problem:
            self._problem = problem
            offers = {topic: self._offer(topic) for topic in self.snapshot.topics}
            if offers != self._offers:
                self._offers = offers
                self.inbox.arrived.set()
        self._describe()

    def _open_topics(self) -> None:
        """Open the subscribed topics in the inbox."""
        types = {topic: subscription.type for topic, subscription in self._topics.items()}
        for topic in [t for t in self._opened if t not in types]:
            del self._opened[topic]
            self._definitions.forget(topic)
            self._too_large.pop(topic, None)
            self.inbox.close(topic)
        for topic, type in types.items():
            if self._opened.get(topic) != type:
                self._definitions.learn(topic, type, "")
                self.inbox.open(topic, TF_LIMIT if type == TF_TYPE else INBOX_LIMIT)
                self._opened[topic] = type

    def _learn(self, topic: str, type: str, text: str) -> None:
        """Read a topic by the definition that its publisher has."""
        if self._opened.get(topic) == type:
            self._definitions.learn(topic, type, text)
            self._is_wish_new = True

    def _all_wishes(self) -> Mapping[str, Subscription]:
        """Return the subscriptions, also those of feedback and of simulated time."""
        own = {topic: type for topic, (type, _) in self._feedback.items()}
        own[CLOCK] = CLOCK_TYPE
        return {t: Subscription(type, Topic(t)) for t, type in own.items()} | dict(self._topics)

    def _offer(self, topic: str) -> Offer:
        carried = self.snapshot.topics[topic]
        subscription = self._topics.get(topic)
        problem = self._too_large.get(topic) or self._definitions.problem(topic)
        if subscription is not None and self.link.problem is not None:
            problem = f"the link is broken. {self.link.problem.cause}"
        offer = carried.offer(subscription, problem)
        if offer.requested is None or subscription is None:
            return offer
        of_type = [
            p for p in self.snapshot.publishers.get(topic, ()) if p.type == subscription.type
        ]
        return replace(
            offer,
            requested=(
                requested_reliability(subscription),
                requested_durability(subscription, of_type),
            ),
        )

    def _describe(self) -> None:
        """Describe the link as it is now."""
        before, problem = self._bridges[0], self.link.problem
        is_up = problem is None
        link = replace(
            before,
            protocol="Zenoh",
            is_up=is_up,
            was_up=before.was_up or is_up,
            problem="" if problem is None else problem.cause,
            remedy="" if problem is None else problem.remedy,
            remarks=self._remarks() if is_up else (),
            limits=limits(self.snapshot),
            round_trip_s=self.link.round_trip_s if is_up else None,
        )
        if link != before:
            self._bridges = (link,)
            self.inbox.arrived.set()

    def _remarks(self) -> tuple[str, ...]:
        silent_s = self.link.silent_s
        silent_s = silent_s if silent_s > STALLED_S else 0.0
        return remarks(self.snapshot, silent_s, self._survey.remark, self._opened)

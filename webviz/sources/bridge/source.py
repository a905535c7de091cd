"""Live topics through a bridge as a source."""

from __future__ import annotations

import asyncio
import logging
import random
import threading
import time
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractAsyncContextManager

from webviz.api.bridge import Bridge
from webviz.api.offer import Offer
from webviz.data import assets
from webviz.data.words import Problem
from webviz.sources.bridge.address import Address
from webviz.sources.bridge.bulk import BulkConnection, BulkTopics
from webviz.sources.bridge.clock import BridgeClock
from webviz.sources.bridge.connection import BridgeConnection, Silent
from webviz.sources.bridge.definitions import Definitions
from webviz.sources.bridge.graph import BridgeGraph
from webviz.sources.bridge.health import LinkHealth, described, thinning
from webviz.sources.bridge.pacing import TF_TYPE, RateController
from webviz.sources.bridge.refusals import explain
from webviz.sources.bridge.session import BridgeSession, CarriedTopic
from webviz.sources.bridge.talking import first_of, open_session, opened, read, write
from webviz.sources.graph import NotConnected
from webviz.sources.inbox import MAX_TOTAL, Inbox, Raw
from webviz.sources.names import resolved
from webviz.sources.source import Subscription

log = logging.getLogger("webviz")

PING_S = 0.4
BROKEN_S = 10.0
"""Time in seconds without any byte, after which the connection is opened anew."""
FIRST_RETRY_S = 0.5
LAST_RETRY_S = 10.0
LOOK_S = 0.1
"""Pause in seconds between two readings of what a bridge offers, which may change for each of many
topics."""
REMARK_S = 1.0
INBOX_LIMIT = 1000
TF_LIMIT = 20_000
"""Every transform counts: room for the 10 s that the buffer keeps, at 2 kHz."""
NEVER = Problem("The bridge is not connected yet.", "Wait a moment.")


class BridgeSource:
    """Messages through a bridge, as raw bytes in an inbox.

    One thread has the connection, and opens it anew whenever it breaks. Subscriptions and
    advertised topics are made again then; until then, topics stay known. The methods are
    thread-safe.

    Args:
        address: of the bridge.
        remappings: of full topic names.
        inbox: for the messages.
    """

    def __init__(
        self,
        address: Address,
        remappings: Mapping[str, str] | None = None,
        inbox: Inbox | None = None,
    ) -> None:
        self.inbox = Inbox() if inbox is None else inbox
        self.clock = BridgeClock()
        self.graph = BridgeGraph(self)
        self._address = address
        self._remappings = dict(remappings or {})
        self._definitions = Definitions()
        self._subscriptions: Mapping[str, Subscription] = {}
        self._opened: dict[str, str] = {}
        """Types by topic, of the topics that are open in the inbox."""
        self._topics: Mapping[str, CarriedTopic] = {}
        self._nodes: tuple[str, ...] = ()
        self._offers: Mapping[str, Offer] = {}
        self._bridges = (Bridge(address.name, problem=NEVER.cause, remedy=NEVER.remedy),)
        self._session: BridgeSession | None = None
        self._socket: BridgeConnection | None = None
        self._rate_controller = RateController()
        self._bulk: BulkTopics | None = None
        self._problem: Problem | None = NEVER
        self._clock_ns: int | None = None
        self._clock_messages = 0
        self._round_trip_s: float | None = None
        self._health = LinkHealth()
        self._too_large: dict[str, str] = {}
        self._is_look_due = False
        self._outbox: asyncio.Queue[str | bytes] = asyncio.Queue()
        self._is_closed = False
        self._loop = asyncio.new_event_loop()
        self._stop = asyncio.Event()
        self._thread = threading.Thread(target=self._run, name="webviz-bridge", daemon=True)
        self._thread.start()
        assets.provide(self.graph.fetch)

    # The interface of webviz.sources.Source

    def want(self, subscriptions: Mapping[str, Subscription]) -> None:
        """Replace all subscriptions; takes effect soon."""
        if subscriptions != self._subscriptions:
            self._subscriptions = dict(subscriptions)
            self.soon(self._reconcile)

    def offers(self) -> Mapping[str, Offer]:
        """All topics of the bridge; while the link is broken, those of before."""
        return self._offers

    @property
    def bridges(self) -> Sequence[Bridge]:
        """The link to the bridge."""
        return self._bridges

    def now_ns(self) -> int:
        """ROS time: that of the bridge if it is simulated, else of this machine."""
        return time.time_ns() if self._clock_ns is None else self._clock_ns

    def clock_messages(self) -> int | None:
        """Return how often the bridge has sent its simulated time; None while it is wall time."""
        return None if self._clock_ns is None else self._clock_messages

    def resolve(self, topic: str) -> str:
        """Return the full name of a topic, remapped; raises ValueError."""
        return resolved(topic, self._remappings)

    def stop(self) -> None:
        """Begin to close the connection."""
        assets.withdraw(self.graph.fetch)
        self.soon(self._stop.set)
        self._is_closed = True

    def close(self) -> None:
        """Close the connection and end the thread."""
        self.stop()
        self._thread.join()

    # The interface of webviz.sources.bridge.graph.Line

    @property
    def session(self) -> BridgeSession:
        """The open session; raises NotConnected."""
        if self._session is None:
            assert self._problem is not None
            raise NotConnected(str(self._problem))
        return self._session

    def require_fresh(self) -> None:
        """Raise NotConnected if what is sent now would arrive late."""
        if self._socket is not None and self._session is not None:  # else `session` says why
            self._socket.require_fresh()

    def soon(self, do: Callable[[], None]) -> bool:
        """Call `do` in the thread of the connection; whether there still is one."""
        if self._is_closed:
            return False
        try:
            self._loop.call_soon_threadsafe(do)
        except RuntimeError:  # it was closed meanwhile
            return False
        return True

    @property
    def nodes(self) -> tuple[str, ...]:
        """Full names of the nodes, sorted."""
        return self._nodes

    # The interface of webviz.sources.bridge.session.Host, in the thread of the connection

    def send(self, frame: str | bytes) -> None:
        """Send a frame soon, after those before it."""
        self._outbox.put_nowait(frame)

    def arrive(self, topic: str, cdr: bytes, stamp_ns: int) -> None:
        """Take a message."""
        delay_s = self._take(topic, cdr, stamp_ns)
        type = self._opened.get(topic, "")
        if self._rate_controller.note_small(topic, type, len(cdr), delay_s, time.monotonic()):
            self.sort_topics()

    def arrive_large(self, topic: str, cdr: bytes, stamp_ns: int) -> None:
        """Take a message of the second connection."""
        delay_s = self._take(topic, cdr, stamp_ns, is_large=True)
        self._rate_controller.note_large(topic, cdr, delay_s, time.monotonic())

    def _take(self, topic: str, cdr: bytes, stamp_ns: int, is_large: bool = False) -> float:
        """Take a message; its delay in seconds, 0 if it is unknown."""
        delay_s = 0.0
        if len(cdr) > MAX_TOTAL:
            self._too_large[topic] = (
                f"a message of {len(cdr) >> 20} MB is above the limit of {MAX_TOTAL >> 20} MB; "
                "publish smaller ones"
            )
            self.look()
            return delay_s
        if stamp_ns and self._clock_ns is None:  # simulated time has a pace of its own
            is_thinned = is_large and self._rate_controller.is_thinned(topic)
            delay_s = self._health.note_message(topic, stamp_ns, is_thinned)
            self.clock.note(stamp_ns, time.time_ns())
        cdr, types = self._definitions.read(topic, cdr)
        self.inbox.put(topic, Raw(cdr, self.now_ns(), types=types))
        return delay_s

    def set_time(self, stamp_ns: int) -> None:
        """Take the simulated time."""
        self._clock_ns = stamp_ns
        self._clock_messages += 1
        self.inbox.arrived.set()

    def learn(self, topic: str, type: str, definition: str) -> str:
        """Read a topic by the definition of its type; why that cannot be, "" if it can."""
        before = self._definitions.problem(topic)
        problem = self._definitions.learn(topic, type, definition)
        if problem != before:
            self.look()
        return problem

    def learn_service(self, type: str, request: str, response: str) -> None:
        """Register a service type by its definitions, unless it is known."""
        self._definitions.learn_service(type, request, response)

    def look(self) -> None:
        """Read topics, nodes and remarks soon."""
        if not self._is_look_due:
            self._is_look_due = True
            self._loop.call_later(LOOK_S, self._look)

    # The thread

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        try:
            self._loop.run_until_complete(self._connect())
        finally:
            self._is_closed = True
            self._loop.run_until_complete(self._loop.shutdown_asyncgens())
            self._loop.close()

    async def _connect(self) -> None:
        """Open the connection, again and again, until the source is closed."""
        wait_s = FIRST_RETRY_S
        stopped = asyncio.ensure_future(self._stop.wait())
        while not self._stop.is_set():
            began_s = time.monotonic()
            talking = asyncio.ensure_future(self._talk())
            await asyncio.wait({talking, stopped}, return_when=asyncio.FIRST_COMPLETED)
            if not talking.done():
                talking.cancel()
            (outcome,) = await asyncio.gather(talking, return_exceptions=True)
            if self._stop.is_set():
                break
            if time.monotonic() - began_s > LAST_RETRY_S:
                wait_s = FIRST_RETRY_S
            self._on_disconnect(outcome)
            # Not all viewers of a robot at the same moment.
            await asyncio.wait({stopped}, timeout=wait_s * random.uniform(0.8, 1.2))
            wait_s = min(LAST_RETRY_S, wait_s * 2)
        self._on_disconnect(NotConnected("The viewer has ended."))

    async def _talk(self) -> None:
        """Open the connection once, and talk until it breaks."""
        async with opened(self._address, BridgeConnection) as socket:
            self._socket = socket
            self._outbox = asyncio.Queue()
            self._session = session = open_session(socket.subprotocol, self)
            self._rate_controller = RateController()
            self._bulk = BulkTopics(self._rate_controller, self, session.beside)
            self._joined(session)
            await first_of(
                read(socket, session, self._note_malformed),
                write(socket, self._outbox),
                self._watch(socket),
                self._bulk.run(),
            )

    def open_bulk(self) -> AbstractAsyncContextManager[BulkConnection]:
        """Open the second connection."""
        return opened(self._address, BulkConnection)

    def _note_malformed(self, problem: str) -> None:
        self._health.note_malformed(problem)
        self.look()

    async def _watch(self, socket: BridgeConnection) -> None:
        """Measure the link, and end it if it is silent for too long."""
        next_remark_s = 0.0
        while True:
            pinged_s = time.monotonic()
            pong = asyncio.ensure_future(await socket.ping())
            await asyncio.wait({pong}, timeout=PING_S)
            if pong.done():
                self._round_trip_s = time.monotonic() - pinged_s
                self.clock.note_trip(self._round_trip_s)
                self._rate_controller.note_trip(
                    self._round_trip_s, self.clock.trip_s, time.monotonic()
                )
                await asyncio.sleep(PING_S)
            silent_s = socket.silent_s
            if silent_s > BROKEN_S:
                socket.transport.abort()
                raise Silent(f"Nothing came from the bridge for {silent_s:.0f} s.")
            if time.monotonic() >= next_remark_s:
                next_remark_s = time.monotonic() + REMARK_S
                self._tell()

    def _joined(self, session: BridgeSession) -> None:
        """Begin a session with what the last one had."""
        if self._problem is not None and self._problem is not NEVER:
            log.warning("%s: connected.", self._address.name)
        self._problem = None
        self._health = LinkHealth()
        self.clock.start()
        session.start()
        self._reconcile()
        self.graph.readvertise(session)
        self._look()

    def _on_disconnect(self, outcome: object) -> None:
        """Note why there is no connection, and fail what is pending."""
        session, self._session, self._socket = self._session, None, None
        error = outcome if isinstance(outcome, BaseException) else ConnectionError("it has ended")
        problem = (
            Problem(str(error), "Check the network.")
            if isinstance(error, (Silent, NotConnected))
            else explain(error, self._address)
        )
        if session is not None:
            session.close(str(problem))
        if problem != self._problem and not self._stop.is_set():
            log.warning("%s: %s", self._address.name, problem)
        self._problem = problem
        self._round_trip_s = None
        self._look()

    def _reconcile(self) -> None:
        """Subscribe to the current topics."""
        types = {topic: subscription.type for topic, subscription in self._subscriptions.items()}
        for topic in [t for t in self._opened if t not in types]:
            del self._opened[topic]
            self._definitions.forget(topic)
            self.inbox.close(topic)
            self._health.forget(topic)
            self._too_large.pop(topic, None)
        for topic, type in types.items():
            if self._opened.get(topic) != type:
                self._opened[topic] = type
                self._definitions.forget(topic)
                self.inbox.open(topic, TF_LIMIT if type == TF_TYPE else INBOX_LIMIT)
        self.sort_topics()
        self._look()

    def sort_topics(self) -> None:
        """Subscribe to small topics over the first connection, and to large topics in turns."""
        if self._session is None:
            return
        is_apart = self._bulk is not None and not self._bulk.is_refused
        large = self._rate_controller.large(self._subscriptions) if is_apart else {}
        self._session.want({t: each for t, each in self._subscriptions.items() if t not in large})
        if self._bulk is not None:
            self._bulk.want(large)

    def _look(self) -> None:
        """Read topics, nodes and remarks."""
        self._is_look_due = False
        if (session := self._session) is not None:
            topics = session.topics
            # A new connection begins without topics; those of before hold until it has some.
            self._topics = topics if topics or self._bridges[0].is_up else self._topics
            self._nodes = session.nodes
        if self._bulk is not None:
            self._bulk.subscribe()
        offers = {topic: self._offer(topic, carried) for topic, carried in self._topics.items()}
        if offers != self._offers:
            self._offers = offers
        self._tell()
        self.inbox.arrived.set()

    def _offer(self, topic: str, carried: CarriedTopic) -> Offer:
        problem = carried.problem or self._too_large.get(topic) or self._definitions.problem(topic)
        subscription = self._subscriptions.get(topic)
        if subscription is not None and self._problem is not None:
            problem = f"the link is broken. {self._problem.cause}"
        return carried.offer(subscription, problem)

    def _tell(self) -> None:
        """Describe the bridge as it is now."""
        before, socket = self._bridges[0], self._socket
        link = described(
            before,
            self._session,
            self._problem,
            [*thinning(self._rate_controller), *self._health.remarks()],
            socket.silent_s if socket else 0.0,
            self._round_trip_s,
        )
        self._bridges = (link,) if link != before else self._bridges

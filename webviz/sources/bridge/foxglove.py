"""One connection to a server of the Foxglove protocol, such as foxglove_bridge."""

from __future__ import annotations

import functools
from collections.abc import Collection, Mapping, Sequence
from concurrent.futures import Future
from typing import Any

from webviz.api.bridge import BridgeParameters
from webviz.api.offer import Endpoint, Publisher
from webviz.data.foxglove.schemas import ConversionError, conversion
from webviz.data.messages import MessageError, definition
from webviz.data.words import plain
from webviz.sources.bridge import foxglove_wire as wire
from webviz.sources.bridge.foxglove_channels import (
    ChannelSubscription,
    ChannelSubscriptions,
    ConnectionGraph,
    FoxgloveChannels,
    is_foreign,
    type_of,
    unread,
)
from webviz.sources.bridge.foxglove_parameters import ParameterServices
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

MAX_SERVICES = 10_000
MAX_STATUSES = 8
"""Warnings of the bridge that are kept, the newest."""
MAX_PENDING = 1000
"""Calls and files whose answers are outstanding."""
NO_PUBLISHING = (
    "The bridge does not accept messages. Add clientPublish to the parameter capabilities of "
    "foxglove_bridge."
)
NO_SERVICES = (
    "The bridge calls no services. Add services to the parameter capabilities of foxglove_bridge."
)
NO_ASSETS = (
    "The bridge sends no files. Add assets to the parameter capabilities of foxglove_bridge."
)
LIMITS = (
    "The bridge does not report the QoS of publishers; it subscribes with a matching one.",
    "Actions do not pass the bridge, so no goal can be sent to one.",
)
NO_GRAPH = "The bridge does not report which nodes publish and subscribe."


class FoxgloveSession:
    """Topics, services and files of a Foxglove server; see `BridgeSession`.

    Args:
        host: of the connection.
        is_first: False for a second connection, for large topics only.
    """

    protocol = "Foxglove"

    def __init__(self, host: Host, is_first: bool = True) -> None:
        self._host = host
        self._is_first = is_first
        self._info: wire.ServerInfo | None = None
        """Its first text, None before."""
        self._graph = ConnectionGraph()
        self._channels = FoxgloveChannels()
        self._services: dict[str, wire.ServiceOffer] = {}
        self._parameters = ParameterServices(host.send, host.look)
        self._subscriptions: Mapping[str, Subscription] = {}
        self._lines = ChannelSubscriptions()
        self._foreign: dict[str, wire.ServerChannel] = {}
        """Subscribed channels of Foxglove's own schemas, by topic."""
        self._to_advertise: frozenset[Advertisement] = frozenset()
        self._advertised: dict[Advertisement, int] = {}
        self._pending: dict[int, Future[bytes]] = {}
        self._assets: dict[int, Future[bytes]] = {}
        self._statuses: dict[str, str] = {}
        self._next_id = 1

    # For the source

    @property
    def topics(self) -> Mapping[str, CarriedTopic]:
        """All topics, by name."""
        return {
            topic: self._carried(topic, each) for topic, each in self._channels.by_topic.items()
        }

    @property
    def nodes(self) -> tuple[str, ...]:
        """Full names of the nodes, as far as the bridge tells them."""
        return self._graph.nodes

    @property
    def parameters(self) -> BridgeParameters:
        """The nodes with parameters that the bridge itself has."""
        return self._parameters.parameters

    @property
    def remarks(self) -> Sequence[str]:
        """Warnings of the bridge, and what is left out of what it offers."""
        return [*self._channels.remarks(), *self._statuses.values()]

    @property
    def limits(self) -> Sequence[str]:
        """Limits of the bridge, by its capabilities."""
        if self._info is None:
            return LIMITS
        able = self._info.capabilities
        return [
            *LIMITS,
            *([] if "connectionGraph" in able else [NO_GRAPH]),
            *([] if "clientPublish" in able else [NO_PUBLISHING]),
            *([] if "services" in able else [NO_SERVICES]),
            *([] if "assets" in able else [NO_ASSETS]),
        ]

    def start(self) -> None:
        """Do nothing: the server speaks first."""

    def beside(self, host: Host) -> FoxgloveSession:
        """Return a session for a second connection, for large topics."""
        return FoxgloveSession(host, is_first=False)

    def receive(self, frame: str | bytes) -> None:
        """Take a frame; raises WireError."""
        if isinstance(frame, bytes):
            self._take_binary(wire.read_binary(frame))
        else:
            self._take_text(wire.read_text(frame))

    def want(
        self, subscriptions: Mapping[str, Subscription], resting: Collection[str] = frozenset()
    ) -> None:
        """Make the subscriptions exactly these, as far as they are offered."""
        subscriptions = {t: each for t, each in subscriptions.items() if t not in resting}
        self._subscriptions = subscriptions
        ended: list[int] = []
        for line in self._lines:
            channel = self._channel(line.topic)
            target = channel and (channel.id, subscriptions[line.topic].resubscriptions)
            if target != (line.channel, line.resubscriptions):
                self._lines.end(line)
                ended.append(line.id)
        begun: list[tuple[int, int]] = []
        for topic in subscriptions:
            if topic not in self._lines and (channel := self._channel(topic)) is not None:
                begun.append(self._begin(topic, channel))
        if ended:
            self._host.send(wire.unsubscribe(ended))
        if begun:
            self._host.send(wire.subscribe(begun))

    def advertise(self, advertisements: Collection[Advertisement]) -> None:
        """Make the advertised publishers exactly these; raises NotConnected."""
        self._to_advertise = frozenset(advertisements)
        if self._info is None:
            return  # they follow once it is known what the server can do
        obsolete = [each for each in self._advertised if each not in advertisements]
        if obsolete:
            self._host.send(wire.unadvertise([self._advertised.pop(each) for each in obsolete]))
        for each in advertisements:
            self._advertise(each)

    def publish(self, advertisement: Advertisement, cdr: bytes) -> int:
        """Publish a message; raises NotConnected."""
        self._host.send(wire.publish(self._advertise(advertisement), cdr))
        names = self._graph.subscribers(advertisement.topic)
        return UNKNOWN if names is None else len(names)

    def call(self, service: str, type: str, request: bytes, answer: Future[bytes]) -> None:
        """Call a service; raises NotConnected."""
        if service not in self._services and self._parameters.serves(service):
            self._parameters.call(service, type, request, answer)
            return
        self._require("services", NO_SERVICES)
        offered = self._services.get(service)
        if offered is None:
            raise Missing(f"The bridge offers no service {service}.")
        if offered.type != type:
            raise NotConnected(
                f"{service} has the type {offered.type}, not {type}. Choose another service."
            )
        self._host.send(wire.call(offered.id, self._pend(self._pending, answer), request))

    def forget(self, answer: Future[bytes]) -> None:
        """Expect the response of a call no longer."""
        self._parameters.forget(answer)
        for pending in (self._pending, self._assets):
            for id, each in list(pending.items()):
                if each is answer:
                    del pending[id]

    def fetch(self, uri: str, answer: Future[bytes]) -> None:
        """Fetch a file of the robot; raises NotConnected."""
        self._require("assets", NO_ASSETS)
        self._host.send(wire.fetch_asset(self._pend(self._assets, answer), uri))

    def close(self, problem: str) -> None:
        """Fail everything that is pending."""
        self._parameters.close(problem)
        for answer in (*self._pending.values(), *self._assets.values()):
            fail(answer, problem)
        self._pending.clear()
        self._assets.clear()

    # Frames

    def _take_binary(self, message: Any) -> None:
        match message:
            case wire.MessageData():
                if topic := self._lines.topic(message.subscription):
                    self._host.arrive(topic, self._cdr(topic, message.payload), message.stamp_ns)
            case wire.TimeNow():
                self._host.set_time(message.stamp_ns)
            case wire.ServiceResponse():
                self._answer(message)
            case wire.Asset():
                answer = self._assets.pop(message.request, None)
                if answer is not None and message.problem:
                    fail(answer, f"The bridge has no such file: {message.problem}.")
                elif answer is not None:
                    succeed(answer, message.data)

    def _cdr(self, topic: str, payload: bytes) -> bytes:
        """Return a message in CDR, of which others than Foxglove's own are made already."""
        channel = self._foreign.get(topic)
        converter = channel and conversion(channel.schema_name)
        if channel is None or converter is None:
            return payload
        try:
            return converter.convert(channel.encoding, payload)
        except ConversionError as error:
            raise WireError(str(error)) from error

    def _take_text(self, message: Any) -> None:
        match message:
            case wire.ServerInfo():
                self._begin_session(message)
            case wire.Advertise():
                for channel in message.channels:
                    self._channels.add(channel)
                self.want(self._subscriptions)
            case wire.Unadvertise():
                for id in message.channel_ids:
                    self._channels.remove(id)
                self.want(self._subscriptions)
            case wire.AdvertiseServices():
                for service in message.services[: MAX_SERVICES - len(self._services)]:
                    self._services[service.name] = service
                    if (texts := service.definitions) is not None:
                        self._host.learn_service(service.type, *texts)
            case wire.UnadvertiseServices():
                removed = set(message.service_ids)
                self._services = {n: s for n, s in self._services.items() if s.id not in removed}
            case wire.ServiceCallFailure():
                if answer := self._pending.pop(message.call_id, None):
                    reason = plain(message.message, 300) or "the bridge gives no reason"
                    fail(answer, f"The call has failed: {reason}")
                return
            case wire.ConnectionGraphUpdate():
                self._graph.update(message)
            case wire.ParameterValues():
                self._parameters.take(message)
                return
            case wire.ServerStatus():
                self._note(message)
            case wire.RemoveStatus():
                for id in message.status_ids:
                    self._statuses.pop(id, None)
            case _:
                return
        self._host.look()

    def _begin_session(self, info: wire.ServerInfo) -> None:
        """Take what a server says first; it may begin anew on the same connection."""
        self._info = info
        if not self._is_first:
            return
        if "connectionGraph" in info.capabilities:
            self._host.send(wire.subscribe_connection_graph())
        if "parameters" in info.capabilities:
            self._parameters.start("parametersSubscribe" in info.capabilities)
        if "clientPublish" in info.capabilities:
            self.advertise(self._to_advertise)

    def _answer(self, response: wire.ServiceResponse) -> None:
        answer = self._pending.pop(response.call, None)
        if answer is None:
            return
        if response.encoding != "cdr":
            encoding = plain(response.encoding, 40)
            fail(answer, f"The bridge answers in the encoding {encoding!r}, webviz reads cdr only.")
        else:
            succeed(answer, response.payload)

    def _note(self, status: wire.ServerStatus) -> None:
        if status.level <= 0:
            return
        text = plain(status.message, 300)
        self._statuses.pop(status.id or text, None)
        self._statuses[status.id or text] = f"The bridge reports: {text}"
        while len(self._statuses) > MAX_STATUSES:
            del self._statuses[next(iter(self._statuses))]

    # FoxgloveChannels

    def _channel(self, topic: str) -> wire.ServerChannel | None:
        """Return the channel to subscribe to, None if none is wanted or can be read."""
        subscription = self._subscriptions.get(topic)
        for channel in self._channels.by_topic.get(topic, ()) if subscription else ():
            if subscription and type_of(channel) == subscription.type and not unread(channel):
                if self._lines.channel(topic) == channel.id:
                    return channel
                text = "" if is_foreign(channel) else channel.schema
                if not self._host.learn(topic, subscription.type, text):
                    return channel
        return None

    def _begin(self, topic: str, channel: wire.ServerChannel) -> tuple[int, int]:
        line = ChannelSubscription(
            self._new_id(), topic, channel.id, self._subscriptions[topic].resubscriptions
        )
        self._lines.begin(line)
        self._foreign.pop(topic, None)
        if is_foreign(channel):
            self._foreign[topic] = channel
        return line.id, channel.id

    def _carried(self, topic: str, channels: Sequence[wire.ServerChannel]) -> CarriedTopic:
        publishers: list[Publisher] = []
        for channel in channels:
            type = type_of(channel)
            make = functools.partial(
                Publisher, type=type, reliability="reliable", is_qos_known=False
            )
            durability = usual_durability(topic, type)
            nodes = self._graph.publishers(topic) or ("",)
            publishers += [make(node=node, durability=durability) for node in nodes]
        reasons = [unread(channel) for channel in channels]
        problem = reasons[0] if all(reasons) else ""
        return CarriedTopic(tuple(publishers), problem, self._readers(topic, publishers[0].type))

    def _readers(self, topic: str, type: str) -> tuple[Endpoint, ...] | None:
        names = self._graph.subscribers(topic)
        if names is None:
            return None
        make = functools.partial(Endpoint, is_qos_known=False)
        return tuple(make(name, type, "reliable", "volatile") for name in names)

    # Output

    def _advertise(self, advertisement: Advertisement) -> int:
        self._require("clientPublish", NO_PUBLISHING)
        former = self._advertised.get(advertisement)
        if former is not None:
            return former
        try:
            text = definition(advertisement.type)
        except MessageError:
            text = ""
        id = self._advertised[advertisement] = self._new_id()
        self._host.send(wire.advertise(id, advertisement.topic, advertisement.type, text))
        return id

    def _require(self, capability: str, problem: str) -> None:
        """Raise NotConnected if the server lacks a capability."""
        if self._info is None:
            raise NotConnected("The bridge has not announced its capabilities yet. Try again.")
        if capability not in self._info.capabilities:
            raise NotConnected(problem)

    def _pend(self, pending: dict[int, Future[bytes]], answer: Future[bytes]) -> int:
        if len(pending) >= MAX_PENDING:
            raise NotConnected(f"The bridge owes {MAX_PENDING} answers. Try again later.")
        id = self._new_id()
        pending[id] = answer
        return id

    def _new_id(self) -> int:
        id, self._next_id = self._next_id, self._next_id % 0xFFFFFFFF + 1
        return id

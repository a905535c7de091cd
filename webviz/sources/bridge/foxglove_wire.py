"""The frames of the Foxglove protocol: JSON texts, and binary ones in little-endian order."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import Any, NamedTuple

import msgspec

from webviz.data.words import plain
from webviz.sources.bridge.json_frames import JsonFrames
from webviz.sources.bridge.session import WireError

SUBPROTOCOLS = ("foxglove.sdk.v1", "foxglove.websocket.v1")
"""Names of the protocol since and before version 3 of foxglove_bridge; the frames are the same."""
_PUBLISH, _CALL = 1, 2
"""Opcodes of binary frames to the server."""
_MESSAGE = struct.Struct("<BIQ")
_TIME = struct.Struct("<BQ")
_RESPONSE = struct.Struct("<BIII")
_ASSET = struct.Struct("<BIBI")


class _Struct(msgspec.Struct, rename="camel"):
    pass


class ServerInfo(_Struct):
    """The first text of a server."""

    capabilities: tuple[str, ...] = ()


class ServerChannel(_Struct):
    """A topic of the server; `encoding` is of the messages, `schema_encoding` of their schema."""

    id: int
    topic: str
    encoding: str
    schema_name: str
    schema: str = ""
    schema_encoding: str | None = None


class Advertise(_Struct):
    """New channels."""

    channels: tuple[ServerChannel, ...]


class Unadvertise(_Struct):
    """Channels that are gone."""

    channel_ids: tuple[int, ...]


class ServiceSchema(_Struct):
    """The definition of a request or response; `encoding` is of the messages."""

    encoding: str = ""
    schema: str = ""


class ServiceOffer(_Struct):
    """A service of the server, of which older ones send the definitions as texts alone."""

    id: int
    name: str
    type: str
    request: ServiceSchema | None = None
    response: ServiceSchema | None = None
    request_schema: str = ""
    response_schema: str = ""

    @property
    def definitions(self) -> tuple[str, str] | None:
        """Return the definitions of request and response; None if they are not of ROS 2."""
        both = self.request, self.response
        if any(each is not None and each.encoding not in ("", "cdr") for each in both):
            return None
        return (
            self.request.schema if self.request else self.request_schema,
            self.response.schema if self.response else self.response_schema,
        )


class AdvertiseServices(_Struct):
    """New services."""

    services: tuple[ServiceOffer, ...]


class UnadvertiseServices(_Struct):
    """Services that are gone."""

    service_ids: tuple[int, ...]


class ServiceCallFailure(_Struct):
    """A call has failed."""

    call_id: int
    message: str = ""


class ServerStatus(_Struct):
    """A text of the server: level 0 for information, 1 for warnings, 2 for errors."""

    level: int
    message: str
    id: str = ""


class RemoveStatus(_Struct):
    """Statuses that no longer hold."""

    status_ids: tuple[str, ...]


class PublishedTopic(_Struct):
    """A topic and the nodes that publish it."""

    name: str
    publisher_ids: tuple[str, ...]


class SubscribedTopic(_Struct):
    """A topic and the nodes that subscribe to it."""

    name: str
    subscriber_ids: tuple[str, ...]


class AdvertisedService(_Struct):
    """A service and the nodes that offer it."""

    name: str
    provider_ids: tuple[str, ...]


class ConnectionGraphUpdate(_Struct):
    """Changes of the graph of nodes."""

    published_topics: tuple[PublishedTopic, ...] = ()
    subscribed_topics: tuple[SubscribedTopic, ...] = ()
    advertised_services: tuple[AdvertisedService, ...] = ()
    removed_topics: tuple[str, ...] = ()
    removed_services: tuple[str, ...] = ()


class ServerParameter(_Struct, omit_defaults=True):
    """A parameter; `type` is "float64", "float64_array" or "byte_array", or follows from it."""

    name: str
    value: Any = None
    type: str | None = None


class ParameterValues(_Struct):
    """Values that were asked for under an id, or have changed."""

    parameters: tuple[ServerParameter, ...]
    id: str | None = None


class MessageData(NamedTuple):
    """A message of a subscription, with the time at which the server received it, in ns."""

    subscription: int
    stamp_ns: int
    payload: bytes


class TimeNow(NamedTuple):
    """The simulated time of the server, in ns."""

    stamp_ns: int


class ServiceResponse(NamedTuple):
    """The response to a call."""

    call: int
    encoding: str
    payload: bytes


class Asset(NamedTuple):
    """A file that was asked for, or why there is none."""

    request: int
    data: bytes
    problem: str


read_text = JsonFrames[_Struct](
    {
        "serverInfo": ServerInfo,
        "advertise": Advertise,
        "unadvertise": Unadvertise,
        "advertiseServices": AdvertiseServices,
        "unadvertiseServices": UnadvertiseServices,
        "serviceCallFailure": ServiceCallFailure,
        "status": ServerStatus,
        "removeStatus": RemoveStatus,
        "connectionGraphUpdate": ConnectionGraphUpdate,
        "parameterValues": ParameterValues,
    }
).read
"""Returns the message in a text frame; see `JsonFrames.read`."""


def read_binary(frame: bytes) -> MessageData | TimeNow | ServiceResponse | Asset | None:
    """Return the message in a binary frame, None for one of a kind that is not used.

    Raises:
        WireError: it is not of the protocol.
    """
    try:
        match frame[0] if frame else None:
            case 1:
                _, subscription, stamp_ns = _MESSAGE.unpack_from(frame)
                return MessageData(subscription, stamp_ns, frame[_MESSAGE.size :])
            case 2:
                return TimeNow(_TIME.unpack_from(frame)[1])
            case 3:
                _, _, call, length = _RESPONSE.unpack_from(frame)
                encoding, payload = _split(frame, _RESPONSE.size, length)
                return ServiceResponse(call, encoding.decode("utf-8", "replace"), payload)
            case 4:
                _, request, status, length = _ASSET.unpack_from(frame)
                problem, data = _split(frame, _ASSET.size, length)
                if status == 0:
                    return Asset(request, data, "")
                reason = plain(problem.decode("utf-8", "replace"), 200)
                return Asset(request, b"", reason or "the bridge gives no reason")
            case None:
                raise WireError("A binary frame is empty")
    except struct.error as error:
        raise WireError(f"A binary frame of {len(frame)} bytes is too short") from error
    return None


def _split(frame: bytes, start: int, length: int) -> tuple[bytes, bytes]:
    """Return a part of a frame, and what follows it."""
    if start + length > len(frame):
        raise WireError(f"A binary frame names a text of {length} bytes that it does not have")
    return frame[start : start + length], frame[start + length :]


def subscribe(subscriptions: Sequence[tuple[int, int]]) -> str:
    """Subscribe to channels: pairs of an own id and the id of the channel."""
    return _text("subscribe", subscriptions=[{"id": i, "channelId": c} for i, c in subscriptions])


def unsubscribe(ids: Sequence[int]) -> str:
    """End subscriptions."""
    return _text("unsubscribe", subscriptionIds=ids)


def advertise(id: int, topic: str, type: str, definition: str) -> str:
    """Announce what will be published, in CDR."""
    schema = {"schemaEncoding": "ros2msg", "schema": definition} if definition else {"schema": ""}
    channel = {"id": id, "topic": topic, "encoding": "cdr", "schemaName": type, **schema}
    return _text("advertise", channels=[channel])


def unadvertise(ids: Sequence[int]) -> str:
    """End what was advertised."""
    return _text("unadvertise", channelIds=ids)


def publish(id: int, cdr: bytes) -> bytes:
    """Return a message of an advertised channel."""
    return struct.pack("<BI", _PUBLISH, id) + cdr


def call(service: int, id: int, request: bytes) -> bytes:
    """Return a call of a service, in CDR."""
    return struct.pack("<BIII", _CALL, service, id, 3) + b"cdr" + request


def fetch_asset(id: int, uri: str) -> str:
    """Ask for a file."""
    return _text("fetchAsset", requestId=id, uri=uri)


def subscribe_connection_graph() -> str:
    """Ask for the nodes of the graph, and for all changes."""
    return _text("subscribeConnectionGraph")


def get_parameters(names: Sequence[str], id: str) -> str:
    """Ask for parameters; without names, for all."""
    return _text("getParameters", parameterNames=names, id=id)


def set_parameters(parameters: Sequence[ServerParameter], id: str) -> str:
    """Set parameters; the answer has their values then."""
    return _text("setParameters", parameters=parameters, id=id)


def subscribe_parameter_updates(names: Sequence[str]) -> str:
    """Ask for all changes of parameters."""
    return _text("subscribeParameterUpdates", parameterNames=names)


def _text(op: str, **fields: object) -> str:
    return msgspec.json.encode({"op": op, **fields}).decode()

"""Parameters over the Foxglove protocol, through the services that nodes of ROS have for them."""

from __future__ import annotations

import asyncio
import base64
import binascii
import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import replace
from typing import Any

import msgspec

from webviz.api.bridge import BridgeParameters
from webviz.data.messages import decode, encode, interfaces
from webviz.data.parameters import BYTES, KINDS, plain
from webviz.data.words import plain as printable
from webviz.sources.bridge import foxglove_wire as wire
from webviz.sources.bridge.session import fail, succeed
from webviz.sources.graph import NotConnected
from webviz.sources.names import MAX_NAME, is_full_name

SERVER = "/foxglove_server"
"""The node of parameters whose names have none, as servers without ROS have them."""
SERVICES = frozenset(("list_parameters", "describe_parameters", "get_parameters", "set_parameters"))
MAX_PARAMETERS = 10_000
"""Names that are remembered, of all nodes."""
CHANGE_S = 0.5
"""Changes within this time are reported together: each report makes readers ask for all values."""
MAX_PENDING = 100
"""Requests whose answers are outstanding."""
DOUBLE, STRING, DOUBLES = 3, 4, 8
INT64 = 2**63
Values = Mapping[str, wire.ServerParameter]
Take = Callable[[Values], dict[str, Any]]


class ParameterServices:
    """Answers calls of services for parameters by requests to a Foxglove server.

    foxglove_bridge names parameters after their nodes, such as /base.max_speed.

    Args:
        send: sends a frame.
        changed: called when nodes or values are others.
    """

    def __init__(self, send: Callable[[str], object], changed: Callable[[], object]) -> None:
        self._send = send
        self._changed = changed
        self._is_told = False
        self._locked: dict[str, str] = {}
        """Reason why a parameter cannot be set, "" if it can, by full name."""
        self._pending: dict[str, tuple[Future[bytes], str, Take]] = {}
        """Answers by the id of their request, with the type and a function that makes each."""
        self._telling: asyncio.TimerHandle | None = None
        self._next_id = 1
        self.parameters = BridgeParameters()
        """The nodes with parameters."""

    def start(self, is_told: bool) -> None:
        """Ask for all parameters.

        Args:
            is_told: whether the server tells changes.
        """
        self._is_told = is_told
        self._send(wire.get_parameters([], "all"))

    def serves(self, service: str) -> bool:
        """Return whether a service is of a node whose parameters the server has."""
        node, _, name = service.rpartition("/")
        return name in SERVICES and node in self.parameters.nodes

    def call(self, service: str, type: str, request: bytes, answer: Future[bytes]) -> None:
        """Call a service; raises NotConnected."""
        if len(self._pending) >= MAX_PENDING:
            raise NotConnected(f"The bridge owes {MAX_PENDING} answers. Try again later.")
        node, _, name = service.rpartition("/")
        parts = interfaces.service(type)
        decoded = decode(parts.request, request)
        if name == "describe_parameters":
            about = [{"name": each, **self._about(_full(node, each))} for each in decoded.names]
            succeed(answer, encode(parts.response, {"descriptors": about}))
            return
        id, self._next_id = str(self._next_id), self._next_id + 1
        match name:
            case "list_parameters":
                frame = wire.get_parameters([], id)
                take = self._names_of(node)
            case "get_parameters":
                names = [_full(node, each) for each in decoded.names]
                frame = wire.get_parameters(names, id)
                take = _values_of(names)
            case _:
                assignments = [_assignment(node, each) for each in decoded.parameters]
                frame = wire.set_parameters(assignments, id)
                take = _results_of(assignments)
        self._pending[id] = answer, parts.response, take
        self._send(frame)

    def take(self, message: wire.ParameterValues) -> None:
        """Take values, which answer a request or have changed."""
        self._note(message.parameters)
        if message.id is None:
            if self._telling is None:
                loop = asyncio.get_running_loop()
                self._telling = loop.call_later(CHANGE_S, self._tell)
            return
        answer, type, make = self._pending.pop(message.id, (None, "", None))
        if answer is not None and make is not None:
            succeed(answer, encode(type, make({each.name: each for each in message.parameters})))

    def _tell(self) -> None:
        self._telling = None
        self.parameters = replace(self.parameters, changes=self.parameters.changes + 1)
        self._changed()

    def forget(self, answer: Future[bytes]) -> None:
        """Expect the answer of a call no longer."""
        self._pending = {id: each for id, each in self._pending.items() if each[0] is not answer}

    def close(self, problem: str) -> None:
        """Fail everything that is pending."""
        for answer, _, _ in self._pending.values():
            fail(answer, problem)
        self._pending.clear()
        if self._telling is not None:
            self._telling.cancel()

    def _note(self, parameters: Sequence[wire.ServerParameter]) -> None:
        """Remember names, and ask for the changes of new ones."""
        new: list[str] = []
        for each in parameters:
            name = each.name
            if name not in self._locked:
                if len(self._locked) >= MAX_PARAMETERS or not 0 < len(name) <= 2 * MAX_NAME:
                    continue
                new.append(name)
            self._locked[name] = _value(each)[1]
        if not new:
            return
        if self._is_told:
            self._send(wire.subscribe_parameter_updates(new))
        nodes = tuple(sorted({_split(name)[0] for name in self._locked}))
        if nodes != self.parameters.nodes:
            self.parameters = replace(self.parameters, nodes=nodes)
            self._changed()

    def _names_of(self, node: str) -> Take:
        def take(values: Values) -> dict[str, Any]:
            pairs = [_split(name) for name in values if name in self._locked]
            return {"result": {"names": [name for of, name in pairs if of == node]}}

        return take

    def _about(self, name: str) -> dict[str, Any]:
        locked = self._locked.get(name, "")
        return {"read_only": bool(locked), "description": locked}


def _values_of(names: Sequence[str]) -> Take:
    def take(values: Values) -> dict[str, Any]:
        none: dict[str, Any] = {}
        return {"values": [_value(values[n])[0] if n in values else none for n in names]}

    return take


def _results_of(parameters: Sequence[wire.ServerParameter]) -> Take:
    def take(values: Values) -> dict[str, Any]:
        return {"results": [_result(each, values.get(each.name)) for each in parameters]}

    return take


def _result(parameter: wire.ServerParameter, answer: wire.ServerParameter | None) -> dict[str, Any]:
    """Return the outcome of a change: the server answers with the values that hold then."""
    if answer is None:
        return {"successful": False, "reason": "The bridge does not return this parameter."}
    if _value(parameter)[0] == _value(answer)[0]:
        return {"successful": True}
    current = printable(str(answer.value), 80)
    return {"successful": False, "reason": f"The bridge keeps it at {current}."}


def _split(name: str) -> tuple[str, str]:
    """Return the node of a parameter, and its name there."""
    node, _, inner = name.partition(".")
    return (node, inner) if inner and is_full_name(node) else (SERVER, name)


def _full(node: str, name: str) -> str:
    return name if node == SERVER else f"{node}.{name}"


def _assignment(node: str, parameter: Any) -> wire.ServerParameter:
    """Return a rcl_interfaces/msg/Parameter for the server; raises NotConnected."""
    kind = int(parameter.value.type)
    value: Any = plain(parameter.value, kind)
    numbers: list[Any] = value if isinstance(value, list) else [value]
    if any(isinstance(each, float) and not math.isfinite(each) for each in numbers):
        raise NotConnected("The bridge does not accept infinite numbers. Enter a finite one.")
    if kind == BYTES:
        value = base64.b64encode(bytes(numbers)).decode()
    types = {DOUBLE: "float64", DOUBLES: "float64_array", BYTES: "byte_array"}
    return wire.ServerParameter(_full(node, parameter.name), value, types.get(kind))


def _value(parameter: wire.ServerParameter) -> tuple[dict[str, Any], str]:
    """Return a rcl_interfaces/msg/ParameterValue, and why it cannot be set, "" if it can."""
    value, type = parameter.value, parameter.type
    try:
        kind, parameter_value = _typed(value, type)
    except (TypeError, ValueError, OverflowError, binascii.Error):
        return {"type": STRING, "string_value": _text(value)}, "ROS has no type for this value."
    return ({"type": kind, KINDS[kind][1]: parameter_value} if kind else {"type": 0}), ""


def _text(value: Any) -> str:
    try:
        return printable(msgspec.json.encode(value).decode(), 300)
    except RecursionError:
        return "..."


def _typed(value: Any, type: str | None) -> tuple[int, Any]:
    """Return the kind of a value and it; raises an error if ROS has none for it."""
    match value:
        case None:
            return 0, None
        case bool():
            return 1, value
        case str() if type == "byte_array":
            return BYTES, base64.b64decode(value, validate=True)
        case str():
            return STRING, value
        case int() | float():
            return _number(value, type == "float64")
        case [_, *_]:
            if any(isinstance(each, list | dict) for each in value):
                raise TypeError
            kinds = {_typed(each, None)[0] for each in value}
            if type == "float64_array" or kinds == {2, DOUBLE}:
                return DOUBLES, [_number(each, True)[1] for each in value]
            if len(kinds) == 1 and (kind := kinds.pop()) in (1, 2, DOUBLE, STRING):
                return kind + BYTES, value
    raise TypeError


def _number(value: Any, is_double: bool) -> tuple[int, Any]:
    if is_double or isinstance(value, float):
        return DOUBLE, float(value)
    if not -INT64 <= value < INT64:
        raise OverflowError
    return 2, value

"""Use of simulated time by nodes, which is a parameter that can be asked for."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping
from concurrent.futures import Future

from webviz.data.messages import MessageError, decode, encode, interfaces
from webviz.sources import Gate

TYPE = "rcl_interfaces/srv/GetParameters"
NAME = "use_sim_time"
BOOL = 1
"""Of rcl_interfaces/msg/ParameterType."""
AGAIN_S = 10.0
"""Time after which an answer is asked for again."""
PATIENCE_S = 3.0
MOST = 20
"""Nodes that are asked."""


class SimTime:
    """Asks nodes whether they follow simulated time.

    Args:
        gate: to the nodes.
    """

    def __init__(self, gate: Gate) -> None:
        self._gate = gate
        self._asked: dict[str, tuple[float, Future[bytes]]] = {}
        """By node: monotonic time in seconds, and the answer."""

    def ask(self, nodes: Iterable[str]) -> Mapping[str, bool]:
        """Ask nodes by their full names; return what those that have answered follow."""
        wanted = [*dict.fromkeys(nodes)][:MOST]
        now = time.monotonic()
        before, self._asked = self._asked, {}
        for node in wanted:
            at_s, answer = before.get(node, (-AGAIN_S, Future[bytes]()))
            if now - at_s >= AGAIN_S:
                request = encode(interfaces.service(TYPE).request, {"names": [NAME]})
                at_s = now
                answer = self._gate.query(f"{node}/get_parameters", TYPE, request, PATIENCE_S)
            self._asked[node] = at_s, answer
        read = {node: _read(answer) for node, (_, answer) in self._asked.items()}
        return {node: follows for node, follows in read.items() if follows is not None}


def _read(answer: Future[bytes]) -> bool | None:
    """Return an answer, None while it is awaited or without one."""
    if not answer.done() or answer.cancelled() or answer.exception() is not None:
        return None
    try:
        values = decode(interfaces.service(TYPE).response, answer.result()).values
    except MessageError:
        return None
    return bool(values[0].bool_value) if len(values) == 1 and values[0].type == BOOL else None

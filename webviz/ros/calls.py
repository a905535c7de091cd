"""The service clients of the node, and the calls that are pending."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

import msgspec
from rclpy.client import Client
from rclpy.node import Node

from webviz.ros.distribution import service_name
from webviz.ros.types import from_cdr, service_class, to_cdr
from webviz.sources.goals import WAIT_S
from webviz.sources.graph import Missing, NotConnected

MAX_CLIENTS = 100
MAX_CALLS = 100
"""Pending service calls."""


class _Call(msgspec.Struct, eq=False):
    """A pending service call.

    Args:
        client: of the service.
        request: its message.
        answer: receives the serialised response.
        deadline: monotonic time by which the response must arrive.
        give_up: monotonic time by which the service must appear.
        may_send: false as long as the request has to wait.
        future: rclpy's future, None until the request is sent.
        missing_since: monotonic time at which the service was found missing after that.
    """

    client: Client
    request: Any
    answer: Future[bytes]
    deadline: float
    give_up: float
    may_send: Callable[[], bool] = lambda: True
    future: Any = None
    missing_since: float | None = None

    @property
    def name(self) -> str:
        """Name of the service, or of the action that it is a part of."""
        return service_name(self.client).partition("/_action/")[0]


class Calls:
    """Calls services. All calls come from the node's thread.

    Args:
        node: that has the clients.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._clients: dict[tuple[str, str], Client] = {}
        self._calls: list[_Call] = []

    def send(
        self,
        service: str,
        type: str,
        request: bytes,
        timeout_s: float,
        answer: Future[bytes],
        may_send: Callable[[], bool] = lambda: True,
    ) -> None:
        """Call a service as soon as it appears and `may_send` allows it.

        Args:
            service: its full name.
            type: of the service.
            request: serialised.
            timeout_s: how long to wait for the response.
            answer: receives the serialised response.
            may_send: asked in every turn.

        Raises:
            NotConnected: too many calls are pending.
        """
        if len(self._calls) >= MAX_CALLS:
            raise NotConnected(f"{MAX_CALLS} service calls are pending. Try again later.")
        client = self._client(service, type)
        message = from_cdr(request, service_class(type).Request)
        now = time.monotonic()
        give_up = now + min(timeout_s, WAIT_S)
        self._calls.append(_Call(client, message, answer, now + timeout_s, give_up, may_send))

    def turn(self) -> bool:
        """Advance the pending calls; whether there are any."""
        now = time.monotonic()
        self._calls = [call for call in self._calls if not self._advance(call, now)]
        return bool(self._calls)

    def close(self) -> None:
        """Fail everything that is pending."""
        ended = NotConnected("The connection to ROS has ended.")
        calls, self._calls = self._calls, []
        for call in calls:
            if call.answer.set_running_or_notify_cancel():
                call.answer.set_exception(ended)

    def _client(self, service: str, type: str) -> Client:
        if (service, type) not in self._clients:
            for _ in range(len(self._clients) - MAX_CLIENTS + 1):
                self._node.destroy_client(self._clients.pop(next(iter(self._clients))))
            self._clients[service, type] = self._node.create_client(service_class(type), service)
        return self._clients[service, type]

    def _advance(self, call: _Call, now: float) -> bool:
        """Advance a call by one step; whether it has finished."""
        if call.answer.cancelled():
            self._forget(call)
            return True
        try:
            cdr = self._response(call, now)
        except Exception as error:  # rclpy and the type support raise many kinds
            self._forget(call)
            if call.answer.set_running_or_notify_cancel():
                call.answer.set_exception(error)
            return True
        if cdr is not None and call.answer.set_running_or_notify_cancel():
            call.answer.set_result(cdr)
        return cdr is not None

    def _response(self, call: _Call, now: float) -> bytes | None:
        """Return the serialised response, None while it is awaited."""
        name = call.name
        is_ready = call.client.service_is_ready()
        if call.future is None:
            if is_ready and call.may_send():
                call.future = call.client.call_async(call.request)
            elif now > call.give_up:
                raise Missing(f"No node offers {name}.")
            return None
        if call.future.done():
            return to_cdr(call.future.result())
        call.missing_since = None if is_ready else call.missing_since or now
        if call.missing_since is not None and now > call.missing_since + WAIT_S:
            raise Missing(f"The node that offered {name} has ended.")
        if now > call.deadline:
            raise NotConnected(f"{name} did not answer in time.")
        return None

    def _forget(self, call: _Call) -> None:
        """Expect no response any more."""
        if call.future is not None:
            call.client.remove_pending_request(call.future)

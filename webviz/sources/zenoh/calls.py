"""Service calls as queries: a request is a query with a payload, its answer is the reply."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Any

from webviz.data.words import plain
from webviz.sources.goals import WAIT_S
from webviz.sources.graph import Missing, NotConnected
from webviz.sources.inbox import MAX_TOTAL
from webviz.sources.zenoh.discovered import GraphSnapshot
from webviz.sources.zenoh.engine import directly

MAX_CALLS = 100
FOREVER_S = 10 * 365 * 86400.0
"""Time in seconds for results of goals."""


@dataclass(eq=False)
class PendingCall:
    """A call whose answer is awaited.

    Args:
        service: its full name.
        type: of the service.
        request: serialised.
        answer: receives the serialised response.
        deadline_s, give_up_s: monotonic times by which the answer must arrive and the service
            must appear.
        may_send: asked in every turn.
        is_sent: whether the query is under way.
    """

    service: str
    type: str
    request: bytes
    answer: Future[bytes]
    deadline_s: float
    give_up_s: float
    may_send: Callable[[], bool]
    is_sent: bool = False

    @property
    def name(self) -> str:
        """Name of the service, or of the action that it is a part of."""
        return self.service.partition("/_action/")[0]


class ZenohCalls:
    """Calls services; all calls but those of the engine come from the thread of the link.

    Args:
        graph: returns the newest graph.
        attachment: returns the attachment of the next request.
    """

    def __init__(self, graph: Callable[[], GraphSnapshot], attachment: Callable[[], bytes]) -> None:
        self._graph = graph
        self._attachment = attachment
        self._calls: list[PendingCall] = []

    def send(
        self,
        service: str,
        type: str,
        request: bytes,
        timeout_s: float,
        answer: Future[bytes],
        may_send: Callable[[], bool] = lambda: True,
    ) -> None:
        """Call a service as soon as it appears and `may_send` allows it; raises NotConnected."""
        if len(self._calls) >= MAX_CALLS:
            raise NotConnected(f"{MAX_CALLS} service calls are pending. Try again later.")
        now = time.monotonic()
        give_up = now + min(timeout_s, WAIT_S)
        self._calls.append(
            PendingCall(service, type, request, answer, now + timeout_s, give_up, may_send)
        )

    def turn(self, session: Any) -> None:
        """Send what can be sent, and fail what takes too long.

        Args:
            session: that is open, None without one.
        """
        self._calls = [call for call in self._calls if not self._advance(call, session)]

    def close(self, problem: str) -> None:
        """Fail everything that is pending."""
        calls, self._calls = self._calls, []
        for call in calls:
            _fail(call.answer, NotConnected(problem))

    def key(self, service: str, type: str) -> str:
        """Return the key of the requests of a service, "" if no node offers it.

        Raises:
            NotConnected: it has another type.
        """
        graph = self._graph()
        server = graph.servers.get(service)
        if server is not None:
            if server.type != type:
                raise NotConnected(
                    f"{service} has the type {server.type}, not {type}. Choose another service."
                )
            return server.key
        action, _, part = service.partition("/_action/")
        return f"{action[1:]}/_action/{part}" if part and action in graph.actions else ""

    def _advance(self, call: PendingCall, session: Any) -> bool:
        """Advance a call by one step; whether it has finished."""
        if call.answer.done():
            return True
        now = time.monotonic()
        try:
            if call.is_sent:
                if now > call.deadline_s:
                    raise NotConnected(f"{call.name} did not answer in time.")
            else:
                key = self.key(call.service, call.type)
                if key and session is not None and call.may_send():
                    self._query(session, key, call)
                elif now > call.give_up_s:
                    raise Missing(f"No node offers {call.name}.")
        except Exception as error:  # the engine raises kinds of its own
            _fail(call.answer, error)
            return True
        return False

    def _query(self, session: Any, key: str, call: PendingCall) -> None:
        call.is_sent = True

        def take(reply: Any) -> None:
            sample = reply.ok
            if sample is None:
                reason = plain(reply.err.payload.to_bytes()[:300].decode("utf-8", "replace"), 200)
                _fail(call.answer, NotConnected(f"{call.name} failed: {reason or 'no reason'}."))
            elif len(sample.payload) > MAX_TOTAL:
                most = MAX_TOTAL >> 20
                error = NotConnected(f"The answer of {call.name} is above the limit of {most} MB.")
                _fail(call.answer, error)
            else:
                _succeed(call.answer, sample.payload.to_bytes())

        def over() -> None:
            _fail(call.answer, Missing(f"The node that offered {call.name} has ended."))

        left_s = min(FOREVER_S, call.deadline_s - time.monotonic() + 1)
        session.get(
            key,
            directly(take, over),
            payload=call.request,
            attachment=self._attachment(),
            timeout=left_s,
        )


def _is_open(future: Future[Any]) -> bool:
    return not future.done() and not future.running()


def _succeed(future: Future[bytes], data: bytes) -> None:
    """Answer, unless that is done."""
    if _is_open(future) and future.set_running_or_notify_cancel():
        future.set_result(data)


def _fail(future: Future[Any], error: BaseException) -> None:
    """Fail a future, unless it is settled."""
    if _is_open(future) and future.set_running_or_notify_cancel():
        future.set_exception(error)

"""Goals for actions, by the services and topics of which ROS makes them."""

from __future__ import annotations

import logging
import uuid
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, Protocol, TypeVar

from webviz.data.messages import MessageError, decode, encode, interfaces
from webviz.data.words import joined
from webviz.sources.graph import Goal, NotConnected

T = TypeVar("T")

log = logging.getLogger("webviz")

CANCEL = "action_msgs/srv/CancelGoal"
WAIT_S = 2.0
"""Time to wait for a service or action to appear, and for an answer that is still on its way
when the node has ended."""
GOAL_ID = slice(4, 20)
"""Bytes of the goal's id in a serialised feedback message, after the encapsulation header."""
Call = Callable[[str, str, bytes, float], Future[bytes]]
"""Calls a service from any thread: its name, type, request and time limit; the response."""


class SendRequest(Protocol):
    """Calls a service as soon as it appears and `may_send` allows it."""

    def __call__(
        self,
        service: str,
        type: str,
        request: bytes,
        timeout_s: float,
        answer: Future[bytes],
        may_send: Callable[[], bool],
    ) -> None:
        """Call a service, whose response `answer` receives.

        Raises:
            NotConnected: too many calls are pending.
        """
        ...


class ListenToFeedback(Protocol):
    """Subscribes to the feedback of an action, once however often it is called."""

    def __call__(
        self, topic: str, type: str, arrive: Callable[[bytes], None]
    ) -> Callable[[], bool]:
        """Have `arrive` called with each message; return whether a publisher is known by now."""
        ...


class Goals:
    """Sends goals and follows them.

    Args:
        call: for any thread.
        send: for the thread of `Goals.send`.
        listen: likewise.
    """

    def __init__(self, call: Call, send: SendRequest, listen: ListenToFeedback) -> None:
        self._call = call
        self._send = send
        self._listen = listen
        self._feedback: dict[bytes, Callable[[bytes], object]] = {}

    def new(self, action: str) -> Goal:
        """Return a goal that is not sent yet. Cancel its result to stop following it."""
        goal_id = uuid.uuid4().bytes

        def cancel() -> Future[int]:
            values = {"goal_info": {"goal_id": _id(goal_id)}}
            parts = interfaces.service(CANCEL)
            request = encode(parts.request, values)
            answer = self._call(f"{action}/_action/cancel_goal", CANCEL, request, WAIT_S)
            code: Future[int] = Future()
            _then(answer, code, lambda cdr: int(_read(parts.response, cdr, action).return_code))
            return code

        goal = Goal(goal_id, Future(), Future(), cancel)
        goal.result.add_done_callback(lambda _: self._feedback.pop(goal_id, None))
        return goal

    def send(
        self,
        action: str,
        type: str,
        goal: bytes,
        handle: Goal,
        feedback: Callable[[bytes], object],
    ) -> None:
        """Send a goal, and wait for its result if it is accepted; from one thread."""
        parts = interfaces.action(type)
        values = {"goal_id": _id(handle.id), "goal": decode(parts.goal, goal)}
        request = encode(f"{parts.send_goal}_Request", values)
        self._feedback[handle.id] = feedback
        may_send = self._listen(f"{action}/_action/feedback", parts.feedback, self._arrive)
        answer: Future[bytes] = Future()

        def take(cdr: bytes) -> bool:
            try:
                is_accepted = bool(_read(f"{parts.send_goal}_Response", cdr, action).accepted)
            except NotConnected:
                handle.cancel()  # the server may have accepted it
                raise
            if is_accepted:
                self._await(action, parts, handle)
            else:
                _fail(handle.result, NotConnected(f"{action} rejected the goal."))
            return is_accepted

        def on_answer(answered: Future[bytes]) -> None:
            _then(answered, handle.accepted, take)
            if error := handle.accepted.exception():
                _fail(handle.result, error)

        answer.add_done_callback(on_answer)
        self._send(
            f"{action}/_action/send_goal",
            parts.send_goal,
            request,
            WAIT_S * 5,
            answer,
            may_send,  # lose no feedback
        )

    def _await(self, action: str, parts: interfaces.Action, goal: Goal) -> None:
        request = encode(f"{parts.get_result}_Request", {"goal_id": _id(goal.id)})

        def status(cdr: bytes) -> tuple[int, bytes]:
            return int(_read(f"{parts.get_result}_Response", cdr, action).status), cdr

        forever = float("inf")
        answer = self._call(f"{action}/_action/get_result", parts.get_result, request, forever)
        goal.result.add_done_callback(lambda _: answer.cancel())
        _then(answer, goal.result, status)

    def _arrive(self, cdr: bytes) -> None:
        """Pass feedback on to who sent the goal."""
        listener = self._feedback.get(cdr[GOAL_ID])
        if listener is not None:
            try:
                listener(cdr)
            except Exception:  # in the tool that sent the goal; keep receiving
                log.exception("Feedback of an action could not be handled")


def _read(type: str, cdr: bytes, action: str) -> Any:
    """Return a part of an answer of an action.

    Raises:
        NotConnected: it is malformed.
    """
    try:
        return decode(type, cdr)
    except MessageError as error:
        text = joined(f"An answer of {action} cannot be read: {error}", "Correct the server.")
        raise NotConnected(text) from error


def _then(answer: Future[bytes], then: Future[T], read: Callable[[bytes], T]) -> None:
    """Settle a future, unless it is cancelled, with what `read` makes of an answer."""

    def finish(answered: Future[bytes]) -> None:
        if not then.set_running_or_notify_cancel():
            return
        try:
            then.set_result(read(answered.result()))
        except Exception as error:
            then.set_exception(error)

    answer.add_done_callback(finish)


def _fail(future: Future[Any], error: BaseException) -> None:
    """Fail a future, unless it is cancelled."""
    if future.set_running_or_notify_cancel():
        future.set_exception(error)


def _id(goal_id: bytes) -> dict[str, Any]:
    return {"uuid": list(goal_id)}

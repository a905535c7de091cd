"""A goal that a tool sent to an action, from sending it to its outcome."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import CancelledError, Future
from typing import Literal

import msgspec
from msgspec.structs import replace

from webviz.api.errors import Error
from webviz.api.goal import GoalRequest
from webviz.api.status import Level, Status
from webviz.data.messages import MessageError, decode
from webviz.data.words import joined
from webviz.sources import Goal, Missing

SUCCEEDED, CANCELED, ABORTED = 4, 5, 6
"""Constants of action_msgs/msg/GoalStatus."""
REFUSED, UNKNOWN_GOAL = 1, 2
"""Constants of action_msgs/srv/CancelGoal."""
SILENCE_S = 5.0
"""Time in seconds without feedback, after which pages say so; for a server to end a goal that is
replaced, and one that is cancelled."""
ANSWER_S = 2.0
"""Time in seconds for the result of a goal that is cancelled, before the server is asked again, or
that the server does not know any more."""


class GoalProgress(msgspec.Struct, frozen=True):
    """A goal that a tool sent to an action.

    Args:
        id: for commands.
        title: name of the tool.
        label: what the goal is, in a few words.
        frame: the fixed frame when it was sent.
        poses: x, y, z in metres and yaw in radians in that frame.
        phase: "sending" until the server accepts it, and "ended" with its outcome.
        status: what is to be said of it, None for nothing.
        values: what its feedback says, texts by label.
        can_dismiss: whether pages may put it away, though the server has not ended it.
    """

    id: str
    title: str
    label: str = ""
    frame: str = ""
    poses: Sequence[tuple[float, float, float, float]] = ()
    phase: Literal["sending", "active", "canceling", "ended"] = "sending"
    status: Status | None = None
    values: Mapping[str, str] = msgspec.field(default_factory=dict)
    can_dismiss: bool = False


class RunningGoal:
    """Sends a goal once those before it have ended, and follows it. Used by the frame loop alone.

    Args:
        tool: id of the tool that sends it.
        action: full name.
        progress: what pages show of it, before it is sent.
        request: of the tool.
        send: sends it; gets what to call with feedback.
        before: goals of the same tool that it replaces.
        report: tells its sender whether it is accepted.
        ended: tells it the outcome of one that was, unless it was replaced.
    """

    def __init__(
        self,
        tool: str,
        action: str,
        progress: GoalProgress,
        request: GoalRequest,
        send: Callable[[Callable[[bytes], object]], Goal],
        before: Sequence[RunningGoal],
        report: Callable[[Status], None],
        ended: Callable[[Status], None],
    ) -> None:
        self.tool = tool
        self.action = action
        self.initial = progress
        self.before = tuple(before)
        self.is_accepted = False
        self.outcome: Status | None = None
        self.ended_s = 0.0
        self._request = request
        self._send = send
        self._report = report
        self._ended = ended
        self._goal: Goal | None = None
        self._newest: bytes | None = None
        self._values: Mapping[str, str] = {}
        self._heard_s: float | None = None
        self._is_canceling = False
        self._canceled: Future[int] | None = None
        self._canceled_s: float | None = None
        self._asked_s: float | None = None
        self._replaced_s: float | None = None
        self._problem = ""
        self._unread = ""
        self._give_up_s: float | None = None

    @property
    def is_active(self) -> bool:
        """Return whether it has not ended."""
        return self.outcome is None

    @property
    def is_replaced(self) -> bool:
        """Return whether the server accepted another goal instead, so that this one should end."""
        return self._replaced_s is not None

    def is_stuck(self, now: float) -> bool:
        """Return whether the server has not ended it although it was asked to a while ago."""
        return self.is_active and self._asked_s is not None and now > self._asked_s + SILENCE_S

    def cancel(self) -> None:
        """Ask the server to end it, as soon as it is accepted."""
        if not self._is_canceling:
            self._is_canceling, self._problem, self._canceled = True, "", None

    def give_up(self, now: float) -> None:
        """Stop following it, whatever the server does."""
        self._end(Status(Level.WARN, f"{self.action} did not end the goal."), now)

    def turn(self, now: float) -> None:
        """Take up what has happened since the last turn.

        Args:
            now: monotonic time in seconds.
        """
        if not self.is_active:
            return
        if self._goal is None:
            self._begin(now)
            return
        if not self.is_accepted and self._goal.accepted.done():
            self._take_answer(self._goal.accepted, now)
        if self._newest is not None:
            self._read(now)
        if self.is_active and self.is_accepted and self._goal.result.done():
            self._finish(self._goal.result, now)
        if self._replaced_s is not None and now > self._replaced_s + SILENCE_S:
            if self._asked_s is None:
                self.cancel()  # the server does not preempt it
            elif self.is_stuck(now):
                self.give_up(now)
        if self.is_active and self.is_accepted:
            self._follow_cancel(self._goal, now)

    def progress(self, now: float) -> GoalProgress:
        """Return the progress pages show."""
        progress = self.initial
        if self.outcome is not None:
            return replace(progress, phase="ended", status=self.outcome, values={})
        if not self.is_accepted:
            what = f"Waiting for {self.action}."
            if any(goal.is_active for goal in self.before) and self._goal is None:
                what = "Waiting for the previous goal to end."
            return replace(progress, phase="sending", status=Status(Level.OK, what))
        phase = "canceling" if self._is_canceling else "active"
        problem = self._problem or self._unread
        if self.is_stuck(now) and self._is_canceling:
            problem = f"{self.action} does not end the goal. Check its node, or dismiss the goal."
        status = Status(Level.WARN, problem) if problem else None
        if status is None and self._heard_s is not None and now - self._heard_s > SILENCE_S:
            text = f"No feedback for {now - self._heard_s:.0f} s. Check {self.action}."
            status = Status(Level.WARN, text)
        return replace(
            progress,
            phase=phase,
            status=status,
            values=self._values,
            can_dismiss=self.is_stuck(now),
        )

    def _begin(self, now: float) -> None:
        if self._is_canceling:
            self._end(Status(Level.OK, "Cancelled."), now)
        elif not any(goal.is_active and goal.action != self.action for goal in self.before):
            self._goal = self._send(self._hear)

    def _hear(self, cdr: bytes) -> None:
        """Keep the newest feedback; called from another thread, up to 1000 times per second."""
        self._newest = cdr

    def _read(self, now: float) -> None:
        cdr, self._newest, self._heard_s = self._newest, None, now
        if self._request.read is None or cdr is None:
            return
        try:
            self._values = self._request.read(decode(self._request.feedback_type, cdr).feedback)
            self._unread = ""
        except Exception as error:  # of the server's message, or in the plug-in
            self._unread = _unreadable(f"The feedback of {self.action}", error)

    def _take_answer(self, accepted: Future[bool], now: float) -> None:
        try:
            self.is_accepted = accepted.result()
            outcome = Status(Level.ERROR, f"{self.action} rejected the goal.")
        except Exception as error:  # rclpy and the type support raise many kinds
            outcome = self._failure(error)
        if self.is_accepted:
            for goal in self.before:
                goal._replaced_s = now
            self._report(Status(Level.OK, f"{self.action} accepted the goal."))
        else:
            self._report(outcome)
            self._end(outcome, now)

    def _follow_cancel(self, goal: Goal, now: float) -> None:
        if self._give_up_s is not None and now > self._give_up_s:
            text = f"{self.action} no longer knows this goal. Send it again."
            self._end(Status(Level.WARN, text), now)
        elif self._is_canceling and (self._canceled is None or self._is_late(now)):
            self._canceled, self._canceled_s = goal.cancel(), None
            self._asked_s = now if self._asked_s is None else self._asked_s
        elif self._canceled is not None and self._canceled.done() and self._canceled_s is None:
            self._canceled_s = now
            self._take_cancel(self._canceled, now)

    def _is_late(self, now: float) -> bool:
        return self._canceled_s is not None and now > self._canceled_s + ANSWER_S

    def _take_cancel(self, canceled: Future[int], now: float) -> None:
        try:
            code = canceled.result()
        except Exception as error:  # as above
            self._is_canceling, self._problem = False, self._failure(error).text
            return
        if code == REFUSED:
            self._is_canceling = False
            self._problem = f"{self.action} refuses to cancel the goal."
        elif code == UNKNOWN_GOAL:  # the server has been started again
            self._give_up_s = now + ANSWER_S

    def _finish(self, result: Future[tuple[int, bytes]], now: float) -> None:
        try:
            status, cdr = result.result()
            fault = self._request.fault(decode(self._request.result_type, cdr).result)
        except (Error, CancelledError) as error:
            self._end(self._failure(error), now)
            return
        except Exception as error:  # of the server's message, or in the plug-in
            text = _unreadable(f"The result of {self.action}", error)
            self._end(Status(Level.ERROR, text), now)
            return
        if status == SUCCEEDED:
            outcome = Status(Level.OK, self._request.success)
            if fault:
                outcome = Status(Level.WARN, f"Succeeded. {fault}")
        elif status == CANCELED:
            outcome = Status(Level.OK, "Cancelled.")
        elif status == ABORTED:
            outcome = Status(Level.ERROR, f"{self.action} aborted the goal without a reason.")
            if fault:
                outcome = Status(Level.ERROR, f"Aborted. {fault}")
        else:
            outcome = Status(Level.WARN, f"{self.action} does not know this goal. Send it again.")
        self._end(outcome, now)

    def _failure(self, error: BaseException) -> Status:
        text = str(error) or "The viewer has ended."
        if isinstance(error, Missing):
            text = joined(error.cause, self._request.remedy)
        return Status(Level.ERROR, text)

    def _end(self, outcome: Status, now: float) -> None:
        self.outcome, self.ended_s, self.before = outcome, now, ()
        if self.is_accepted and not self.is_replaced:
            self._ended(outcome)
        if self._goal is not None:
            self._goal.result.cancel()  # wait for it no longer


def _unreadable(what: str, error: Exception) -> str:
    reason = f": {error}" if isinstance(error, MessageError) else f" ({type(error).__name__})."
    return joined(f"{what} cannot be read{reason}", "Correct the server or the tool.")

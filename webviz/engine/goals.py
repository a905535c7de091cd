"""A goal that a tool sent to an action, from sending it to its outcome."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import CancelledError, Future
from dataclasses import replace

from webviz.api.errors import Error
from webviz.api.goal import GoalRequest
from webviz.api.status import Level, Status
from webviz.data.messages import decode
from webviz.engine.sources import Goal, Missing
from webviz.engine.state import GoalProgress

SUCCEEDED, CANCELED, ABORTED = 4, 5, 6
"""Of action_msgs/msg/GoalStatus."""
REFUSED, UNKNOWN_GOAL, TERMINATED = 1, 2, 3
"""Of action_msgs/srv/CancelGoal."""
SILENCE_S = 5.0
"""Without feedback, after which pages say so."""
ANSWER_S = 2.0
"""For the result of a goal that the server does not know any more."""


class RunningGoal:
    """Sends a goal once those before it have ended, and follows it. Used by the frame loop alone.

    Args:
        tool: id of the tool that sends it.
        action: full name.
        shown: what pages show of it, before it is sent.
        request: of the tool.
        send: sends it; gets what to call with feedback.
        before: goals of the same tool that it replaces.
        report: tells its sender whether it is accepted.
    """

    def __init__(
        self,
        tool: str,
        action: str,
        shown: GoalProgress,
        request: GoalRequest,
        send: Callable[[Callable[[bytes], object]], Goal],
        before: Sequence[RunningGoal],
        report: Callable[[Status], None],
    ) -> None:
        self.tool = tool
        self.action = action
        self.shown = shown
        self.before = tuple(before)
        self.is_accepted = False
        self.is_replaced = False
        self.outcome: Status | None = None
        self.ended_s = 0.0
        self._request = request
        self._send = send
        self._report = report
        self._sent: Goal | None = None
        self._newest: bytes | None = None
        self._values: Mapping[str, str] = {}
        self._heard_s: float | None = None
        self._is_canceling = False
        self._canceled: Future[int] | None = None
        self._problem = ""
        self._give_up_s: float | None = None

    @property
    def is_active(self) -> bool:
        """Whether it has not ended."""
        return self.outcome is None

    def cancel(self) -> None:
        """Ask the server to end it, as soon as it is accepted."""
        if not self._is_canceling:
            self._is_canceling, self._problem, self._canceled = True, "", None

    def turn(self, now: float) -> None:
        """Take up what has happened since the last turn.

        Args:
            now: monotonic time in seconds.
        """
        if not self.is_active:
            return
        if self._sent is None:
            self._begin(now)
            return
        if not self.is_accepted and self._sent.accepted.done():
            self._take_answer(self._sent.accepted, now)
        if self._newest is not None:
            self._read(now)
        if self.is_active and self.is_accepted:
            self._follow_cancel(self._sent, now)
        if self.is_active and self.is_accepted and self._sent.result.done():
            self._finish(self._sent.result, now)

    def progress(self, now: float) -> GoalProgress:
        """What pages show of it."""
        shown = self.shown
        if self.outcome is not None:
            return replace(shown, phase="ended", status=self.outcome, values={})
        if not self.is_accepted:
            what = f"Waiting for {self.action}."
            if any(goal.is_active for goal in self.before) and self._sent is None:
                what = "Waiting for the previous goal to end."
            return replace(shown, phase="sending", status=Status(Level.OK, what))
        phase = "canceling" if self._is_canceling else "active"
        status = Status(Level.WARN, self._problem) if self._problem else None
        if status is None and self._heard_s is not None and now - self._heard_s > SILENCE_S:
            text = f"No feedback for {now - self._heard_s:.0f} s. Check {self.action}."
            status = Status(Level.WARN, text)
        return replace(shown, phase=phase, status=status, values=self._values)

    def _begin(self, now: float) -> None:
        if self._is_canceling:
            self._end(Status(Level.OK, "Cancelled."), now)
        elif not any(goal.is_active and goal.action != self.action for goal in self.before):
            self._sent = self._send(self._hear)

    def _hear(self, cdr: bytes) -> None:
        """Keep the newest feedback; called from another thread, up to 1000 times per second."""
        self._newest = cdr

    def _read(self, now: float) -> None:
        cdr, self._newest, self._heard_s = self._newest, None, now
        if self._request.read is not None and cdr is not None:
            self._values = self._request.read(decode(self._request.feedback_type, cdr).feedback)

    def _take_answer(self, accepted: Future[bool], now: float) -> None:
        try:
            self.is_accepted = accepted.result()
            outcome = Status(Level.ERROR, f"{self.action} rejected the goal.")
        except (Error, CancelledError) as error:
            outcome = self._failure(error)
        if self.is_accepted:
            for goal in self.before:
                goal.is_replaced = True
            self._report(Status(Level.OK, f"{self.action} accepted the goal."))
        else:
            self._report(outcome)
            self._end(outcome, now)

    def _follow_cancel(self, sent: Goal, now: float) -> None:
        if self._is_canceling and self._canceled is None:
            self._canceled = sent.cancel()
        if self._give_up_s is not None and now > self._give_up_s:
            text = f"{self.action} does not know this goal any more. Send it again."
            self._end(Status(Level.WARN, text), now)
        elif self._canceled is not None and self._canceled.done() and self._give_up_s is None:
            self._take_cancel(self._canceled, now)

    def _take_cancel(self, canceled: Future[int], now: float) -> None:
        try:
            code = canceled.result()
        except (Error, CancelledError) as error:
            self._is_canceling, self._problem = False, self._failure(error).text
            return
        if code == REFUSED:
            self._is_canceling = False
            self._problem = f"{self.action} refuses to cancel the goal."
        elif code in (UNKNOWN_GOAL, TERMINATED):
            self._give_up_s = now + ANSWER_S

    def _finish(self, result: Future[tuple[int, bytes]], now: float) -> None:
        try:
            status, cdr = result.result()
            fault = self._request.fault(decode(self._request.result_type, cdr).result)
        except (Error, CancelledError) as error:
            self._end(self._failure(error), now)
            return
        except Exception as error:  # in the plug-in
            text = f"The result of {self.action} could not be read ({type(error).__name__})."
            self._end(Status(Level.ERROR, text), now)
            return
        if status == SUCCEEDED:
            done = Status(Level.WARN, fault) if fault else Status(Level.OK, self._request.success)
        elif status == CANCELED:
            done = Status(Level.OK, "Cancelled.")
        elif status == ABORTED:
            done = Status(Level.ERROR, fault or f"{self.action} aborted the goal without a reason.")
        else:
            done = Status(Level.WARN, f"{self.action} does not know this goal. Send it again.")
        self._end(done, now)

    def _failure(self, error: BaseException) -> Status:
        text = str(error) or "The viewer has ended."
        if isinstance(error, Missing):
            text = f"{error.cause} {self._request.remedy}"
        return Status(Level.ERROR, text)

    def _end(self, outcome: Status, now: float) -> None:
        self.outcome, self.ended_s, self.before = outcome, now, ()

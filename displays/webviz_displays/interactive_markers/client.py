"""The client of an interactive marker server: asks for all markers, then follows its updates.

The protocol is that of the package interactive_markers in ROS 2: the answer of the service
`<namespace>/get_interactive_markers` has the number of the last update that it includes, and every
update on `<namespace>/update` has the next number. After a gap the client asks again.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import CancelledError, Future
from dataclasses import dataclass, field
from typing import Literal

from webviz import Error, Level, Status
from webviz.api.wire import Heard, Wire
from webviz.data.messages import MessageError
from webviz.data.words import joined
from webviz_displays.interactive_markers.reading import (
    SERVICE,
    UPDATE,
    News,
    ServerMessage,
    read_answer,
    read_update,
)

DEPTH = 100
ANSWER_S = 5.0
"""For the server to answer."""
PAUSE_S = 0.5
"""Between two requests."""
MAX_WAITING = 1000
"""Updates that wait, such as while the server is asked."""
MAX_WAITING_BYTES = 64_000_000

State = Literal["searching", "asking", "running"]


@dataclass
class Client:
    """Follows one server.

    Args:
        namespace: of the server, without a slash at the end.
    """

    namespace: str
    state: State = "searching"
    sequence: int = 0
    """Number of the last update that was applied."""
    problem: str = ""
    """Why it had to ask again, or could not, a sentence."""
    gaps: int = 0
    """Number of gaps in the sequence of updates."""
    _heard: Heard = field(default_factory=Heard)
    _answer: Future[bytes] | None = None
    _next_s: float = 0.0
    _waiting: deque[bytes] = field(default_factory=deque)
    """Updates that are not read yet."""
    _early: int = 0
    """Number of waiting updates that came before the answer, which may include them."""

    def step(self, wire: Wire) -> list[News]:
        """Take up what has happened since the last call; what changed, in order.

        Raises:
            ValueError: the namespace is invalid; one sentence.
        """
        before = self._heard.endpoints
        heard = self._heard = wire.listen(f"{self.namespace}/update", UPDATE, DEPTH)
        if heard.has_gap or heard.endpoints != before:  # the server may have been started again
            self._restart()
        self._waiting += heard.messages
        if not heard.publishers:
            self._restart()
            return [News(is_all=True)] if before else []
        if len(self._waiting) > MAX_WAITING or sum(map(len, self._waiting)) > MAX_WAITING_BYTES:
            self._restart()
        if self.state == "searching" and heard.is_ready and wire.clock_s >= self._next_s:
            self._ask(wire.query)
            self._next_s = wire.clock_s + PAUSE_S
        news = self._take_answer(wire) if self.state == "asking" else []
        if self.state == "running":
            news += self._follow(wire)
        return news

    def status(self, count: int) -> Status:
        """Return the status of the connection, given the number of markers."""
        service, publishers = f"{self.namespace}/get_interactive_markers", self._heard.publishers
        if not publishers:
            text = f"No interactive marker server at {self.namespace}. Start it, or choose another."
            return Status(Level.WARN, text)
        if len(publishers) > 1:
            return Status(
                Level.WARN,
                f"{len(publishers)} servers share {self.namespace}: {', '.join(publishers)}. "
                "Their updates contradict each other. Give each a namespace of its own.",
            )
        if self.state == "running" and not self.problem:
            markers = f"{count} marker{'s' * (count != 1)}"
            gaps = f"; asked again after {self.gaps} gaps in the updates" if self.gaps else ""
            return Status(Level.OK, f"Connected to {self.namespace}, {markers}{gaps}.")
        return Status(Level.WARN, self.problem or f"Waiting for the answer of {service}.")

    def _restart(self) -> None:
        self.state, self._answer = "searching", None
        self._waiting.clear()

    def _ask(self, query: Callable[[str, str, float], Future[bytes]]) -> None:
        self.state = "asking"
        self._answer = query(f"{self.namespace}/get_interactive_markers", SERVICE, ANSWER_S)

    def _take_answer(self, wire: Wire) -> list[News]:
        if self._answer is None or not self._answer.done():
            return []
        try:
            number, news = read_answer(self._answer.result())
        except (Error, MessageError, CancelledError) as error:
            self.state, self._answer, self.problem = "searching", None, str(error)
            self._next_s = wire.clock_s + PAUSE_S
            return []
        self.state, self.problem, self._answer = "running", "", None
        self.sequence, self._early = number, len(self._waiting)
        return [news] if news else []

    def _follow(self, wire: Wire) -> list[News]:
        """Apply the updates that wait, in order."""
        found: list[News] = []
        while self._waiting:
            update = self._read(self._waiting.popleft())
            is_early, self._early = self._early > 0, max(0, self._early - 1)
            if update is None or update.news is None:
                continue
            if is_early and update.number <= self.sequence:
                continue
            if update.number != self.sequence + 1:
                self.gaps += 1
                self.problem = (
                    f"Update {update.number} came instead of {self.sequence + 1}. Asking again."
                )
                self._restart()
                wire.wake()
                break
            self.sequence += 1
            self.problem = ""
            found.append(update.news)
        return found

    def _read(self, cdr: bytes) -> ServerMessage | None:
        """Read an update; one that cannot be read makes a gap."""
        try:
            return read_update(cdr)
        except MessageError as error:
            self.problem = joined(f"An update cannot be read: {error}", "Correct the server.")
            return None

"""The client of an interactive marker server: asks for all markers, then follows its updates.

The protocol is that of the package interactive_markers in ROS 2: the answer of the service
`<namespace>/get_interactive_markers` has the number of the last update that it includes, and every
update on `<namespace>/update` has the next number. After a gap the client asks again.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import CancelledError, Future
from typing import Literal

import msgspec

from webviz import Error, Level, Status
from webviz.api.connection import GraphConnection, ReceivedMessages
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
SLOW_BYTES = 50_000
"""Larger messages are read in a worker, as they take more than 10 ms."""
ANSWER_S = 5.0
"""Time in seconds for the server to answer."""
PAUSE_S = 0.5
"""Pause in seconds between two requests."""
MAX_WAITING = 1000
"""Updates that wait, such as while the server is asked."""
MAX_WAITING_BYTES = 64_000_000

State = Literal["searching", "asking", "reading", "running"]


class Client(msgspec.Struct):
    """Follows one server.

    Args:
        namespace: of the server, without a slash at the end.
    """

    namespace: str
    state: State = "searching"
    sequence: int = 0
    """Number of the last update that was applied."""
    problem: str = ""
    """Reason why it had to ask again, or could not, a sentence."""
    gaps: int = 0
    """Number of gaps in the sequence of updates."""
    _received: ReceivedMessages = msgspec.field(default_factory=ReceivedMessages)
    _answer: Future[bytes] | None = None
    _reading: Future[ServerMessage] | None = None
    """The answer or the first update; those after it wait, as their order matters."""
    _next_s: float = 0.0
    _waiting: deque[bytes] = msgspec.field(default_factory=deque)
    """Updates that are not read yet."""
    _early: int = 0
    """Number of waiting updates that came before the answer, which may include them."""
    _is_early: bool = False
    """True if the update that is being read is one of these."""

    def step(self, connection: GraphConnection) -> list[News]:
        """Take up what has happened since the last call; what changed, in order.

        Raises:
            ValueError: the namespace is invalid; one sentence.
        """
        before = self._received.endpoints
        received = self._received = connection.listen(f"{self.namespace}/update", UPDATE, DEPTH)
        # In both cases the server may have been started again.
        if received.has_gap or received.endpoints != before:
            self._restart()
        self._waiting += received.messages
        if received.is_recorded:
            self._restart()
            self.problem = f"The bag has updates of {self.namespace}, but not its service, which "
            self.problem += "has the markers. Connect to the live server to see them."
            return [News(is_all=True)] if before - received.endpoints else []
        if not received.publishers:
            self._restart()
            return [News(is_all=True)] if before else []
        if len(self._waiting) > MAX_WAITING or sum(map(len, self._waiting)) > MAX_WAITING_BYTES:
            self._restart()
        if self.state == "searching" and received.is_ready and connection.clock_s >= self._next_s:
            self._ask(connection.query)
            self._next_s = connection.clock_s + PAUSE_S
        news = self._take_answer(connection) if self.state in ("asking", "reading") else []
        if self.state == "running":
            news += self._follow(connection)
        return news

    def status(self, count: int) -> Status:
        """Return the status of the connection, given the number of markers."""
        service, publishers = f"{self.namespace}/get_interactive_markers", self._received.publishers
        if not publishers:
            text = f"No interactive marker server at {self.namespace}. Start it, or choose another."
            return Status(Level.WARN, text)
        if len(publishers) > 1:
            return Status(
                Level.WARN,
                f"{len(publishers)} servers share {self.namespace}: {', '.join(publishers)}. "
                "Their updates contradict each other. Give each a namespace of its own.",
            )
        if self.state == "reading":
            return Status(Level.WARN, f"Loading the markers of {self.namespace}.")
        if self.state == "running" and not self.problem:
            markers = f"{count} marker{'s' * (count != 1)}"
            gaps = f"; requested again after {self.gaps} gaps in the updates" if self.gaps else ""
            return Status(Level.OK, f"Connected to {self.namespace}, {markers}{gaps}.")
        return Status(Level.WARN, self.problem or f"Waiting for the answer of {service}.")

    def _restart(self) -> None:
        self.state, self._answer = "searching", None
        self._waiting.clear()
        if self._reading is not None:
            self._reading.cancel()
            self._reading = None

    def _ask(self, query: Callable[[str, str, float], Future[bytes]]) -> None:
        self.state = "asking"
        self._answer = query(f"{self.namespace}/get_interactive_markers", SERVICE, ANSWER_S)

    def _take_answer(self, connection: GraphConnection) -> list[News]:
        try:
            if self._answer is not None and self._answer.done():
                self.state, answer, self._answer = "reading", self._answer, None
                self._reading = _started(read_answer, answer.result(), connection)
            message = self._read()
        except (Error, MessageError, CancelledError) as error:
            self._restart()
            self.problem, self._next_s = str(error), connection.clock_s + PAUSE_S
            return []
        if message is None:
            return []
        self.state, self.problem = "running", ""
        self.sequence, self._early = message.number, len(self._waiting)
        return [message.news] if message.news else []

    def _follow(self, connection: GraphConnection) -> list[News]:
        """Apply the updates that wait, in order, until one is still being read."""
        news: list[News] = []
        while True:
            if self._reading is None and self._waiting:
                self._reading = _started(read_update, self._waiting.popleft(), connection)
                self._is_early, self._early = self._early > 0, max(0, self._early - 1)
            try:
                update = self._read()
            except (MessageError, CancelledError) as error:  # makes a gap
                self.problem = joined(f"An update cannot be read: {error}", "Correct the server.")
                continue
            if update is None:
                return news
            if update.news is None or (self._is_early and update.number <= self.sequence):
                continue
            if update.number != self.sequence + 1:
                self.gaps += 1
                self.problem = (
                    f"Update {update.number} came instead of {self.sequence + 1}. Asking again."
                )
                self._restart()
                connection.wake()
                return news
            self.sequence += 1
            self.problem = ""
            news.append(update.news)

    def _read(self) -> ServerMessage | None:
        """Return the message that is being read, once it is.

        Raises:
            MessageError: it cannot be decoded; one sentence.
            CancelledError: the display was hidden meanwhile.
        """
        if self._reading is None or not self._reading.done():
            return None
        future, self._reading = self._reading, None
        return future.result()


def _started(
    read: Callable[[bytes], ServerMessage], cdr: bytes, connection: GraphConnection
) -> Future[ServerMessage]:
    """Read a message, a large one in a worker."""
    if len(cdr) >= SLOW_BYTES:
        return connection.run(read, cdr)
    future: Future[ServerMessage] = Future()
    try:
        future.set_result(read(cdr))
    except MessageError as error:
        future.set_exception(error)
    return future

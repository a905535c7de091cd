"""The client of an interactive marker server: asks for all markers, then follows its updates.

The protocol is that of the package interactive_markers in ROS 2: the answer of the service
`<namespace>/get_interactive_markers` has the number of the last update that it includes, and every
update on `<namespace>/update` has the next number. After a gap the client asks again.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import CancelledError, Future
from dataclasses import dataclass, field
from typing import Any, Literal

from webviz import Error, Level, Status
from webviz.api.wire import Heard, Wire
from webviz.data.messages import MessageError, decode
from webviz.data.words import joined

SERVICE = "visualization_msgs/srv/GetInteractiveMarkers"
UPDATE = "visualization_msgs/msg/InteractiveMarkerUpdate"
DEPTH = 100
KEEP_ALIVE = 0
ANSWER_S = 5.0
"""For the server to answer."""
PAUSE_S = 0.5
"""Between two requests."""
MAX_WAITING = 1000
"""Updates that arrive while the server is asked."""

State = Literal["searching", "asking", "running"]


@dataclass(frozen=True)
class News:
    """Changes on a server.

    Args:
        markers: new or changed ones, visualization_msgs/InteractiveMarker.
        poses: new poses, visualization_msgs/InteractiveMarkerPose.
        erased: names of markers that are gone.
        is_all: whether these are all markers.
    """

    markers: Sequence[Any] = ()
    poses: Sequence[Any] = ()
    erased: Sequence[str] = ()
    is_all: bool = False


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
    _waiting: list[Any] = field(default_factory=list)

    def step(self, wire: Wire) -> list[News]:
        """Take up what has happened since the last call; what changed, in order.

        Raises:
            ValueError: the namespace is invalid; one sentence.
        """
        before = self._heard.endpoints
        heard = self._heard = wire.listen(f"{self.namespace}/update", UPDATE, DEPTH)
        if heard.has_gap or heard.endpoints != before:  # the server may have been started again
            self._restart()
        updates = self._decoded(heard.messages)
        if not heard.publishers:
            self._restart()
            return [News(is_all=True)] if before else []
        if self.state == "running":
            return self._follow(updates, wire)
        self._waiting += updates
        if len(self._waiting) > MAX_WAITING:
            self._restart()
        if self.state == "searching" and heard.is_ready and wire.clock_s >= self._next_s:
            self._ask(wire.query)
            self._next_s = wire.clock_s + PAUSE_S
        return self._take_answer(wire) if self.state == "asking" else []

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
        if self.state == "running":
            markers = f"{count} marker{'s' * (count != 1)}"
            gaps = f"; asked again after {self.gaps} gaps in the updates" if self.gaps else ""
            return Status(Level.OK, f"Connected to {self.namespace}, {markers}{gaps}.")
        return Status(Level.WARN, self.problem or f"Waiting for the answer of {service}.")

    def _restart(self) -> None:
        self.state, self._answer, self._waiting = "searching", None, []

    def _ask(self, query: Callable[[str, str, float], Future[bytes]]) -> None:
        self.state = "asking"
        self._answer = query(f"{self.namespace}/get_interactive_markers", SERVICE, ANSWER_S)

    def _take_answer(self, wire: Wire) -> list[News]:
        if self._answer is None or not self._answer.done():
            return []
        try:
            answer = decode(f"{SERVICE}_Response", self._answer.result())
        except (Error, MessageError, CancelledError) as error:
            self.state, self._answer, self.problem = "searching", None, str(error)
            self._next_s = wire.clock_s + PAUSE_S
            return []
        self.state, self.problem = "running", ""
        self.sequence = int(answer.sequence_number)
        waiting, self._waiting, self._answer = self._waiting, [], None
        late = [update for update in waiting if int(update.seq_num) > self.sequence]
        return [News(answer.markers, is_all=True), *self._follow(late, wire)]

    def _follow(self, updates: Sequence[Any], wire: Wire) -> list[News]:
        news = []
        for update in updates:
            if int(update.seq_num) != self.sequence + 1:
                self.gaps += 1
                self.problem = (
                    f"Update {update.seq_num} came instead of {self.sequence + 1}. Asking again."
                )
                self._restart()
                wire.wake()
                break
            self.sequence += 1
            news.append(News(update.markers, update.poses, update.erases))
        return news

    def _decoded(self, messages: Sequence[bytes]) -> list[Any]:
        """The updates among messages; one that cannot be read makes a gap."""
        updates = []
        for cdr in messages:
            try:
                update = decode(UPDATE, cdr)
            except MessageError as error:
                self.problem = joined(f"An update cannot be read: {error}", "Correct the server.")
                continue
            if update.type != KEEP_ALIVE:
                updates.append(update)
        return updates

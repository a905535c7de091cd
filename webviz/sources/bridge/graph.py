"""Output through a bridge: publishing and service calls."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Collection, Mapping
from concurrent.futures import Future
from typing import Protocol, TypeVar

from webviz.api.errors import Error
from webviz.sources.bridge.session import BridgeSession
from webviz.sources.graph import Advertisement, Goal, NotConnected

NO_ACTIONS = (
    "Actions do not pass the bridge. Use a tool that publishes, such as 2D Goal Pose on "
    "/goal_pose, or start webviz with ROS instead of --connect."
)
FETCH_TIMEOUT_S = 30.0
T = TypeVar("T")


class BridgeLink(Protocol):
    """The part of the source that the graph uses."""

    @property
    def session(self) -> BridgeSession:
        """The open session, in the thread of the connection; raises NotConnected."""
        ...

    def require_fresh(self) -> None:
        """Raise NotConnected if what is sent now would arrive late."""
        ...

    def soon(self, do: Callable[[], None]) -> bool:
        """Call `do` in the thread of the connection; whether there still is one."""
        ...

    @property
    def nodes(self) -> tuple[str, ...]:
        """Full names of the nodes, sorted."""
        ...


class BridgeGraph:
    """Publishes and calls services through a bridge; see `webviz.sources.Graph`.

    Args:
        line: to the bridge.
    """

    def __init__(self, line: BridgeLink) -> None:
        self._line = line
        self._advertised: frozenset[Advertisement] = frozenset()

    def advertise(self, advertisements: Collection[Advertisement]) -> Future[None]:
        """Make the advertised publishers exactly these; anew after the link was broken."""
        self._advertised = frozen = frozenset(advertisements)
        return self._do(lambda: self._line.session.advertise(frozen))

    def readvertise(self, session: BridgeSession) -> None:
        """Advertise in a new session what was in the last one."""
        if self._advertised:
            session.advertise(self._advertised)

    def publish(self, advertisement: Advertisement, cdr: bytes) -> Future[int]:
        """Publish a message unless it would be late; the number of subscriptions if known."""

        def publish() -> int:
            self._line.require_fresh()
            return self._line.session.publish(advertisement, cdr)

        return self._do(publish)

    def call(self, service: str, type: str, request: bytes, timeout_s: float) -> Future[bytes]:
        """Call a service; the serialised response."""
        return self._ask(
            lambda session, answer: session.call(service, type, request, answer),
            timeout_s,
            f"{service} does not answer within {timeout_s:g} s.",
        )

    def fetch(self, uri: str) -> Future[bytes]:
        """Fetch a file of the robot, such as package://robot/meshes/arm.stl."""
        return self._ask(
            lambda session, answer: session.fetch(uri, answer),
            FETCH_TIMEOUT_S,
            f"The bridge does not send {uri} within {FETCH_TIMEOUT_S:g} s.",
        )

    def send_goal(
        self, action: str, type: str, goal: bytes, feedback: Callable[[bytes], object]
    ) -> Goal:
        """Refuse: actions do not pass a bridge."""
        accepted: Future[bool] = Future()
        result: Future[tuple[int, bytes]] = Future()
        cancelled: Future[int] = Future()
        for future in (accepted, result, cancelled):
            future.set_exception(NotConnected(NO_ACTIONS))
        return Goal(b"", accepted, result, lambda: cancelled)

    def nodes(self) -> tuple[str, ...]:
        """Full names of the nodes of the graph, sorted."""
        return self._line.nodes

    def services(self) -> Mapping[str, str]:
        """None: bridges are only asked for what is called."""
        return {}

    def _ask(
        self,
        ask: Callable[[BridgeSession, Future[bytes]], None],
        timeout_s: float,
        late: str,
    ) -> Future[bytes]:
        """Send a request; its answer, which fails after a while."""
        answer: Future[bytes] = Future()

        def expire() -> None:
            if not answer.done():
                answer.set_exception(NotConnected(late))
            self._forget(answer)

        def start() -> None:
            try:
                ask(self._line.session, answer)
            except Error as error:
                answer.set_exception(error)
            else:
                asyncio.get_running_loop().call_later(timeout_s, expire)

        if not self._line.soon(start):
            answer.set_exception(NotConnected("The viewer has ended."))
        return answer

    def _forget(self, answer: Future[bytes]) -> None:
        try:
            self._line.session.forget(answer)
        except NotConnected:
            return

    def _do(self, do: Callable[[], T]) -> Future[T]:
        """Call `do` in the thread of the connection."""
        future: Future[T] = Future()

        def run() -> None:
            if not future.set_running_or_notify_cancel():
                return
            try:
                future.set_result(do())
            except Exception as error:
                future.set_exception(error)

        if not self._line.soon(run):
            future.set_exception(NotConnected("The viewer has ended."))
        return future

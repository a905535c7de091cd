"""A viewer on an isolated ROS domain, as `webviz` runs it."""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, TypeVar

from webviz.files.config import Config
from webviz.shell.testing.pictures import SnapshotFixture
from webviz.shell.testing.recording import RecordingScene
from webviz.shell.testing.viewer_under_test import ViewerUnderTest
from webviz.shell.testing.watched import WatchedViewer
from webviz.sources import Inbox, Raw

__tracebackhide__ = True  # failures are shown where the test calls

if TYPE_CHECKING:
    from webviz.ros.node import RosSource

T = TypeVar("T")

PATIENCE_S = 30.0
"""Far more than DDS and the frame loop need on an idle machine."""
LOADING_S = 60.0
"""Time in seconds for the meshes of large robots."""


class _WatchedInbox(Inbox):
    """An inbox that knows which expected messages have not arrived."""

    def __init__(self) -> None:
        super().__init__()
        self._expected: dict[str, list[bytes]] = {}

    def expect(self, topic: str, cdr: bytes) -> None:
        self._expected.setdefault(topic, []).append(cdr)

    def put(self, topic: str, raw: Raw) -> None:
        super().put(topic, raw)
        expected = self._expected.get(topic, [])
        if raw.cdr in expected:
            expected.remove(raw.cdr)

    def missing(self) -> list[str]:
        """Return the topics with expected messages that have not arrived."""
        return [topic for topic, expected in self._expected.items() if expected]


class LiveViewer(ViewerUnderTest):
    """A viewer whose frame loop runs in a thread, on real ROS.

    Args:
        config: to show.
        scene: to draw in.
        snapshot: takes pictures of the scene.
        domain: ROS domain.
        simulator: parameters of a simulated robot; None for no robot.
    """

    def __init__(
        self,
        config: Config,
        scene: RecordingScene,
        snapshot: SnapshotFixture,
        domain: int,
        simulator: Mapping[str, Any] | None = None,
    ) -> None:
        from webviz.ros.node import RosSource
        from webviz.ros.publisher_node import PublisherNode

        self._inbox = _WatchedInbox()
        self._crash: BaseException | None = None
        with contextlib.ExitStack() as stack:
            if simulator is not None:
                stack.enter_context(_simulator(simulator, domain))
            self._publisher_node = PublisherNode("webviz_test", domain)
            stack.callback(self._publisher_node.close)
            self.source: RosSource = RosSource(domain_id=domain)
            stack.callback(self.source.close)
            self.source.inbox = self._inbox
            super().__init__(WatchedViewer(config, self.source, scene), scene, snapshot)
            self._thread = threading.Thread(target=self._run, name="webviz-viewer", daemon=True)
            stack.callback(self._thread.join)
            stack.callback(self.viewer.stop)
            self._thread.start()
            self._catch_up()
            self._close = stack.pop_all().close

    def close(self) -> None:
        """End all threads and processes."""
        self._close()

    def publish_bytes(
        self, topic: str, type_name: str, cdr: bytes, *, latched: bool | None = None
    ) -> None:
        """Publish a serialised message.

        If a display subscribes to the topic, this waits for the connection first, so that the
        message is not lost.

        Args:
            topic: full name.
            type_name: such as "sensor_msgs/msg/LaserScan".
            cdr: serialised message with encapsulation header.
            latched: publish with transient local durability; None for /tf_static only.
        """
        is_latched = topic == "/tf_static" if latched is None else latched
        publisher = self._publisher_node.open(topic, type_name, is_latched)
        subscription = self.viewer.subscriptions().get(topic)
        if subscription is not None and subscription.type == type_name:
            self.wait_for(
                lambda: self._is_connected(topic, type_name) and publisher.get_subscription_count(),
                lambda: f"The viewer does not receive {topic}: {self._offer_text(topic)}",
            )
            self._inbox.expect(topic, cdr)
        publisher.publish(cdr)

    def advertise(self, topic: str, type_name: str, *, latched: bool = False) -> None:
        """Make the publisher of a topic before its first message, as several at once are found."""
        self._publisher_node.open(topic, type_name, latched)

    def now_ns(self) -> int:
        """ROS time."""
        return self.source.now_ns()

    def wait_for(
        self,
        condition: Callable[[], T],
        what: str | Callable[[], str] = "it",
        seconds: float = PATIENCE_S,
    ) -> T:
        """Wait until a condition holds after a turn of the frame loop, and return its value.

        Args:
            condition: checked after each turn.
            what: message of the error.
            seconds: to wait at most.

        Raises:
            AssertionError: it did not hold in time.
        """
        deadline = time.monotonic() + seconds
        while not (result := condition()):
            if time.monotonic() > deadline:
                text = what if isinstance(what, str) else what()
                raise AssertionError(f"Waited {seconds:g} s without success. {text}")
            self._turn()
        return result

    def wait_until_drawn(self, display: str, seconds: float = PATIENCE_S) -> None:
        """Wait until all published messages have arrived and a display has drawn the newest one.

        Raises:
            AssertionError: it takes too long; the message has the status of the display.
        """
        row = self._row(display)

        def is_drawn() -> bool:
            if self._inbox.missing():
                return False
            self._catch_up()  # messages that arrived may not have been handled
            return (
                not self.viewer.is_waiting(row.id)
                and not self.viewer.is_busy()
                and self.is_drawn(display)
            )

        def why_not() -> str:
            return self._missing() or f"{display} has not drawn it. {self.status(display).text}"

        self.wait_for(is_drawn, why_not, seconds)

    def settle(self) -> None:
        """Wait until all published messages are drawn, and all displays have loaded."""
        self.wait_for(lambda: not self._inbox.missing(), self._missing)
        self._catch_up()
        self.wait_for(lambda: not self.viewer.is_busy(), "A display is still loading.", LOADING_S)

    def _missing(self) -> str:
        missing = ", ".join(self._inbox.missing())
        return f"Messages published on {missing} have not arrived." if missing else ""

    def _catch_up(self) -> None:
        """Wait for a turn that starts after this call; the current one may have missed messages."""
        for _ in range(2):
            self._turn()

    def _turn(self) -> None:
        """Wait for the end of a turn."""
        with self.viewer.turned:
            turns = self.viewer.turns
            self._inbox.arrived.set()
            self.viewer.turned.wait_for(
                lambda: self.viewer.turns > turns or self._crash is not None, PATIENCE_S
            )
        if self._crash is not None:
            raise AssertionError(f"The viewer stopped: {self._crash}") from self._crash

    def _run(self) -> None:
        try:
            self.viewer.run()
        except BaseException as crash:
            with self.viewer.turned:
                self._crash = crash
                self.viewer.turned.notify_all()

    def _is_connected(self, topic: str, type_name: str) -> bool:
        """Return whether the subscription knows all its publishers, including the test's."""
        from webviz.ros.qos import adapt

        subscription = self.viewer.subscriptions().get(topic)
        offer = self.source.offers().get(topic)
        if subscription is None or offer is None:
            return False
        names = [publisher.node for publisher in offer.publishers if publisher.type == type_name]
        return self._publisher_node.name in names and offer.requested == adapt(
            subscription, offer.publishers
        )

    def _offer_text(self, topic: str) -> str:
        offer = self.source.offers().get(topic)
        return offer.problem or f"{offer}." if offer else "unknown topic."


@contextlib.contextmanager
def _simulator(parameters: Mapping[str, Any], domain: int) -> Iterator[None]:
    """Provide a simulated robot in its own process."""
    command = [sys.executable, "-m", "webviz_sim", "--ros-args"]
    for name, value in parameters.items():
        text = str(value).lower() if isinstance(value, bool) else str(value)
        command += ["-p", f"{name}:={text}"]
    process = subprocess.Popen(command, env={**os.environ, "ROS_DOMAIN_ID": str(domain)})
    try:
        yield
    finally:
        process.terminate()
        try:
            process.wait(timeout=10.0)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()

"""Bridges for tests: a real Foxglove server as a process, and a source that reads it."""

from __future__ import annotations

import contextlib
import json
import queue
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from processes import PATIENCE_S
from waiting import until

from webviz.api.bridge import Bridge
from webviz.api.declared import Topic
from webviz.data.messages import decode
from webviz.sources import Raw, Subscription
from webviz.sources.bridge.address import address
from webviz.sources.bridge.source import BridgeSource

SCAN = "sensor_msgs/msg/LaserScan"
STRING = "std_msgs/msg/String"
TF = "tf2_msgs/msg/TFMessage"


class FoxgloveServer:
    """A process with a server, see `foxglove_server.py`.

    Args:
        port: of the server, 0 for a free one.
        options: of the server.
    """

    def __init__(self, port: int = 0, *options: str) -> None:
        path = Path(__file__).parent / "foxglove_server.py"
        command = [sys.executable, str(path), str(port), *options]
        self._process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        self._lines: queue.Queue[dict[str, Any]] = queue.Queue()
        self._listening = threading.Thread(target=self._listen, daemon=True)
        self._listening.start()
        self.url: str = self.receive("url")
        self.port = int(self.url.rpartition(":")[2])

    def _listen(self) -> None:
        assert self._process.stdout
        with self._process.stdout as lines:
            for line in lines:
                self._lines.put(json.loads(line))

    def receive(self, key: str, value: Any = None) -> Any:
        """Wait until the server says something, and skip what comes before."""
        until = time.monotonic() + PATIENCE_S
        while True:
            fact = self._lines.get(timeout=until - time.monotonic())
            if key in fact and value in (None, fact[key]):
                return fact[key]

    def do(self, command: str) -> None:
        """Have the server carry out a command."""
        assert self._process.stdin
        print(command, file=self._process.stdin, flush=True)

    def signal(self, number: int) -> None:
        """Send a signal, such as SIGSTOP for a server that hangs."""
        self._process.send_signal(number)

    def kill(self) -> None:
        """End it at once."""
        self._process.send_signal(signal.SIGKILL)
        self._process.wait()
        self._listening.join()
        assert self._process.stdin
        with contextlib.suppress(BrokenPipeError):
            self._process.stdin.close()


@contextmanager
def foxglove_server(port: int = 0, *options: str) -> Iterator[FoxgloveServer]:
    """Run a server."""
    server = FoxgloveServer(port, *options)
    try:
        yield server
    finally:
        server.kill()


class BridgeReader:
    """A source that is connected to a bridge, and what arrived.

    Args:
        url: of the bridge.
    """

    def __init__(self, url: str, **options: Any) -> None:
        self.source = BridgeSource(address(url, **options))
        self.arrived: dict[str, list[Raw]] = {}

    @property
    def bridge(self) -> Bridge:
        (bridge,) = self.source.bridges
        return bridge

    def want(self, resubscriptions: int = 0, **types: str) -> None:
        """Subscribe to topics, named without their slash, by type."""
        self.source.want(
            {
                f"/{name}": Subscription(t, Topic(f"/{name}"), resubscriptions=resubscriptions)
                for name, t in types.items()
            }
        )

    def until(self, condition: Callable[[], object]) -> None:
        """Wait until a condition holds."""
        until(condition, lambda: (self.bridge, self.source.offers()))

    def until_up(self) -> None:
        """Wait until the bridge is connected, and its topics are known."""
        self.until(lambda: self.bridge.is_up and self.source.offers())

    def take(self, topic: str, count: int = 1) -> bool:
        """Take what is there, and return whether it is so many messages of a topic."""
        for name, raws in self.source.inbox.drain().items():
            self.arrived.setdefault(name, []).extend(raws)
        return len(self.arrived.get(topic, ())) >= count

    def receive(self, topic: str, count: int = 1) -> list[bytes]:
        """Wait for so many new messages of a topic."""
        self.arrived.pop(topic, None)
        self.until(lambda: self.take(topic, count))
        return [raw.cdr for raw in self.arrived[topic]]

    def decoded(self, topic: str, type: str) -> Any:
        """The next message of a topic."""
        self.receive(topic)
        raw = self.arrived[topic][0]
        return decode(type, raw.cdr, raw.types)


@contextmanager
def reading(url: str, **options: Any) -> Iterator[BridgeReader]:
    """Connect to a bridge."""
    reader = BridgeReader(url, **options)
    try:
        yield reader
    finally:
        reader.source.close()

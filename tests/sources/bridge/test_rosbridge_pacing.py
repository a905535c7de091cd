"""Large topics of rosbridge on a thin link: they rest by its `throttle_rate`, poses are in time."""

from __future__ import annotations

import asyncio
import contextlib
import json
import threading
import time
from collections.abc import Iterator
from typing import Any

import cbor2
import pytest
from bridges import reading
from slow_link import SlowLink
from websockets.asyncio.server import ServerConnection, serve
from websockets.exceptions import ConnectionClosed

from webviz.data.messages import definition, encode
from webviz.sources import Raw
from webviz.sources.bridge.rosbridge import AWAKE_MS, RESTING_MS

POSE = "geometry_msgs/msg/PoseStamped"
CLOUD = "sensor_msgs/msg/PointCloud2"
TYPES = {"/pose": POSE, "/points": CLOUD}
PERIODS_S = {"/pose": 0.05, "/points": 0.1}
CLOUD_BYTES = 60_000
RATE = 125e3
"""Bytes a second of the link: a fifth of what the clouds need."""


class Rosbridge:
    """A server with the part of rosbridge that matters here: it never drops, but throttles.

    As in its MessageHandler, the time between two messages is kept when that of a subscription
    changes, and a message that comes too soon is left out.
    """

    def __init__(self) -> None:
        self.counts: dict[str, int] = dict.fromkeys(TYPES, 0)
        self.throttles: list[tuple[str, int]] = []
        self._clients: dict[asyncio.Queue[Any], dict[str, list[float]]] = {}
        self._loop = asyncio.new_event_loop()
        self._ended = asyncio.Event()
        self._port: asyncio.Future[int] = self._loop.create_future()
        self._thread = threading.Thread(
            target=self._loop.run_until_complete, args=(self._run(),), daemon=True
        )
        self._thread.start()
        self.port = asyncio.run_coroutine_threadsafe(self._get_port(), self._loop).result(20)

    def close(self) -> None:
        self._loop.call_soon_threadsafe(self._ended.set)
        self._thread.join()
        self._loop.close()

    async def _get_port(self) -> int:
        return await self._port

    async def _run(self) -> None:
        async with serve(self._talk, "127.0.0.1", 0, compression=None, close_timeout=0.1) as server:
            self._port.set_result(next(iter(server.sockets)).getsockname()[1])
            tasks = [asyncio.ensure_future(self._publish(topic)) for topic in TYPES]
            await self._ended.wait()
            for task in tasks:
                task.cancel()

    async def _publish(self, topic: str) -> None:
        data = {"data": bytes(CLOUD_BYTES)} if topic == "/points" else {}
        while True:
            secs, nsecs = divmod(time.time_ns(), 1_000_000_000)
            cdr = encode(TYPES[topic], {"header": {"stamp": {"nanosec": nsecs}}, **data})
            inner = {"secs": secs, "nsecs": nsecs, "bytes": cdr}
            frame = cbor2.dumps({"op": "publish", "topic": topic, "msg": inner})
            for queue, topics in self._clients.items():
                if topic in topics and time.monotonic() - topics[topic][1] >= topics[topic][0]:
                    topics[topic][1] = time.monotonic()
                    self.counts[topic] += 1
                    queue.put_nowait(frame)
            await asyncio.sleep(PERIODS_S[topic])

    async def _talk(self, connection: ServerConnection) -> None:
        queue: asyncio.Queue[Any] = asyncio.Queue()
        topics = self._clients[queue] = {}
        sending = asyncio.ensure_future(self._send(connection, queue))
        try:
            with contextlib.suppress(ConnectionClosed):
                async for frame in connection:
                    self._take(json.loads(frame), queue, topics)
        finally:
            sending.cancel()
            del self._clients[queue]

    def _take(self, text: Any, queue: asyncio.Queue[Any], topics: dict[str, list[float]]) -> None:
        match text["op"]:
            case "subscribe":
                throttle_ms = text.get("throttle_rate", 0)
                self.throttles.append((text["topic"], throttle_ms))
                topics.setdefault(text["topic"], [0.0, 0.0])[0] = throttle_ms / 1e3
            case "unsubscribe":
                topics.pop(text["topic"], None)
            case "call_service":
                values = {
                    "topics": list(TYPES),
                    "types": list(TYPES.values()),
                    "typedefs_full_text": [definition(type) for type in TYPES.values()],
                    "nodes": [],
                    "services": [],
                }
                answer = {"op": "service_response", "id": text["id"], "result": True}
                queue.put_nowait(json.dumps({**answer, "values": values}))

    async def _send(self, connection: ServerConnection, queue: asyncio.Queue[Any]) -> None:
        while True:
            await connection.send(await queue.get())


@pytest.fixture
def rosbridge() -> Iterator[Rosbridge]:
    server = Rosbridge()
    yield server
    server.close()


def test_clouds_do_not_delay_poses(rosbridge: Rosbridge) -> None:
    link = SlowLink(rosbridge.port, rate=RATE, delay_s=0.02)
    received = dict.fromkeys(TYPES, 0)

    def note(topic: str, raw: Raw) -> None:
        received[topic] += 1

    try:
        with reading(f"ws://127.0.0.1:{link.get_port()}") as reader:
            reader.source.inbox.read_along(lambda: note)
            reader.until_up()
            reader.want(pose=POSE, points=CLOUD)
            reader.until(lambda: any("thins /points to" in r for r in reader.bridge.remarks))
            reader.until(lambda: received["/points"] >= 7)
            counts = dict(rosbridge.counts)
            late = counts["/pose"] - received["/pose"]
    finally:
        link.close()
    assert late * PERIODS_S["/pose"] < 2.0
    # Each was asked for: the others of this time rested at the server.
    assert counts["/points"] < counts["/pose"] / 4
    throttles = {topic: {t for name, t in rosbridge.throttles if name == topic} for topic in TYPES}
    assert throttles == {"/pose": {0}, "/points": {0, AWAKE_MS, RESTING_MS}}

"""Large messages over the connection of their own, from a real Foxglove server."""

from __future__ import annotations

import asyncio
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing

import foxglove  # pyright: ignore[reportMissingImports]
import numpy as np
from waiting import until
from websockets.asyncio.server import ServerConnection, serve

from webviz.api.declared import Topic
from webviz.data.messages import definition, encode
from webviz.sources import Subscription
from webviz.sources.bridge.address import address
from webviz.sources.bridge.bulk import BulkConnection
from webviz.sources.bridge.pacing import MAX_RATE, RateController
from webviz.sources.bridge.source import BridgeSource
from webviz.sources.bridge.talking import opened

CLOUD = "sensor_msgs/msg/PointCloud2"


def test_large_clouds_come_whole_over_loopback() -> None:
    """Its segments of 65 kB need more than a receive buffer of a few kB, which Wi-Fi is given."""
    context = foxglove.Context()
    server = foxglove.start_server(port=0, context=context)
    schema = foxglove.Schema(name=CLOUD, encoding="ros2msg", data=definition(CLOUD).encode())
    channel = foxglove.Channel("/points", message_encoding="cdr", schema=schema, context=context)
    noise = np.random.default_rng(1).integers(0, 256, 1_600_000, np.uint8)
    cloud = encode(CLOUD, {"data": noise})
    source = BridgeSource(address(f"ws://127.0.0.1:{server.port}"))
    source.want({"/points": Subscription(CLOUD, Topic("/points"))})
    received = 0

    def has_come() -> bool:
        nonlocal received
        channel.log(cloud)
        received += len(source.inbox.drain())
        return received >= 20

    with closing(source):
        until(has_come, lambda: f"{received} of 20 clouds")
    server.stop()


def test_large_messages_are_read_as_fast_as_the_link_is_thought_to_be() -> None:
    size, count = 50_000, 30

    async def send(connection: ServerConnection) -> None:
        for _ in range(count):
            await connection.send(bytes(size))
        await connection.wait_closed()

    async def seconds(rate: float) -> float:
        async with serve(send, "127.0.0.1", 0, compression=None) as server:
            port = next(iter(server.sockets)).getsockname()[1]
            async with opened(address(f"ws://127.0.0.1:{port}"), BulkConnection) as connection:
                connection.rate_controller = RateController()
                connection.rate_controller.rate = rate
                start_s = time.monotonic()
                for _ in range(count):
                    assert len(await connection.recv()) == size
                return time.monotonic() - start_s

    # In a thread of its own: that of the tests may have the loop of a browser.
    with ThreadPoolExecutor(1) as threads:
        slow_s, fast_s = (
            threads.submit(asyncio.run, seconds(rate)).result() for rate in (1e6, MAX_RATE)
        )
    assert slow_s > 1.2
    assert fast_s < slow_s / 2

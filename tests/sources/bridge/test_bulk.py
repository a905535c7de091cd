"""Large messages over the connection of their own, from a real Foxglove server."""

from __future__ import annotations

from contextlib import closing

import foxglove  # pyright: ignore[reportMissingImports]
import numpy as np
from waiting import until

from webviz.api.declared import Topic
from webviz.data.messages import definition, encode
from webviz.sources import Subscription
from webviz.sources.bridge.address import address
from webviz.sources.bridge.source import BridgeSource

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

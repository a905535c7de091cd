"""A bridge with foxglove-sdk: raw messages from DDS to a websocket, nothing decoded or drawn.

    python -m side_by_side.systems.foxglove TOPIC=TYPE...

All drawing is left to the browser, which gets whole messages with their definitions. Where
Foxglove's own bridge subscribes when a browser does, this one subscribes at once and sends the last
message of a latched topic again when a browser subscribes.
"""

from __future__ import annotations

import sys
from functools import partial

import foxglove
import rclpy
from foxglove.websocket import ChannelView, Client
from rclpy.node import Node

from side_by_side.systems.arguments import LATCHED, parsed
from side_by_side.systems.typed import STORE
from webviz.ros.types import message_class


class Bridge(foxglove.websocket.ServerListener):
    """A channel for each topic."""

    def __init__(self, node: Node, topics: dict[str, str]) -> None:
        self._channels = {topic: _channel(topic, kind) for topic, kind in topics.items()}
        self._latched: dict[str, bytes] = {}
        for topic, kind in topics.items():
            callback = partial(self._arrive, topic)
            qos = LATCHED.get(topic, 10)
            node.create_subscription(message_class(kind), topic, callback, qos, raw=True)

    def on_subscribe(self, client: Client, channel: ChannelView) -> None:
        """A browser joined."""
        if (last := self._latched.get(channel.topic)) is not None:
            self._channels[channel.topic].log(last)

    def _arrive(self, topic: str, cdr: bytes) -> None:
        if topic in LATCHED:
            self._latched[topic] = cdr
        self._channels[topic].log(cdr)


def _channel(topic: str, kind: str) -> foxglove.Channel:
    definition, _ = STORE.generate_msgdef(kind, ros_version=2)
    schema = foxglove.Schema(name=kind, encoding="ros2msg", data=definition.encode())
    return foxglove.Channel(topic, message_encoding="cdr", schema=schema)


def main(*topics: str) -> None:
    """Run until it is ended."""
    rclpy.init()
    node = Node("foxglove_bridge")
    bridge = Bridge(node, parsed(topics))
    server = foxglove.start_server(host="127.0.0.1", port=0, server_listener=bridge)
    print(f"ws://127.0.0.1:{server.port}", flush=True)
    rclpy.spin(node)


if __name__ == "__main__":
    main(*sys.argv[1:])

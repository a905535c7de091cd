"""Bags written by independent libraries."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from mcap.writer import CompressionType
from mcap.writer import Writer as McapWriter
from rosbags.interfaces import (
    Qos,
    QosDurability,
    QosHistory,
    QosLiveliness,
    QosReliability,
    QosTime,
)
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer

from webviz.data.messages import definition, encode, type_exists, type_hash
from webviz.shell.testing import SECOND
from webviz.shell.testing.messages import stamped_transform

TF = "tf2_msgs/msg/TFMessage"
START_NS = 1_700_000_000 * SECOND
"""Time in ns when every bag of a test begins."""


@dataclass
class Topic:
    """Publication settings of a topic of a bag."""

    type: str
    latched: bool = False
    best_effort: bool = False
    depth: int = 1
    definition: str = ""
    """.msg text of an unknown type."""


@dataclass
class Bag:
    """Bag to record: (seconds from the start, topic, values or bytes)."""

    topics: dict[str, Topic] = field(default_factory=dict)
    messages: list[tuple[float, str, Mapping[str, Any] | bytes]] = field(default_factory=list)

    def add(self, topic: str, type_name: str, **how: Any) -> None:
        self.topics[topic] = Topic(type_name, **how)

    def put(self, at_s: float, topic: str, values: Mapping[str, Any] | bytes) -> None:
        self.messages.append((at_s, topic, values))

    def transform(
        self, at_s: float, parent: str, child: str, x: float = 0.0, *, static: bool = False
    ) -> None:
        """Publish a transform along x, stamped with the time of recording."""
        topic = "/tf_static" if static else "/tf"
        self.topics.setdefault(topic, Topic(TF, latched=static))
        self.put(at_s, topic, {"transforms": [stamped(parent, child, START_NS + ns(at_s), x)]})

    def write(
        self,
        path: Path,
        storage: StoragePlugin = StoragePlugin.MCAP,
        compression: CompressionMode = CompressionMode.NONE,
    ) -> Path:
        """Write a rosbag2 folder."""
        writer = Writer(path, version=9, storage_plugin=storage)
        if compression is not CompressionMode.NONE:
            writer.set_compression(compression, CompressionFormat.ZSTD)
        with writer:
            connections = {
                name: writer.add_connection(
                    name,
                    topic.type,
                    offered_qos_profiles=[_qos(topic)],
                    **_definition(topic),
                )
                for name, topic in self.topics.items()
            }
            for stamp_ns, name, cdr in self._encoded():
                writer.write(connections[name], stamp_ns, cdr)
        return path

    def _encoded(self) -> Iterator[tuple[int, str, bytes]]:
        """Yield the messages in their order: when they were recorded, topic and content."""
        for at_s, name, values in sorted(self.messages, key=lambda message: message[0]):
            is_raw = isinstance(values, bytes)
            cdr = values if is_raw else encode(self.topics[name].type, values)
            yield START_NS + ns(at_s), name, cdr

    def write_file(self, path: Path) -> Path:
        """Write one MCAP file.

        rosbags describes each topic in YAML three times, which takes a hundred times as long.
        """
        with path.open("wb") as file:
            writer = McapWriter(file, compression=CompressionType.NONE)
            writer.start(profile="ros2")
            channels = {
                name: writer.register_channel(
                    name,
                    "cdr",
                    writer.register_schema(
                        topic.type,
                        "ros2msg",
                        (topic.definition or definition(topic.type)).encode(),
                    ),
                    {"offered_qos_profiles": _qos_text(topic)},
                )
                for name, topic in self.topics.items()
            }
            for stamp_ns, name, cdr in self._encoded():
                writer.add_message(channels[name], stamp_ns, cdr, stamp_ns)
            writer.finish()
        return path


def ns(seconds: float) -> int:
    return round(seconds * SECOND)


def stamped(parent: str, child: str, stamp_ns: int, x: float = 0.0) -> Mapping[str, Any]:
    """A geometry_msgs/TransformStamped."""
    return stamped_transform(parent, child, stamp_ns, (x, 0.0, 0.0))


def strings(*seconds: float, topic: str = "/words", **how: Any) -> Bag:
    """A bag of strings that say when they were recorded."""
    bag = Bag()
    bag.add(topic, "std_msgs/msg/String", **how)
    for at_s in seconds:
        bag.put(at_s, topic, {"data": f"{at_s:g}"})
    return bag


def files(folder: Path, ending: str) -> Iterable[Path]:
    """The recorded files of a folder."""
    return sorted(folder.glob(f"*{ending}"))


def _definition(topic: Topic) -> Mapping[str, Any]:
    if topic.definition or not type_exists(topic.type):
        return {"msgdef": topic.definition, "rihs01": f"RIHS01_{'0' * 64}"}
    return {"msgdef": definition(topic.type), "rihs01": type_hash(topic.type)}


def _qos_text(topic: Topic) -> str:
    reliability = "best_effort" if topic.best_effort else "reliable"
    durability = "transient_local" if topic.latched else "volatile"
    return f"- {{reliability: {reliability}, durability: {durability}, depth: {topic.depth}}}"


def _qos(topic: Topic) -> Qos:
    forever = QosTime(2147483647, 4294967295)
    return Qos(
        QosHistory.KEEP_LAST,
        topic.depth,
        QosReliability.BEST_EFFORT if topic.best_effort else QosReliability.RELIABLE,
        QosDurability.TRANSIENT_LOCAL if topic.latched else QosDurability.VOLATILE,
        forever,
        forever,
        QosLiveliness.AUTOMATIC,
        forever,
        False,
    )

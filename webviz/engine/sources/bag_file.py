"""A bag file: its channels, and its messages in the order of time."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass
from pathlib import Path, PurePath
from typing import NamedTuple

from rosbags.interfaces import Connection, MessageDefinitionFormat, QosDurability, QosReliability
from rosbags.rosbag2 import Reader
from ruamel.yaml import YAML

from webviz.api.errors import Error
from webviz.data.messages import MessageError, register, type_exists
from webviz.data.messages.typestore import full_name
from webviz.engine.sources import bag_qos
from webviz.engine.sources.source import Durability, Publisher, Reliability

FILES = (".mcap", ".db3")
INFORMATION = "rosbag2_bagfile_information"
KEEP_LAST = 1
"""Latched messages per publisher if the bag does not record the depth."""


class BagError(Error):
    """A bag cannot be read; one sentence with a remedy."""


class Recorded(NamedTuple):
    """One message of a bag."""

    topic: str
    type: str
    cdr: bytes
    stamp_ns: int


@dataclass(frozen=True)
class BagChannel:
    """Messages of one type on one topic.

    Args:
        topic: full name.
        type: three-part name.
        publishers: recorded QoS.
        depth: how many messages its publishers latch in total.
        definition: the .msg text of the type, "" if the bag has none.
        connection: of rosbags' reader.
    """

    topic: str
    type: str
    publishers: tuple[Publisher, ...]
    depth: int
    definition: str
    connection: Connection


class BagFile:
    """An mcap file, a db3 file or a rosbag2 folder, opened.

    Args:
        path: of the file or folder.

    Raises:
        BagError: it is missing, not a bag, damaged or empty.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.channels: tuple[BagChannel, ...] = ()
        self.skipped: dict[str, str] = {}
        """Why the messages of a topic cannot be read, by topic."""
        self.remark = ""
        """A warning, "" for none."""
        self._reader = self._open()
        if not self._reader.message_count:
            self.close()
            raise BagError(f"{path} contains no messages. Record it again or choose another bag.")
        self.start_ns = self._reader.start_time
        self.end_ns = self._reader.end_time - 1
        """Stamps of the first and the last message."""
        self._look()

    def messages(
        self, channels: Collection[BagChannel], start_ns: int, end_ns: int | None = None
    ) -> Iterator[Recorded]:
        """The messages of channels by time of recording, both ends included.

        Raises:
            BagError: the bag is damaged; the messages before are delivered.
        """
        if not channels:
            return  # rosbags would deliver all channels
        by_id = {channel.connection.id: channel for channel in channels}
        connections = [channel.connection for channel in channels]
        stop_ns = None if end_ns is None else end_ns + 1
        try:
            for connection, stamp_ns, cdr in self._reader.messages(connections, start_ns, stop_ns):
                channel = by_id[connection.id]
                yield Recorded(channel.topic, channel.type, cdr, stamp_ns)
        except Exception as error:  # of SQLite, of both compressions, of the struct module ...
            raise BagError(self._complaint(error)) from error

    def close(self) -> None:
        """Close the file."""
        self._reader.close()

    def _open(self) -> Reader:
        path = self.path
        if not path.exists():
            raise BagError(f"Bag {path} not found. Give an MCAP or db3 file, or a rosbag2 folder.")
        if path.suffix == ".bag":
            raise BagError(
                f"{path} is a ROS 1 bag: convert it with `rosbags-convert --src {path} "
                f"--dst {path.stem}`, and give that folder."
            )
        if path.is_dir() and not (path / "metadata.yaml").exists():
            raise BagError(
                f"{path} has no metadata.yaml: run `ros2 bag reindex {path}`, or give one of the "
                "files in it."
            )
        if path.is_file() and path.suffix not in FILES:
            raise BagError(f"{path} is not a bag. Give an .mcap or .db3 file, or a rosbag2 folder.")
        bag_qos.be_lenient()
        try:
            reader = Reader(self._renamed_file() or path)
            reader.open()
        except Exception as error:  # see `messages`
            raise BagError(self._complaint(error)) from error
        return reader

    def _renamed_file(self) -> Path | None:
        """The only file of a folder if metadata.yaml misnames it, which rosbags rejects."""
        if not self.path.is_dir():
            return None
        try:
            information = YAML(typ="safe").load(self.path / "metadata.yaml")[INFORMATION]
            named = [PurePath(name).name for name in information["relative_file_paths"]]
            is_plain = not information.get("compression_mode")  # else rosbags needs the metadata
        except Exception:  # rosbags reports it
            return None
        files = [file for file in self.path.iterdir() if file.suffix in FILES]
        if not is_plain or len(files) != 1 or len(named) != 1 or (self.path / named[0]).exists():
            return None
        self.remark = f"{named[0]}, named by metadata.yaml, is missing. Reading {files[0].name}."
        return files[0]

    def _complaint(self, error: Exception) -> str:
        reason = " ".join(str(error).split()).rstrip(".") or type(error).__name__
        if isinstance(error, OSError):
            return f"Cannot read {self.path}: {error.strerror or reason}."
        if "Profile is not ros2" in reason:
            return f"{self.path} was not recorded by ROS 2: give a bag of `ros2 bag record`."
        remedy = "recover it with `ros2 bag convert`"
        if self.path.suffix == ".mcap":
            remedy = f"recover it with `mcap recover {self.path} -o recovered.mcap`"
        elif self.path.suffix == ".db3":
            remedy = f"recover it with `sqlite3 {self.path} .recover | sqlite3 recovered.db3`"
        elif "metadata" in reason.lower() or "missing" in reason.lower():
            remedy = f"run `ros2 bag reindex {self.path}`"
        return f"{self.path} is damaged or cut off ({reason}): {remedy}."

    def _look(self) -> None:
        channels = []
        for connection in self._reader.connections:
            reason = _obstacle(connection)
            if reason:
                self.skipped[connection.topic] = reason
            else:
                channels.append(_channel(connection, f"the bag {self.path.name}"))
        self.channels = tuple(channels)


def _obstacle(connection: Connection) -> str:
    """Why the messages of a connection cannot be read, "" if they can; registers their type."""
    encoding = getattr(connection.ext, "serialization_format", "cdr")
    if encoding != "cdr":
        return f"its messages are encoded as {encoding}, not as CDR"
    if connection.msgtype.endswith("_Event") and "/srv/" in connection.msgtype:
        return "service events are unsupported"
    if type_exists(connection.msgtype):
        return ""
    definition = connection.msgdef
    if definition.format is not MessageDefinitionFormat.MSG or not definition.data.strip():
        return f"{connection.msgtype} is unknown, and the bag has no .msg definition of it"
    try:
        register(connection.msgtype, definition.data)
    except MessageError as error:
        return str(error).rstrip(".")
    return ""


def _channel(connection: Connection, who: str) -> BagChannel:
    type_name = full_name(connection.msgtype)
    profiles = getattr(connection.ext, "offered_qos_profiles", [])
    publishers = []
    for profile in profiles:
        is_best_effort = profile.reliability is QosReliability.BEST_EFFORT
        is_latched = profile.durability is QosDurability.TRANSIENT_LOCAL
        reliability: Reliability = "best_effort" if is_best_effort else "reliable"
        durability: Durability = "transient_local" if is_latched else "volatile"
        publishers.append(Publisher(who, type_name, reliability, durability))
    is_msg = connection.msgdef.format is MessageDefinitionFormat.MSG
    return BagChannel(
        connection.topic,
        type_name,
        tuple(publishers) or (Publisher(who, type_name, "reliable", "volatile"),),
        sum(max(profile.depth, KEEP_LAST) for profile in profiles) or KEEP_LAST,
        connection.msgdef.data if is_msg else "",
        connection,
    )

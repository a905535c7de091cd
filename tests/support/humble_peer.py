"""A robot that speaks as ROS 2 Humble does, by Eclipse Cyclone DDS, without ROS.

Run by an environment that has `cyclonedds`. Humble announces no type hashes, writes `enclave` into
its participant's user data, and its records of nodes have identifiers of 24 bytes, not 16.
"""

import sys
import time
from dataclasses import dataclass
from typing import Any

from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import array, float32, int32, sequence, uint8, uint32
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

GID = 24
RELIABLE = Policy.Reliability.Reliable(duration(seconds=1))
LATCHED = Qos(RELIABLE, Policy.Durability.TransientLocal, Policy.History.KeepLast(1))
USUAL = Qos(RELIABLE, Policy.Durability.Volatile, Policy.History.KeepLast(10))


def named(package: str, kind: str, name: str) -> dict[str, str]:
    return {"typename": f"{package}::{kind}::dds_::{name}_"}


@dataclass
class StringMessage(IdlStruct, **named("std_msgs", "msg", "String")):
    data: str


@dataclass
class Stamp(IdlStruct, **named("builtin_interfaces", "msg", "Time")):
    sec: int32
    nanosec: uint32


@dataclass
class Head(IdlStruct, **named("std_msgs", "msg", "Header")):
    stamp: Stamp
    frame_id: str


@dataclass
class RangeMessage(IdlStruct, **named("sensor_msgs", "msg", "Range")):
    """Range of Humble, without `variance`, which Iron added."""

    header: Head
    radiation_type: uint8
    field_of_view: float32
    min_range: float32
    max_range: float32
    range: float32


@dataclass
class Ask(IdlStruct, **named("std_srvs", "srv", "SetBool_Request")):
    data: bool


@dataclass
class Reply(IdlStruct, **named("std_srvs", "srv", "SetBool_Response")):
    success: bool
    message: str


@dataclass
class Gid(IdlStruct, **named("rmw_dds_common", "msg", "Gid")):
    data: array[uint8, GID]


@dataclass
class NodeRecord(IdlStruct, **named("rmw_dds_common", "msg", "NodeEntitiesInfo")):
    node_namespace: str
    node_name: str
    reader_gid_seq: sequence[Gid]
    writer_gid_seq: sequence[Gid]


@dataclass
class ParticipantRecord(IdlStruct, **named("rmw_dds_common", "msg", "ParticipantEntitiesInfo")):
    gid: Gid
    node_entities_info_seq: sequence[NodeRecord]


def gid(entity: Any) -> Gid:
    return Gid(data=list(entity.guid.bytes.ljust(GID, b"\0")))


def main(domain: int, seconds: float) -> None:
    participant = DomainParticipant(domain, qos=Qos(Policy.Userdata(b"enclave=/;")))

    def writer(name: str, kind: Any, qos: Qos = USUAL) -> DataWriter:
        return DataWriter(participant, Topic(participant, name, kind), qos=qos)

    def reader(name: str, kind: Any) -> DataReader:
        return DataReader(participant, Topic(participant, name, kind), qos=USUAL)

    text, latched = (
        writer("rt/humble_text", StringMessage),
        writer("rt/humble_latched", StringMessage, LATCHED),
    )
    sonar = writer("rt/humble_range", RangeMessage)
    messages, requests = (
        reader("rt/to_humble", StringMessage),
        reader("rq/humble_switchRequest", Ask),
    )
    replies = writer("rr/humble_switchReply", Reply)
    records = writer("ros_discovery_info", ParticipantRecord, LATCHED)
    node = NodeRecord(
        "/",
        "humble_robot",
        [gid(each) for each in (messages, requests)],
        [gid(each) for each in (text, latched, sonar, replies)],
    )
    records.write(ParticipantRecord(gid(participant), [node]))
    latched.write(StringMessage("latched"))
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        text.write(StringMessage("moving"))
        now = time.time_ns()
        head = Head(Stamp(now // 10**9, now % 10**9), "sonar")
        sonar.write(RangeMessage(head, 0, 0.5, 0.25, 4.0, 2.0))
        for message in messages.take(N=10):
            print("heard", message.data, flush=True)
        time.sleep(0.1)


if __name__ == "__main__":
    main(int(sys.argv[1]), float(sys.argv[2]))

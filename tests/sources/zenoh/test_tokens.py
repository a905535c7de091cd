"""Keys, tokens, QoS and attachments, against an independent implementation and hostile ones."""

from __future__ import annotations

import struct

import pamoja.ros2 as pamoja
import pytest
import xxhash
import zenoh
from hypothesis import given
from hypothesis import strategies as st
from zenoh_robot import robot_attachment, robot_token

from webviz.data.messages import type_hash
from webviz.sources.names import MAX_NAME
from webviz.sources.zenoh.attachment import Attachment, gid_of, read_attachment, write_attachment
from webviz.sources.zenoh.qos import TokenQos, read_dds_qos, read_qos, write_qos
from webviz.sources.zenoh.tokens import (
    MAX_TOKEN,
    GraphEntity,
    LivelinessError,
    data_key,
    dds_type,
    read_token,
    ros_type,
    write_token,
)

STRING = "std_msgs/msg/String"
HASH = "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18"
ZID = "95b2937347d7c20ed50d77aa920afa25"


@pytest.mark.parametrize(
    ("topic", "type"),
    [
        ("/chatter", STRING),
        ("/robot1/front/scan", "sensor_msgs/msg/LaserScan"),
        ("/base/set_parameters", "rcl_interfaces/srv/SetParameters"),
        ("/spin/_action/send_goal", "nav2_msgs/action/Spin_SendGoal"),
    ],
)
@pytest.mark.parametrize("domain", [0, 42])
def test_keys_are_those_of_another_implementation(topic: str, type: str, domain: int) -> None:
    assert dds_type(type) == pamoja.dds_type_name(type)
    assert ros_type(dds_type(type)) == type
    assert data_key(domain, topic, type, HASH) == pamoja.entity_key(domain, topic, type, HASH)
    assert zenoh.KeyExpr(data_key(domain, topic, type, "*")).includes(
        data_key(domain, topic, type, HASH)
    )


def test_the_hash_of_a_type_has_the_digest_that_others_read() -> None:
    assert type_hash(STRING) == HASH
    digest = pamoja.type_hash_digest(HASH)
    assert digest is not None
    assert bytes(digest).hex() == HASH.removeprefix("RIHS01_")


def test_reads_a_publisher_that_a_robot_declares() -> None:
    token = robot_token(0, ZID, "MP", "/ns", "talker", "/ns/chatter", STRING, HASH, "2:1:,7:,:,:,,")
    assert "%ns%chatter/std_msgs::msg::dds_::String_/" in token
    entity = read_token(token)
    key = pamoja.entity_key(0, "/ns/chatter", STRING, HASH)
    assert key is not None
    assert entity == GraphEntity(
        "publisher",
        "/ns/talker",
        "/ns/chatter",
        STRING,
        key,
        TokenQos("best_effort", "transient_local", 7),
        ZID,
        False,
        HASH,
    )


def test_reads_a_node_without_namespace() -> None:
    entity = read_token(f"@ros2_lv/0/{ZID}/0/0/NN/%/%/talker")
    assert entity == GraphEntity("node", "/talker", session=ZID)


def test_humble_has_no_hash() -> None:
    token = robot_token(0, ZID, "MP", "", "n", "/a", STRING, "TypeHashNotSupported", "::,:,:,:,,")
    entity = read_token(token)
    assert entity is not None
    assert entity.key == "0/a/std_msgs::msg::dds_::String_/TypeHashNotSupported"


def test_writes_the_tokens_a_robot_writes() -> None:
    entity = GraphEntity("subscription", "", "/ns/scan", STRING, hash=HASH)
    qos = write_qos("best_effort", "volatile", 5)
    own = write_token(3, ZID, (0, 9), "/webviz", entity, qos)
    assert own == robot_token(3, ZID, "MS", "", "webviz", "/ns/scan", STRING, HASH, qos, ids=(0, 9))
    assert pamoja.percent_mangle("/ns/scan") in own.split("/")
    read = read_token(own)
    assert read is not None
    assert (read.node, read.name, read.qos.depth) == ("/webviz", "/ns/scan", 5)
    assert read.qos.reliability == "best_effort"
    node = write_token(3, ZID, (0, 0), "/a/webviz", GraphEntity("node", ""))
    assert node == f"@ros2_lv/3/{ZID}/0/0/NN/%/%a/webviz"


def test_reads_zenoh_bridge_ros2dds() -> None:
    entity = read_token(f"@/{ZID}/@ros2_lv/MP/robot1§scan/sensor_msgs§msg§LaserScan/:0:1:0,5")
    assert entity == GraphEntity(
        "publisher",
        "",
        "/robot1/scan",
        "sensor_msgs/msg/LaserScan",
        "robot1/scan",
        TokenQos("best_effort", "transient_local", 5),
        ZID,
        True,
    )
    assert read_token(f"@/{ZID}/@ros2_lv") == GraphEntity(
        "bridge", "", session=ZID, is_bridged=True
    )
    action = read_token(f"@/{ZID}/@ros2_lv/AS/spin/nav2_msgs§action§Spin")
    assert action is not None
    assert (action.kind, action.name, action.type) == ("action", "/spin", "nav2_msgs/action/Spin")


@pytest.mark.parametrize(
    "token",
    [
        "",
        "@ros2_lv",
        "@ros2_lv/0/z/0/0/NN/%/%/",
        "@ros2_lv/0/z/0/0/NN/%/%/<img src=x>",
        "@ros2_lv/0/z/0/0/NN/%/%a b/node",
        "@ros2_lv/x/z/0/0/NN/%/%/node",
        "@ros2_lv/0/z/0/0/MP/%/%/node",
        "@ros2_lv/0/z/0/0/NN/%/%/" + "a" * (1 << 20),
        robot_token(0, ZID, "MP", "", "n", "/a b", STRING, HASH, "::,:,:,:,,"),
        robot_token(0, ZID, "MP", "", "n", "/" + "a" * (MAX_NAME + 1), STRING, HASH, "::,:,:,:,,"),
        robot_token(0, ZID, "MP", "", "n", "/a", STRING, "<b>", "::,:,:,:,,"),
        robot_token(0, ZID, "MP", "", "n", "/a", STRING, "h" * 100, "::,:,:,:,,"),
        robot_token(0, ZID, "MP", "", "n", "/a", STRING, HASH, "::"),
        robot_token(0, ZID, "MP", "", "n", "/a", STRING, HASH, "7::,:,:,:,,"),
        robot_token(0, ZID, "MP", "", "n", "/a", STRING, HASH, "::,-1:,:,:,,"),
        robot_token(0, ZID, "MP", "", "n", "/a", STRING, HASH, f"::,{'9' * 5000}:,:,:,,"),
        robot_token(0, ZID, "MP", "", "n", "/a", STRING, HASH, "::9,:,:,:,,"),
        f"@ros2_lv/0/{ZID}/0/0/MP/%/%/n/%a/std_msgs::msg::String/{HASH}/::,:,:,:,,",
        f"@/{ZID}/@ros2_lv/MP/scan/sensor_msgs§msg§LaserScan",
        f"@/{ZID}/@ros2_lv/MP/a b/sensor_msgs§msg§LaserScan/:::",
        f"@/{ZID}/@ros2_lv/MP/scan/{'t' * 300}§msg§LaserScan/:::",
        f"@/{ZID}/@ros2_lv/MP/scan/sensor_msgs§msg§LaserScan/:9::",
    ],
)
def test_refuses_tokens_that_lie(token: str) -> None:
    with pytest.raises(LivelinessError) as raised:
        read_token(token)
    assert len(str(raised.value)) < 100


@given(st.text(max_size=MAX_TOKEN + 10) | st.lists(st.text(max_size=6)).map("/".join))
def test_any_text_is_a_token_or_refused(text: str) -> None:
    for token in (text, f"@ros2_lv/{text}", f"@/z/@ros2_lv/{text}"):
        try:
            entity = read_token(token)
        except LivelinessError:
            continue
        assert entity is None or len(entity.name) <= MAX_NAME


def test_defaults_of_qos_are_those_of_rmw_zenoh() -> None:
    assert read_qos("::,:,:,:,,") == TokenQos("reliable", "volatile", 42)
    assert write_qos("reliable", "volatile", 42) == "::,:,:,:,,"
    assert write_qos("best_effort", "transient_local", 1) == "2:1:,1:,:,:,,"
    assert read_qos("::,5:0,100000000:,:,,").deadline_s == pytest.approx(0.1)
    assert read_dds_qos("K:1:1:0,10") == TokenQos("reliable", "transient_local", 10)
    assert read_dds_qos(":::").durability == "volatile"
    since_iron = f":0:0:0,5:typehash={HASH};"
    assert read_dds_qos(since_iron) == TokenQos("best_effort", "volatile", 5)


def test_attachments_are_33_bytes_as_the_engine_serialises_them() -> None:
    gid = bytes(range(16))
    ours = write_attachment(Attachment(7, 1_700_000_000_123_456_789, gid))
    parts = zenoh.ext.Int64(7), zenoh.ext.Int64(1_700_000_000_123_456_789), gid
    assert ours == zenoh.ext.z_serialize(parts).to_bytes()
    assert ours == robot_attachment(7, 1_700_000_000_123_456_789, gid)
    assert len(ours) == 33
    assert read_attachment(ours) == Attachment(7, 1_700_000_000_123_456_789, gid)


def test_reads_attachments_with_names() -> None:
    gid = bytes(range(16))
    parts = (
        "sequence_number",
        zenoh.ext.Int64(-2),
        "source_timestamp",
        zenoh.ext.Int64(3),
        "source_gid",
        gid,
    )
    named = zenoh.ext.z_serialize(parts).to_bytes()
    assert read_attachment(named) == Attachment(-2, 3, gid)
    assert read_attachment(named[:-1]) is None
    assert read_attachment(named.replace(b"source_gid", b"source_gis")) is None


@given(st.binary(max_size=80))
def test_reads_any_bytes_as_an_attachment_or_none(data: bytes) -> None:
    read = read_attachment(data)
    assert read is None or len(read.gid) == 16


def test_a_gid_is_the_low_half_before_the_high_one() -> None:
    token = robot_token(0, ZID, "MP", "", "n", "/a", STRING, HASH, "::,:,:,:,,")
    value = xxhash.xxh3_128_intdigest(token.encode())
    halves = value & 0xFFFF_FFFF_FFFF_FFFF, value >> 64
    assert gid_of(token) == struct.pack("<QQ", *halves)

"""A viewer and a robot that speaks as Humble does, by another implementation of DDS."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from peer_python import peer_python
from program import Program
from waiting import until

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

from webviz import Topic
from webviz.data.messages import decode, encode
from webviz.ros import distribution
from webviz.ros.node import RosSource
from webviz.sources import Advertisement, Subscription

ROOT = Path(__file__).parents[2]
STRING, RANGE = "std_msgs/msg/String", "sensor_msgs/msg/Range"
TYPES = {"/humble_text": STRING, "/humble_latched": STRING, "/humble_range": RANGE}


@pytest.fixture(scope="module")
def robot(webviz_domain: int, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Program]:
    # The wheels of ROS mark the environment of child processes, which are not theirs here.
    own = "_ROS_WHEELS_BOOTSTRAP_COMPLETE", "PYTHONPATH"
    env = {name: value for name, value in os.environ.items() if name not in own}
    peer = ROOT / "tests/support/humble_peer.py"
    command = [str(peer_python()), "-u", str(peer), str(webviz_domain), "300"]
    program = Program(command, env, tmp_path_factory.mktemp("humble") / "output.txt")
    yield program
    program.end(signal.SIGTERM)


@pytest.fixture(scope="module")
def source(robot: Program, webviz_domain: int) -> Iterator[RosSource]:
    with pytest.MonkeyPatch.context() as patch:
        # With it, rclpy announces itself to other processes in a way that only Fast DDS looks for.
        patch.delenv("ROS_AUTOMATIC_DISCOVERY_RANGE", raising=False)
        source = RosSource(domain_id=webviz_domain)
        until(lambda: TYPES.keys() <= source.offers().keys(), lambda: robot.output())
        yield source
        source.close()


def test_its_topics_have_types_and_qos_without_hashes(source: RosSource) -> None:
    def offered() -> dict[str, tuple[str, str]]:
        offers = source.offers()
        return {
            topic: (publisher.type, publisher.durability)
            for topic in TYPES
            for publisher in offers[topic].publishers
        }

    latched = {"/humble_latched": "transient_local"}
    expected = {topic: (type, latched.get(topic, "volatile")) for topic, type in TYPES.items()}
    until(lambda: offered() == expected, lambda: str(offered()))


def last_messages(source: RosSource, *topics: str) -> dict[str, Any]:
    """Subscribe to topics, and return the last message of each."""
    result: dict[str, Any] = {}

    def have_all_arrived() -> bool:
        for topic, messages in source.inbox.drain().items():
            result[topic] = decode(TYPES[topic], messages[-1].cdr)
        return result.keys() == set(topics)

    source.want({topic: Subscription(TYPES[topic], Topic(topic)) for topic in topics})
    until(have_all_arrived, lambda: str(result))
    return result


def test_its_messages_arrive(source: RosSource) -> None:
    result = last_messages(source, "/humble_text", "/humble_latched")
    assert result["/humble_text"].data == "moving"
    assert result["/humble_latched"].data == "latched"


@pytest.mark.skipif(
    distribution.name() == "kilted",
    reason="Range of this Cyclone DDS does not arrive at Kilted's Fast DDS 3; the cause is unknown",
)
def test_fields_missing_in_its_messages_have_defaults(source: RosSource) -> None:
    distance = last_messages(source, "/humble_range")["/humble_range"]
    assert (distance.header.frame_id, distance.range, distance.variance) == ("sonar", 2.0, 0.0)


def test_it_receives_messages_of_the_viewer(source: RosSource, robot: Program) -> None:
    advertisement = Advertisement("/to_humble", STRING)
    source.graph.advertise([advertisement]).result(10)
    cdr = encode(STRING, {"data": "from the viewer"})

    def is_heard() -> bool:
        """Return whether it has said so; a first message may come before its match."""
        source.graph.publish(advertisement, cdr).result(10)
        return "heard from the viewer" in robot.output()

    until(is_heard, robot.output)


def test_its_services_are_listed_with_their_types(source: RosSource) -> None:
    until(lambda: source.graph.services().get("/humble_switch") == "std_srvs/srv/SetBool")

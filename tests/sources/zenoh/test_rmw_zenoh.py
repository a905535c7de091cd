"""The same against rmw_zenoh_cpp itself, where a machine has it; `which_way.md` has the command."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from waiting import until
from zenoh_robot import DEFINITIONS, ZenohRouter

from webviz.api.declared import Topic
from webviz.data.messages import decode, encode, interfaces
from webviz.sources import Advertisement, Subscription
from webviz.sources.zenoh.source import ZenohSource

STRING = "std_msgs/msg/String"
SET_BOOL = "std_srvs/srv/SetBool"
LIST_PARAMETERS = "rcl_interfaces/srv/ListParameters"
PATIENCE_S = 30.0
PREFIXES = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
HAS_IT = any(next(Path(each).glob("lib/librmw_zenoh_cpp.*"), None) for each in PREFIXES if each)

pytestmark = pytest.mark.skipif(not HAS_IT, reason="needs rmw_zenoh_cpp of an apt ROS, sourced")


@pytest.fixture
def robot(router: ZenohRouter) -> Iterator[None]:
    """A node on rclpy with rmw_zenoh_cpp, as a client of the router."""
    override = f'mode="client";connect/endpoints=["{router.endpoint}"]'
    env = os.environ | {
        "RMW_IMPLEMENTATION": "rmw_zenoh_cpp",
        "ROS_DOMAIN_ID": "0",
        "ZENOH_CONFIG_OVERRIDE": override,
    }
    path = Path(__file__).parents[2] / "support/rmw_zenoh_robot.py"
    process = subprocess.Popen([sys.executable, str(path)], stdin=subprocess.PIPE, env=env)
    yield
    process.communicate(timeout=PATIENCE_S)


def first(source: ZenohSource, topic: str) -> str:
    """Return the first message of a topic."""
    source.want({topic: Subscription(STRING, Topic(topic))})
    results: list[str] = []

    def look() -> bool:
        arrived = source.inbox.drain().get(topic, ())
        results.extend(decode(STRING, raw.cdr, raw.types).data for raw in arrived)
        return bool(results)

    until(look, seconds=PATIENCE_S)
    return results[0]


def test_its_topics_nodes_and_caches_are_read(source: ZenohSource, robot: None) -> None:
    until(lambda: {"/words", "/latched"} <= set(source.offers()), seconds=PATIENCE_S)
    assert "/lab/robot" in source.graph.nodes()
    (publisher,) = source.offers()["/latched"].publishers
    assert (publisher.node, publisher.durability) == ("/lab/robot", "transient_local")
    assert first(source, "/words") == "word"
    assert first(source, "/latched") == "map"


def test_it_receives_messages_of_the_viewer(source: ZenohSource, robot: None) -> None:
    until(lambda: "/heard" in source.snapshot.readers, seconds=PATIENCE_S)
    source.want({"/repeated": Subscription(STRING, Topic("/repeated"))})
    cdr = encode(STRING, {"data": "hello"})

    def is_repeated() -> bool:
        source.graph.publish(Advertisement("/heard", STRING), cdr).result(PATIENCE_S)
        arrived = source.inbox.drain().get("/repeated", ())
        return any(decode(STRING, raw.cdr).data == "hello" for raw in arrived)

    until(is_repeated, seconds=PATIENCE_S)


def test_it_answers_services_and_lists_its_parameters(source: ZenohSource, robot: None) -> None:
    until(lambda: "/switch" in source.graph.services(), seconds=PATIENCE_S)
    interfaces.service(SET_BOOL, DEFINITIONS[SET_BOOL])
    request = encode(f"{SET_BOOL}_Request", {"data": True})
    answer = source.graph.call("/switch", SET_BOOL, request, PATIENCE_S).result(PATIENCE_S)
    assert decode(f"{SET_BOOL}_Response", answer).message == "switched"
    name = "/lab/robot/list_parameters"
    listed = encode(f"{LIST_PARAMETERS}_Request", {})
    answer = source.graph.call(name, LIST_PARAMETERS, listed, PATIENCE_S).result(PATIENCE_S)
    assert "speed" in decode(f"{LIST_PARAMETERS}_Response", answer).result.names

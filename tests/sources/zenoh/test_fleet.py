"""Many robots over Zenoh: a domain each, or namespaces over one session."""

from __future__ import annotations

import time

import pytest
from waiting import until
from zenoh_robot import ZenohRobot, ZenohRouter

from webviz.api.declared import Topic
from webviz.api.robots import NamespacedRobot
from webviz.data.messages import decode, encode
from webviz.sources import Advertisement, Subscription
from webviz.sources.fleet.source import FleetSource
from webviz.sources.zenoh.address import zenoh_address
from webviz.sources.zenoh.source import ZenohSource

STRING = "std_msgs/msg/String"
TWIST = "geometry_msgs/msg/Twist"
SET_BOOL = "std_srvs/srv/SetBool"


@pytest.mark.parametrize("has_domain", [True, False])
def test_a_domain_or_a_key_prefix_each(router: ZenohRouter, has_domain: bool) -> None:
    """Robots that all use the same names, also those of keys in the second case."""
    robots = [
        ZenohRobot(router.endpoint, "/base", domain=number)
        if has_domain
        else ZenohRobot(router.endpoint, "/base", namespace=f"fleet/robot{number}")
        for number in (1, 2)
    ]
    latched = [robot.publisher("/map", STRING, is_latched=True) for robot in robots]
    for number, each in enumerate(latched, start=1):
        each({"data": f"map of robot {number}"})
    publish = [robot.publisher("/words", STRING) for robot in robots]
    driven = [robot.subscription("/cmd_vel", TWIST) for robot in robots]
    robots[1].service("/light", SET_BOOL, lambda request: {"success": True})
    named = [
        NamespacedRobot(f"robot{n}", connection=router.endpoint, domain=n)
        if has_domain
        else NamespacedRobot(
            f"robot{n}", connection=router.endpoint, domain=0, key_prefix=f"fleet/robot{n}"
        )
        for n in (1, 2)
    ]
    fleet = FleetSource(named, None)
    topics = ("/robot1/words", "/robot2/words", "/robot1/map", "/robot2/map")
    try:
        until(lambda: set(topics) <= set(fleet.offers()))
        assert {"/robot1/base", "/robot2/base"} <= set(fleet.graph.nodes())
        assert fleet.offers()["/robot2/words"].publishers[0].node == "/robot2/base"
        until(lambda: fleet.graph.services().get("/robot2/light") == SET_BOOL)
        fleet.want({topic: Subscription(STRING, Topic(topic)) for topic in topics})
        until(lambda: all(fleet.offers()[topic].subscribers for topic in topics))
        time.sleep(0.1)
        for number, each in enumerate(publish, start=1):
            each({"data": f"of robot {number}"})
        result: dict[str, str] = {}

        def take() -> bool:
            for topic, raws in fleet.inbox.drain().items():
                result[topic] = decode(STRING, raws[-1].cdr).data
            return len(result) == 4

        until(take)
        assert result == {
            "/robot1/words": "of robot 1",
            "/robot2/words": "of robot 2",
            "/robot1/map": "map of robot 1",
            "/robot2/map": "map of robot 2",
        }
        request = encode(f"{SET_BOOL}_Request", {"data": True})
        answer = fleet.graph.call("/robot2/light", SET_BOOL, request, 5).result(10)
        assert decode(f"{SET_BOOL}_Response", answer).success
        cdr = encode(TWIST, {"linear": {"x": 1.0}})
        publication = fleet.graph.publish(Advertisement("/robot2/cmd_vel", TWIST), cdr)
        assert publication.result(5) == 1
        until(lambda: driven[1])
        assert not driven[0]
        assert [bridge.robot for bridge in fleet.bridges] == ["robot1", "robot2"]
    finally:
        fleet.close()
        for robot in robots:
            robot.close()


@pytest.mark.parametrize("count", [10, 50])
def test_many_robots_over_one_session(source: ZenohSource, router: ZenohRouter, count: int) -> None:
    robots = [ZenohRobot(router.endpoint, f"/robot{n}/base") for n in range(count)]
    topics = [f"/robot{n}/words" for n in range(count)]
    try:
        publish = [
            robot.publisher(topic, STRING) for robot, topic in zip(robots, topics, strict=True)
        ]
        until(lambda: set(topics) <= set(source.offers()))
        assert len([node for node in source.graph.nodes() if node.endswith("/base")]) == count
        source.want({topic: Subscription(STRING, Topic(topic)) for topic in topics})
        until(lambda: all(source.offers()[topic].subscribers for topic in topics))

        def publish_all() -> None:
            for each in publish:
                each({"data": "x" * 1000})

        def have_come() -> bool:
            received = source.inbox.received()
            return all(received.get(topic, (0, 0))[0] >= 5 for topic in topics)

        until(have_come, turn=publish_all, look_s=0.05)
        assert not source.bridges[0].remarks
    finally:
        for robot in robots:
            robot.close()
    until(lambda: not set(topics) & set(source.offers()))


def test_three_viewers_of_one_robot(router: ZenohRouter, robot: ZenohRobot) -> None:
    publish = robot.publisher("/words", STRING)
    sources = [ZenohSource(zenoh_address(router.endpoint, {})) for _ in range(3)]
    try:
        for each in sources:
            each.want({"/words": Subscription(STRING, Topic("/words"))})
        until(lambda: all(s.offers().get("/words") for s in sources))
        until(lambda: all(s.offers()["/words"].subscribers == 3 for s in sources))
        time.sleep(0.2)
        for _ in range(20):
            publish({"data": "x"})
        until(lambda: all(s.inbox.received().get("/words", (0, 0))[0] == 20 for s in sources))
    finally:
        for each in sources:
            each.close()

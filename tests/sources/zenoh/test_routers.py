"""The configs of routers in the documentation, as they are there."""

from __future__ import annotations

import re
import time
from contextlib import ExitStack
from pathlib import Path

import pytest
import zenoh
from certificates import authority, certificate
from slow_link import SlowLink
from waiting import until
from zenoh_robot import ZenohRobot, ZenohRouter, config, free_port

from webviz.api.declared import Topic
from webviz.data.messages import encode
from webviz.sources import Advertisement, Subscription
from webviz.sources.zenoh.address import zenoh_address
from webviz.sources.zenoh.source import ZenohSource

PAGE = Path(__file__).parents[3] / "displays/docs/ros/which_way.md"
STRING = "std_msgs/msg/String"
TWIST = "geometry_msgs/msg/Twist"


def block(name: str, **replaced: str) -> str:
    """Return a config of the page, with other places for what has to be another here."""
    text = PAGE.read_text(encoding="utf-8")
    match = re.search(rf'```json5 title="{name}"\n(.*?)```', text, re.DOTALL)
    assert match, name
    result = match[1]
    for old, new in replaced.items():
        assert PLACES[old] in result, old
        result = result.replace(PLACES[old], new)
    return result


NO_SHARED_MEMORY = "{ shared_memory: { enabled: false } }"
PLACES = {
    "listen": "0.0.0.0:7447",
    "local": "localhost:7448",
    "cloud": "cloud.example:7447",
    "desk": "localhost:7447",
}


def open_session(stack: ExitStack, text: str) -> zenoh.Session:
    """Open a session with a config, without scouting."""
    zenoh_config = zenoh.Config.from_json5(text)
    zenoh_config.insert_json5("scouting/multicast/enabled", "false")
    session = zenoh.open(zenoh_config)
    stack.callback(session.close)
    return session


def source_at(stack: ExitStack, address: str) -> ZenohSource:
    source = ZenohSource(zenoh_address(address, {}))
    stack.callback(source.close)
    until(lambda: source.bridges[0].is_up)
    return source


def robot_at(stack: ExitStack, endpoint: str) -> ZenohRobot:
    robot = ZenohRobot(endpoint)
    stack.callback(robot.close)
    return robot


def test_a_slow_link_has_fewer_scans_and_no_images(stack: ExitStack) -> None:
    place = f"127.0.0.1:{free_port()}"
    open_session(stack, block("slow.json5", listen=place))
    robot, source = robot_at(stack, f"tcp/{place}"), source_at(stack, f"tcp/{place}")
    topics = ("/scan", "/odom", "/camera/image")
    publish = {topic: robot.publisher(topic, STRING) for topic in topics}
    until(lambda: set(topics) <= set(source.offers()))
    source.want({topic: Subscription(STRING, Topic(topic)) for topic in topics})
    until(lambda: all(source.offers()[topic].subscribers for topic in topics))
    time.sleep(0.3)
    began_s = time.monotonic()
    for _ in range(40):
        for topic in topics:
            publish[topic]({"data": "x"})
        time.sleep(0.05)
    seconds = time.monotonic() - began_s
    until(lambda: source.inbox.received().get("/odom", (0, 0))[0] == 40)
    counts = {topic: count for topic, (count, _) in source.inbox.received().items()}
    assert 0 < counts["/scan"] <= 2 * seconds + 2
    assert counts["/camera/image"] == 0


def test_poses_overtake_clouds_on_a_slow_link(stack: ExitStack) -> None:
    port = free_port()
    # On one machine, large messages would go through shared memory.
    text = block("priorities.json5", listen=f"127.0.0.1:{port}")
    open_session(stack, text.replace("qos:", f"transport: {NO_SHARED_MEMORY}, qos:"))
    link = SlowLink(port, rate=125e3, delay_s=0.01)
    stack.callback(link.close)
    robot = robot_at(stack, f"tcp/127.0.0.1:{port}")
    source = source_at(stack, f"tcp/127.0.0.1:{link.get_port()}")
    topics = ("/odom", "/points")
    publish = {topic: robot.publisher(topic, STRING) for topic in topics}
    until(lambda: set(topics) <= set(source.offers()))
    source.want({topic: Subscription(STRING, Topic(topic)) for topic in topics})
    until(lambda: all(source.offers()[topic].subscribers for topic in topics))
    cloud = encode(STRING, {"data": "x" * 400_000})
    for number in range(60):
        publish["/odom"]({"data": str(number)})
        publish["/points"](cloud)
        time.sleep(0.05)
    # The clouds would need three minutes; without priorities, nine of ten poses are dropped.
    until(lambda: source.inbox.received().get("/odom", (0, 0))[0] > 40)


def test_watchers_cannot_drive(stack: ExitStack) -> None:
    place = f"127.0.0.1:{free_port()}"
    open_session(stack, block("watch.json5", listen=place))
    robot, source = robot_at(stack, f"tcp/{place}"), source_at(stack, f"tcp/{place}")
    driven, words = robot.subscription("/cmd_vel", TWIST), robot.subscription("/words", STRING)
    until(lambda: {"/cmd_vel", "/words"} <= set(source.snapshot.readers))
    cdr = encode(TWIST, {"linear": {"x": 1.0}})
    for _ in range(3):
        source.graph.publish(Advertisement("/cmd_vel", TWIST), cdr).result(5)
        source.graph.publish(Advertisement("/words", STRING), encode(STRING, {})).result(5)
    until(lambda: len(words) == 3)
    assert not driven


@pytest.mark.parametrize("protocol", ["tls", "quic"])
def test_certificates_on_both_sides(
    stack: ExitStack, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, protocol: str
) -> None:
    monkeypatch.chdir(tmp_path)
    authority().cert_pem.write_to_path("ca.pem")
    certificate(tmp_path, "cloud")
    certificate(tmp_path, "desk")
    port = free_port()
    cloud = block("cloud.json5", listen=f"127.0.0.1:{port}").replace("tls/", f"{protocol}/")
    inner = f"tcp/127.0.0.1:{free_port()}"
    open_session(stack, cloud.replace("endpoints: [", f'endpoints: ["{inner}", '))
    robot = robot_at(stack, inner)
    publish = robot.publisher("/words", STRING, is_latched=True)
    publish({"data": "over a cloud"})
    desk = block("desk.json5", desk=f"localhost:{port}").replace("tls/", f"{protocol}/")
    Path("desk.json5").write_text(desk)
    source = source_at(stack, "desk.json5")
    assert source.bridges[0].name == f"{protocol}/localhost:{port}"
    until(lambda: "/words" in source.offers())
    source.want({"/words": Subscription(STRING, Topic("/words"))})
    until(lambda: source.inbox.drain().get("/words"))
    # Without a certificate of the authority, the router lets nobody in.
    stranger = ZenohSource(zenoh_address(f"{protocol}/localhost:{port}", {}))
    stack.callback(stranger.close)
    until(lambda: f"over {protocol.upper()} was opened" in stranger.bridges[0].problem)
    assert "root_ca_certificate" in stranger.bridges[0].remedy


def test_nothing_listens_for_quic(stack: ExitStack) -> None:
    port = free_port()
    source = ZenohSource(zenoh_address(f"quic/localhost:{port}", {}))
    stack.callback(source.close)
    until(lambda: "over QUIC was opened" in source.bridges[0].problem)
    assert source.bridges[0].problem.startswith("No session over QUIC was opened with localhost:")
    assert "UDP" in source.bridges[0].remedy


def test_a_robot_behind_nat_connects_out(stack: ExitStack) -> None:
    cloud = ZenohRouter()
    stack.callback(cloud.close)
    inner = f"localhost:{free_port()}"
    text = block("robot.json5", local=inner, cloud=f"127.0.0.1:{cloud.port}")
    open_session(stack, text)
    robot = robot_at(stack, f"tcp/{inner}")
    publish = robot.publisher("/map", STRING, is_latched=True)
    publish({"data": "map"})
    source = source_at(stack, cloud.endpoint)
    until(lambda: "/map" in source.offers())
    source.want({"/map": Subscription(STRING, Topic("/map"))})
    until(lambda: source.inbox.drain().get("/map"))


def test_a_router_that_asks_for_a_user(
    stack: ExitStack, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "users").write_text("ann:secret\n")
    port = free_port()
    endpoint = f"tcp/127.0.0.1:{port}"
    zenoh_config = config("router", listen=endpoint)
    zenoh_config.insert_json5("transport/auth/usrpwd/dictionary_file", f'"{tmp_path}/users"')
    router = zenoh.open(zenoh_config)
    stack.callback(router.close)
    who = {"WEBVIZ_ZENOH_USER": "ann", "WEBVIZ_ZENOH_PASSWORD": "secret"}
    source = ZenohSource(zenoh_address(endpoint, who))
    stack.callback(source.close)
    until(lambda: source.bridges[0].is_up)
    wrong = ZenohSource(zenoh_address(endpoint, who | {"WEBVIZ_ZENOH_PASSWORD": "guess"}))
    stack.callback(wrong.close)
    until(lambda: "refuses webviz" in wrong.bridges[0].problem)
    assert "WEBVIZ_ZENOH_USER" in wrong.bridges[0].remedy

"""The real server of foxglove-sdk, which foxglove_bridge is made of."""

from __future__ import annotations

import base64
import signal
import time
from collections.abc import Iterator

import pytest
from bridges import SCAN, STRING, TF, BridgeReader, FoxgloveServer, foxglove_server, reading
from slow_link import SlowLink

from webviz.data.messages import decode, encode, interfaces, type_exists
from webviz.sources import Advertisement, NotConnected
from webviz.sources.bridge import source as bridge_source
from webviz.sources.graph import UNKNOWN
from webviz_urdf import remote
from webviz_urdf.loading import Loading, LoadRequest

BATTERY = "my_robot_msgs/msg/Battery"
SET_BOOL = "std_srvs/srv/SetBool"
SET_MODE = "my_robot_msgs/srv/SetMode"
CMD_VEL = Advertisement("/cmd_vel", "geometry_msgs/msg/Twist")


@pytest.fixture
def reader(server: FoxgloveServer) -> Iterator[BridgeReader]:
    with reading(server.url) as reader:
        reader.until_up()
        yield reader


def test_topics_have_types_and_nodes_but_no_known_qos(reader: BridgeReader) -> None:
    reader.until(lambda: reader.source.offers()["/scan"].publishers[0].node)
    (laser,) = reader.source.offers()["/scan"].publishers
    assert (laser.node, laser.type, laser.is_qos_known) == ("/laser", SCAN, False)
    assert [p.node for p in reader.source.offers()["/tf"].publishers] == [
        "/odometry",
        "/robot_state_publisher",
    ]
    assert reader.source.graph.nodes() == ("/base", "/laser", "/odometry", "/robot_state_publisher")


def test_messages_arrive_only_while_subscribed(
    server: FoxgloveServer, reader: BridgeReader
) -> None:
    reader.want(scan=SCAN)
    server.receive("subscribed", "/scan")
    assert len(reader.decoded("/scan", SCAN).ranges) == 360
    reader.want(tf=TF)
    server.receive("unsubscribed", "/scan")
    reader.receive("/tf", 3)
    assert "/scan" not in reader.arrived or not reader.source.inbox.drain().get("/scan")


def test_latched_messages_come_again_for_a_new_reader(
    server: FoxgloveServer, reader: BridgeReader
) -> None:
    reader.want(robot_description=STRING)
    first = reader.receive("/robot_description")
    reader.want(robot_description=STRING, resubscriptions=1)
    assert reader.receive("/robot_description") == first


def test_a_type_that_is_defined_in_idl_is_read(reader: BridgeReader) -> None:
    reader.want(battery=BATTERY)
    battery = reader.decoded("/battery", BATTERY)
    assert (battery.voltage, battery.name) == (12.5, "main")


def test_a_service_answers_and_its_error_is_reported(
    server: FoxgloveServer, reader: BridgeReader
) -> None:
    interfaces.service(SET_BOOL)
    call = reader.source.graph.call
    on = call("/motor", SET_BOOL, encode(f"{SET_BOOL}_Request", {"data": True}), 20.0)
    assert decode(f"{SET_BOOL}_Response", on.result(20)).message == "on"
    off = call("/motor", SET_BOOL, encode(f"{SET_BOOL}_Request", {"data": False}), 20.0)
    with pytest.raises(NotConnected, match="the motor is locked"):
        off.result(20)
    with pytest.raises(NotConnected, match="no service /horn"):
        call("/horn", SET_BOOL, b"", 20.0).result(20)
    with pytest.raises(NotConnected, match="has the type std_srvs/srv/SetBool"):
        call("/motor", "std_srvs/srv/Empty", b"", 20.0).result(20)


def test_a_service_is_known_by_the_definitions_of_the_bridge(reader: BridgeReader) -> None:
    reader.until(lambda: type_exists(f"{SET_MODE}_Request"))
    request, response = interfaces.service(SET_MODE)
    cdr = encode(request, {"mode": {"name": "fast"}, "levels": [1, 2]})
    answer = reader.source.graph.call("/mode", SET_MODE, cdr, 20.0).result(20)
    assert decode(response, answer).said == cdr.hex()


def test_published_messages_reach_the_server_with_the_number_of_subscribers(
    server: FoxgloveServer, reader: BridgeReader
) -> None:
    reader.until(reader.source.graph.nodes)
    cdr = encode(CMD_VEL.type, {"linear": {"x": 0.5}})
    assert reader.source.graph.advertise([CMD_VEL]).result(20) is None
    assert reader.source.graph.publish(CMD_VEL, cdr).result(20) == 1
    assert server.receive("advertised") == "/cmd_vel"
    assert base64.b64decode(server.receive("message")) == cdr
    reader.source.graph.advertise([])
    assert server.receive("unadvertised")


def test_files_of_the_robot_are_fetched(reader: BridgeReader) -> None:
    assert reader.source.graph.fetch("package://arm/a.stl").result(20) == b"solid"
    with pytest.raises(NotConnected, match="no such file"):
        reader.source.graph.fetch("package://arm/b.stl").result(20)


def test_meshes_that_this_machine_lacks_come_from_the_robot(reader: BridgeReader) -> None:
    reader.until(lambda: reader.source.graph.nodes())  # the server has said what it can do
    shape = "<visual><geometry><mesh filename='package://{}'/></geometry></visual>"
    urdf = f"""<robot name="arm"><link name="base">{shape.format("arm/meshes/link.obj")}
        {shape.format("arm/meshes/../../secret.obj")}{shape.format("arm/none.obj")}</link></robot>"""
    robot = Loading(LoadRequest(text=urdf)).run()
    assert [len(each.reason) > 0 for each in robot.missing] == [True, True]
    folder = remote.folder() / "arm" / "meshes"
    assert sorted(path.name for path in folder.iterdir()) == ["link.obj", "red.mtl"]


def test_actions_are_refused_with_another_way(reader: BridgeReader) -> None:
    goal = reader.source.graph.send_goal("/spin", "nav2_msgs/action/Spin", b"", lambda cdr: None)
    with pytest.raises(NotConnected, match="Actions do not pass the bridge"):
        goal.accepted.result(20)


def test_simulated_time_is_that_of_the_bridge(server: FoxgloveServer, reader: BridgeReader) -> None:
    assert reader.source.clock_messages() is None
    assert abs(reader.source.now_ns() - time.time_ns()) < 10**9
    server.do("time 12.5")
    reader.until(lambda: reader.source.now_ns() == 12_500_000_000)
    assert reader.source.clock_messages() == 1


def test_warnings_of_the_bridge_are_shown(server: FoxgloveServer, reader: BridgeReader) -> None:
    server.do("status the disk is full")
    reader.until(lambda: "The bridge reports: the disk is full" in reader.bridge.remarks)


def test_a_topic_that_ends_is_gone(server: FoxgloveServer, reader: BridgeReader) -> None:
    assert "/odd" in reader.source.offers()
    server.do("stop /odd")
    reader.until(lambda: "/odd" not in reader.source.offers())


def test_missing_capabilities_of_a_server_are_reported() -> None:
    with foxglove_server(0, "plain") as server, reading(server.url) as reader:
        reader.until_up()
        reader.want(scan=SCAN)
        reader.receive("/scan")
        limits = " ".join(reader.bridge.limits)
        assert "does not accept messages" in limits
        assert "calls no services" in limits
        assert "does not report which nodes" in limits
        with pytest.raises(NotConnected, match="clientPublish"):
            reader.source.graph.publish(CMD_VEL, encode(CMD_VEL.type, {})).result(20)
        assert reader.source.offers()["/scan"].subscribers is None
        with pytest.raises(NotConnected, match="parameter capabilities"):
            reader.source.graph.fetch("package://arm/a.stl").result(20)


def test_all_subscriptions_are_restored_after_a_server_restarts() -> None:
    with foxglove_server() as first, reading(first.url) as reader:
        reader.until_up()
        reader.want(scan=SCAN)
        reader.receive("/scan", 3)
        reader.source.graph.advertise([CMD_VEL]).result(20)
        first.kill()
        reader.until(lambda: not reader.bridge.is_up)
        assert reader.bridge.was_up
        offer = reader.source.offers()["/scan"]
        assert offer.publishers[0].type == SCAN
        assert offer.problem.startswith("the link is broken. ")
        with pytest.raises(NotConnected):
            reader.source.graph.publish(CMD_VEL, b"").result(20)
        with foxglove_server(first.port) as second:
            assert second.receive("advertised") == "/cmd_vel"
            reader.until_up()
            reader.receive("/scan", 3)
            reader.until(lambda: not reader.source.offers()["/scan"].problem)


def test_a_server_that_hangs_gets_no_late_commands(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bridge_source, "BROKEN_S", 4.0)
    with foxglove_server() as server, reading(server.url) as reader:
        reader.until_up()
        cdr = encode(CMD_VEL.type, {})
        assert reader.source.graph.publish(CMD_VEL, cdr).result(20) != UNKNOWN
        server.signal(signal.SIGSTOP)

        def is_refused() -> bool:
            error = reader.source.graph.publish(CMD_VEL, cdr).exception(20)
            return error is not None and "arrive late" in str(error)

        reader.until(is_refused)
        reader.until(lambda: any("Nothing came" in remark for remark in reader.bridge.remarks))
        reader.until(lambda: not reader.bridge.is_up)
        server.signal(signal.SIGCONT)
        reader.until_up()
        assert reader.source.graph.publish(CMD_VEL, cdr).exception(20) is None


def test_messages_dropped_on_a_slow_link_are_estimated() -> None:
    with foxglove_server(0, "short") as server:
        link = SlowLink(server.port, rate=400_000, delay_s=0.0)
        try:
            with reading(f"ws://127.0.0.1:{link.get_port()}") as reader:
                reader.until_up()
                reader.want(robot_description=STRING, scan=SCAN)
                reader.receive("/scan", 10)
                server.do("burst /robot_description 600 40000")
                reader.until(
                    lambda: any("the bridge dropped about" in r for r in reader.bridge.remarks)
                )
        finally:
            link.close()

"""Several robots, each behind a bridge of its own."""

from __future__ import annotations

import base64
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import closing, contextmanager
from typing import Any

import pytest
from bridges import SCAN, STRING, TF, FoxgloveServer, foxglove_server
from serving import serving
from waiting import until
from websockets.http11 import Request
from websockets.sync.server import ServerConnection, serve

from webviz.api.declared import Topic
from webviz.api.robots import NamespacedRobot
from webviz.data.messages import decode, encode, interfaces
from webviz.features.bridges import status_of
from webviz.shell.testing.messages import header
from webviz.sources import Advertisement, NotConnected, Subscription
from webviz.sources.bridge.address import HEADERS, address, headers_of
from webviz.sources.fleet.source import FleetSource

AHEAD_S = 3.0
SET_BOOL = "std_srvs/srv/SetBool"
GOAL = Advertisement("/r2/goal_pose", "geometry_msgs/msg/PoseStamped")


def _robots(urls: Mapping[str, str]) -> list[NamespacedRobot]:
    return [NamespacedRobot(name, connection=url) for name, url in urls.items()]


class Fleet:
    """A source with robots, and what arrived.

    Args:
        urls: of the bridges, by namespace.
    """

    def __init__(self, **urls: str) -> None:
        self.source = FleetSource(_robots(urls), None)
        self.newest: dict[str, bytes] = {}
        self.received: dict[str, int] = {}

    def want(self, **types: str) -> None:
        """Subscribe to topics, in which __ stands for a slash, by type."""
        names = {f"/{name.replace('__', '/')}": type for name, type in types.items()}
        self.source.want({n: Subscription(t, Topic(n)) for n, t in names.items()})

    def until(self, condition: Callable[[], object]) -> None:
        until(condition, lambda: self.source.bridges, turn=self.take)

    def take(self) -> bool:
        for topic, raws in self.source.inbox.drain().items():
            self.received[topic] = self.received.get(topic, 0) + len(raws)
            self.newest[topic] = raws[-1].cdr
        return True

    def is_up(self, *robots: str) -> bool:
        return all(b.is_up == (b.robot in robots) for b in self.source.bridges)


@contextmanager
def fleet_of(**servers: FoxgloveServer) -> Iterator[Fleet]:
    fleet = Fleet(**{name: server.url for name, server in servers.items()})
    with closing(fleet.source):
        yield fleet


@pytest.fixture(scope="module")
def servers() -> Iterator[tuple[FoxgloveServer, FoxgloveServer]]:
    with foxglove_server() as one, foxglove_server(0, f"ahead={AHEAD_S}") as two:
        yield one, two


@pytest.fixture
def fleet(servers: tuple[FoxgloveServer, FoxgloveServer]) -> Iterator[Fleet]:
    with fleet_of(r1=servers[0], r2=servers[1]) as fleet:
        fleet.until(lambda: {"/r1/scan", "/r2/scan"} <= fleet.source.offers().keys())
        yield fleet


def late_s(fleet: Fleet, topic: str, type: str) -> float:
    stamp = decode(type, fleet.newest[topic]).header.stamp_ns
    return (time.time_ns() - stamp) / 1e9


def test_topics_and_nodes_of_each_robot_are_in_its_namespace(fleet: Fleet) -> None:
    fleet.until(lambda: fleet.source.offers()["/r2/scan"].publishers[0].node == "/r2/laser")
    assert "/scan" not in fleet.source.offers()
    fleet.until(lambda: {"/r1/base", "/r2/base"} <= set(fleet.source.graph.nodes()))
    fleet.want(r1__robot_description=STRING, r2__scan=SCAN)
    fleet.until(lambda: {"/r1/robot_description", "/r2/scan"} <= fleet.newest.keys())
    assert fleet.source.offers()["/r2/scan"].requested == ("reliable", "volatile")


def test_stamps_of_a_robot_whose_clock_is_ahead_are_corrected(fleet: Fleet) -> None:
    fleet.want(r1__scan=SCAN, r2__scan=SCAN, r2__tf=TF)
    fleet.until(lambda: fleet.source.bridges[1].clock_s)
    one, two = fleet.source.bridges
    assert one.clock_s == 0.0
    assert two.clock_s == pytest.approx(AHEAD_S, abs=0.5)
    assert f"is {two.clock_s:.2f} s ahead of that of this machine" in status_of(two).text
    fleet.newest.clear()
    fleet.until(lambda: {"/r1/scan", "/r2/scan", "/r2/tf"} <= fleet.newest.keys())
    assert late_s(fleet, "/r1/scan", SCAN) == pytest.approx(late_s(fleet, "/r2/scan", SCAN), abs=1)
    last_stamp_ns = decode(TF, fleet.newest["/r2/tf"]).transforms[0].stamp_ns
    assert abs(time.time_ns() - last_stamp_ns) < 1e9


def test_messages_go_to_the_robot_of_their_namespace_with_stamps_of_its_clock(
    fleet: Fleet, servers: tuple[FoxgloveServer, FoxgloveServer]
) -> None:
    fleet.want(r2__scan=SCAN)
    fleet.until(lambda: fleet.source.bridges[1].clock_s)
    assert fleet.source.graph.advertise([GOAL]).result(20) is None
    stamped = {"header": header("map", time.time_ns())}
    publication = fleet.source.graph.publish(GOAL, encode(GOAL.type, stamped))
    assert publication.result(20) >= 0
    assert servers[1].receive("advertised") == "/goal_pose"
    goal = decode(GOAL.type, base64.b64decode(servers[1].receive("message")))
    assert (goal.header.stamp_ns - time.time_ns()) / 1e9 == pytest.approx(AHEAD_S, abs=1)
    interfaces.service(SET_BOOL)
    request = encode(f"{SET_BOOL}_Request", {"data": True})
    answer = fleet.source.graph.call("/r1/motor", SET_BOOL, request, 20.0).result(20)
    assert decode(f"{SET_BOOL}_Response", answer).message == "on"
    assert servers[0].receive("called") == "/motor"
    with pytest.raises(NotConnected, match="in the namespace of no robot"):
        fleet.source.graph.call("/motor", SET_BOOL, request, 20.0).result(20)


def test_each_connection_breaks_and_opens_again_on_its_own(
    servers: tuple[FoxgloveServer, FoxgloveServer],
) -> None:
    with foxglove_server() as first, fleet_of(r1=servers[0], r2=first) as fleet:
        fleet.want(r1__scan=SCAN, r2__scan=SCAN)
        fleet.until(lambda: {"/r1/scan", "/r2/scan"} <= fleet.newest.keys())
        fleet.until(lambda: "/r2/scan" in fleet.source.offers())
        first.kill()
        fleet.until(lambda: fleet.is_up("r1"))
        before = fleet.received["/r1/scan"]
        fleet.until(lambda: fleet.received["/r1/scan"] > before + 3)
        assert fleet.source.offers()["/r2/scan"].problem.startswith("the link is broken")
        with foxglove_server(first.port):
            fleet.until(lambda: fleet.is_up("r1", "r2"))
            fleet.newest.clear()
            fleet.until(lambda: "/r2/scan" in fleet.newest)


def test_topics_that_are_in_the_namespace_already_keep_their_names() -> None:
    with foxglove_server(0, "named=/r1") as server, fleet_of(r1=server) as fleet:
        fleet.until(lambda: "/r1/scan" in fleet.source.offers())
        assert not any(topic.startswith("/r1/r1") for topic in fleet.source.offers())
        fleet.want(r1__scan=SCAN, r1__tf=TF)
        fleet.until(lambda: {"/r1/scan", "/r1/tf"} <= fleet.newest.keys())
        drive = Advertisement("/r1/cmd_vel", "geometry_msgs/msg/Twist")
        fleet.source.graph.publish(drive, encode(drive.type, {})).result(20)
        assert server.receive("advertised") == "/r1/cmd_vel"


def test_a_token_is_sent_to_the_robot_that_it_names_only() -> None:
    environment: dict[str, Any] = {HEADERS: "A: of all", f"{HEADERS}_FLEET_R1": "A: of r1"}
    one = address("ws://one", environment=headers_of("fleet/r1", environment))
    two = address("ws://two", environment=headers_of("r2", environment))
    assert (one.headers, two.headers) == ([("A", "of r1")], [])


def test_headers_go_to_the_addresses_of_the_start_only(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(f"{HEADERS}_R1", "X-Token: secret")
    requests: list[tuple[str, bool]] = []

    def note(connection: ServerConnection, request: Request) -> None:
        requests.append((request.path, "X-Token" in request.headers))

    with serving(serve(lambda _: None, "127.0.0.1", 0, process_request=note)) as server:
        url = f"ws://127.0.0.1:{server.socket.getsockname()[1]}"
        with closing(FleetSource(_robots({"r1": f"{url}/known"}), None)) as source:
            until(lambda: ("/known", True) in requests)
            source.follow(_robots({"r1": f"{url}/other"}))
            until(lambda: ("/other", False) in requests)
    assert ("/other", True) not in requests

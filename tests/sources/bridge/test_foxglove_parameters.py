"""Parameters through Foxglove's protocol: with the real server, and with one that lies."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from typing import Any

import pytest
from bridges import BridgeReader, FoxgloveServer, reading
from websockets.sync.server import ServerConnection

from tests.support.panel_facts import show as show_panel
from webviz.data.messages import decode, encode, interfaces
from webviz.engine.state import State
from webviz.page.recorded_ui import RecordedUi
from webviz.panels.parameters import Parameters
from webviz.sources import NotConnected
from webviz.sources.bridge import foxglove_parameters
from webviz.sources.bridge.foxglove_parameters import SERVER


@pytest.fixture
def reader(server: FoxgloveServer) -> Iterator[BridgeReader]:
    with reading(server.url) as reader:
        reader.until(lambda: reader.bridge.parameters.nodes == ("/base", SERVER))
        yield reader


def ask(reader: BridgeReader, service: str, **request: Any) -> Any:
    """Call a service for the parameters of a node."""
    words = service.rpartition("/")[2].split("_")
    type = "rcl_interfaces/srv/" + "".join(word.capitalize() for word in words)
    parts = interfaces.service(type)
    call = reader.source.graph.call(service, type, encode(parts.request, request), 20.0)
    return decode(parts.response, call.result(20))


def values(reader: BridgeReader, *names: str, node: str = "/base") -> list[Any]:
    return ask(reader, f"{node}/get_parameters", names=names).values


def change(reader: BridgeReader, name: str, **value: Any) -> Any:
    changes = [{"name": name, "value": value}]
    return ask(reader, "/base/set_parameters", parameters=changes).results[0]


def test_nodes_have_their_parameters_with_types(reader: BridgeReader) -> None:
    names = ask(reader, "/base/list_parameters").result.names
    assert {"max_speed", "qos_overrides./tf.depth"} < set(names)
    assert len(names) == 10
    requested_names = ("max_speed", "count", "name", "is_on", "key", "gains", "joints", "missing")
    result = values(reader, *requested_names)
    assert [each.type for each in result] == [3, 2, 4, 1, 5, 8, 9, 0]
    assert (result[0].double_value, result[1].integer_value) == (0.5, 3)
    assert (bytes(result[4].byte_array_value), list(result[5].double_array_value)) == (
        b"\x01\xff",
        [1.0, 2.5],
    )
    (free,) = values(reader, "free", node=SERVER)
    assert free.string_value == "of no node"


def test_a_value_without_a_type_in_ros_is_shown_and_locked(reader: BridgeReader) -> None:
    (limits,) = values(reader, "limits")
    assert limits.string_value.replace(" ", "") == '{"low":1}'
    about = ask(reader, "/base/describe_parameters", names=["limits", "count"]).descriptors
    assert [each.read_only for each in about] == [True, False]


def test_parameters_are_set_and_refusals_of_the_server_reported(reader: BridgeReader) -> None:
    assert change(reader, "count", type=2, integer_value=7).successful
    assert change(reader, "key", type=5, byte_array_value=b"\x05").successful
    assert change(reader, "gains", type=8, double_array_value=[3.0]).successful
    result = values(reader, "count", "key", "gains")
    assert [result[0].integer_value, bytes(result[1].byte_array_value)] == [7, b"\x05"]
    rejection = change(reader, "wheel_radius", type=3, double_value=0.2)
    assert (rejection.successful, rejection.reason) == (False, "The bridge keeps it at 0.1.")
    with pytest.raises(NotConnected, match="does not accept infinite numbers"):
        change(reader, "max_speed", type=3, double_value=float("nan"))


def test_the_panel_shows_them_and_every_change(
    server: FoxgloveServer, reader: BridgeReader
) -> None:
    panel, ui = Parameters(node="/base"), RecordedUi()

    def send(command: Any, browser: int | None = None) -> None:
        parts = interfaces.service(command.type)
        cdr = encode(parts.request, command.request)
        future = reader.source.graph.call(command.service, command.type, cdr, 20.0)
        future.add_done_callback(lambda f: command.answered(decode(parts.response, f.result())))

    def text(name: str) -> str:
        show_panel(panel, State(more={"bridges": tuple(reader.source.bridges)}))
        rows = ui.widgets["1"].values["values"]["rows"]
        return next((row["text"] for row in rows if row["name"] == name), "")

    panel.build(ui, send)
    reader.until(lambda: text("name") == "robot")
    server.do("parameter /base.max_speed 1.25")
    reader.until(lambda: text("max_speed") == "1.25")


def parameters(*values: Any, id: Any = "all") -> str:
    return json.dumps({"op": "parameterValues", "parameters": list(values), "id": id})


def test_lies_about_parameters_are_bounded(
    liar: Callable[..., BridgeReader], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(foxglove_parameters, "MAX_PARAMETERS", 5)
    monkeypatch.setattr(foxglove_parameters, "MAX_PENDING", 3)
    names = ["", ".", "/a b.c", "/base.", "x" * 10_000]
    odd = [1e308, -(2**63), 2**70, [], [1, "a"], [[1]], {"a": [None]}, True, None]
    fine = {"name": "/base.speed", "value": "!", "type": "byte_array"}
    frames = [
        parameters(*({"name": name} for name in names)),
        parameters({"name": "/base.x", "value": 5, "type": 7}),
        parameters(5),
        json.dumps({"op": "parameterValues", "parameters": "all"}),
        parameters(fine, *({"name": f"/n{i}.x", "value": each} for i, each in enumerate(odd))),
        parameters(fine, id="never asked for"),
        *[parameters(fine, id=None)] * 1000,
    ]

    def script(connection: ServerConnection) -> None:
        connection.send(json.dumps({"op": "serverInfo", "capabilities": ["parameters"]}))
        for frame in frames:
            connection.send(frame)
        while True:
            request = json.loads(connection.recv())
            if request.get("id") == "1":
                values = [{"name": f"/base.{i}", "value": each} for i, each in enumerate(odd)]
                connection.send(parameters(fine, *values, *values, id="1"))

    reader = liar(script)
    reader.until(lambda: reader.bridge.parameters.changes)
    assert len(reader.bridge.parameters.nodes) <= 5
    assert reader.bridge.parameters.changes < 10
    reader.until(lambda: any(r.startswith("3 frames") for r in reader.bridge.remarks))
    result = values(reader, *map(str, range(len(odd))), "speed")
    assert [each.type for each in result] == [3, 2, 4, 4, 4, 4, 4, 1, 0, 4]
    calls = [get_all(reader) for _ in range(4)]
    assert "owes 3 answers" in str(calls[3].exception(20))
    assert "does not answer within 0.5 s" in str(calls[0].exception(20))
    assert "does not answer within 0.5 s" in str(get_all(reader).exception(20))


def test_a_change_that_the_bridge_does_not_confirm_has_failed(
    liar: Callable[..., BridgeReader],
) -> None:
    speed = {"name": "/base.speed", "value": 0.5, "type": "float64"}

    def script(connection: ServerConnection) -> None:
        connection.send(json.dumps({"op": "serverInfo", "capabilities": ["parameters"]}))
        connection.send(parameters(speed))
        while True:
            request = json.loads(connection.recv())
            if request["op"] == "setParameters":
                connection.send(parameters(id=request["id"]))

    reader = liar(script)
    reader.until(lambda: reader.bridge.parameters.nodes)
    rejection = change(reader, "speed", type=3, double_value=0.2)
    assert (rejection.successful, rejection.reason) == (
        False,
        "The bridge does not return this parameter.",
    )


def get_all(reader: BridgeReader) -> Future[bytes]:
    type = "rcl_interfaces/srv/ListParameters"
    request = encode(interfaces.service(type).request, {})
    return reader.source.graph.call("/base/list_parameters", type, request, 0.5)

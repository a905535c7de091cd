"""Strangers are refused, and browsers may only do what webviz offers them."""

from __future__ import annotations

import http.client
import socket
import threading
from collections.abc import Callable
from typing import Any

import pytest
import viser
import websockets.exceptions

from webviz.edges.scene import CannotListen, PortInUse, open_server


def status(server: viser.ViserServer, *headers: tuple[str, str]) -> int:
    """The HTTP status of a request for the page with exactly these headers."""
    connection = http.client.HTTPConnection("127.0.0.1", server.get_port(), timeout=60)
    connection.putrequest("GET", "/", skip_host=True)
    for name, value in headers:
        connection.putheader(name, value.replace("PORT", str(server.get_port())))
    connection.endheaders()
    answer = connection.getresponse()
    answer.read()
    connection.close()
    return answer.status


@pytest.mark.parametrize(
    "host", ["127.0.0.1:PORT", "localhost:PORT", "LOCALHOST:PORT", "[::1]:PORT", "localhost:9000"]
)
def test_the_page_is_served_under_the_names_of_this_machine(
    server: viser.ViserServer, host: str
) -> None:
    assert status(server, ("Host", host)) == 200
    assert status(server, ("Host", host), ("Origin", f"http://{host}")) == 200


@pytest.mark.parametrize(
    "host",
    [
        "evil.example:PORT",
        "10.0.0.7:PORT",
        "",
        "[",
        "localhost.evil",
        "x@127.0.0.1:PORT",
        "127.0.0.1/x",
        "127.0.0.1#x",
        "127.0.0.1?x",
        "127.0.0.1:",
        "[::1",
    ],
)
def test_the_page_is_refused_under_another_name(server: viser.ViserServer, host: str) -> None:
    assert status(server, ("Host", host)) == 403


def test_a_request_with_two_hosts_is_refused(server: viser.ViserServer) -> None:
    assert status(server, ("Host", "localhost:PORT"), ("Host", "evil.example")) != 200


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", "http://localhost:1", "http://127.0.0.1.evil:PORT"]
)
def test_a_page_of_another_origin_is_refused(server: viser.ViserServer, origin: str) -> None:
    assert status(server, ("Host", "127.0.0.1:PORT"), ("Origin", origin)) == 403


def test_a_websocket_from_another_origin_is_refused(call: Callable[..., Any]) -> None:
    with pytest.raises(websockets.exceptions.InvalidStatus, match="403"):
        call(Origin="http://evil.example")


def test_a_name_that_was_allowed_is_served() -> None:
    server = open_server(port=0, allowed_hosts=["robot.local"])
    try:
        assert status(server, ("Host", "robot.local:PORT")) == 200
        assert status(server, ("Host", "other.local:PORT")) == 403
    finally:
        server.stop()


def test_a_server_on_every_interface_is_served_under_any_address_but_not_under_any_name() -> None:
    server = open_server("0.0.0.0", 0)
    try:
        assert status(server, ("Host", "192.168.1.5:PORT")) == 200
        assert status(server, ("Host", "evil.example:PORT")) == 403
    finally:
        server.stop()


def test_a_taken_port_is_an_error_and_not_another_port(server: viser.ViserServer) -> None:
    with pytest.raises(
        PortInUse, match=rf"^Port {server.get_port()} of 127.0.0.1 is in use\. [^.]*"
    ):
        open_server(port=server.get_port())


@pytest.mark.parametrize("port", [-1, 65536, 99999])
def test_a_port_that_there_is_not_is_refused(port: int) -> None:
    with pytest.raises(CannotListen, match=rf"^{port} is not a valid port\. "):
        open_server(port=port)


def test_an_address_of_another_machine_is_an_error_in_words() -> None:
    with pytest.raises(CannotListen, match=r"^Cannot listen on port 0 of 192\.0\.2\.1: "):
        open_server("192.0.2.1", 0)


def test_visers_environment_variable_does_not_move_the_port(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    monkeypatch.setenv("_VISER_PORT_OVERRIDE", str(port))
    server = open_server(port=0)
    try:
        assert server.get_port() != port
    finally:
        server.stop()


def test_a_stopped_server_leaves_no_thread_no_port_and_no_word(
    capfd: pytest.CaptureFixture[str], wait_until: Callable[[Callable[[], bool]], None]
) -> None:
    before = set(threading.enumerate())
    server = open_server(port=0)
    port = server.get_port()
    server.stop()
    wait_until(lambda: set(threading.enumerate()) <= before)
    socket.create_server(("127.0.0.1", port)).close()
    assert capfd.readouterr() == ("", "")


@pytest.fixture
def widgets(server: viser.ViserServer) -> dict[str, Any]:
    gui = server.gui
    return {
        "slider": gui.add_slider("slider", 0.0, 1.0, 0.1, 0.5),
        "steps": gui.add_slider("steps", 0, 10, 1, 5),
        "number": gui.add_number("number", 1.5, min=0.0),
        "count": gui.add_number("count", 3),
        "check": gui.add_checkbox("check", False),
        "text": gui.add_text("text", "hello"),
        "choice": gui.add_dropdown("choice", ("a", "b")),
        "rgb": gui.add_rgb("rgb", (1, 2, 3)),
        "vector": gui.add_vector3("vector", (1.0, 2.0, 3.0), max=(9.0, 9.0, 9.0)),
        "off": gui.add_checkbox("off", False, disabled=True),
        "done": gui.add_checkbox("done", False),
    }


def assign(peer: Any, handle: Any, **updates: Any) -> None:
    peer.send({"type": "GuiUpdateMessage", "uuid": handle._impl.uuid, "updates": updates})


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("slider", 0.7),
        ("slider", 1),
        ("steps", 7),
        ("number", 99.5),
        ("count", -4),
        ("check", True),
        ("text", "world"),
        ("choice", "b"),
        ("rgb", [255, 0, 0]),
        ("vector", [0, 0, 9.0]),
    ],
)
def test_a_value_that_a_widget_offers_is_taken(
    name: str,
    value: Any,
    widgets: dict[str, Any],
    call: Callable[..., Any],
    wait_until: Callable[[Callable[[], bool]], None],
) -> None:
    assign(call(), widgets[name], value=value)
    expected = tuple(value) if isinstance(value, list) else value
    wait_until(lambda: widgets[name].value == expected)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("slider", 99),
        ("slider", -0.1),
        ("slider", float("nan")),
        ("slider", "0.2"),
        ("slider", True),
        ("steps", 1.5),
        ("number", -1.0),
        ("number", float("inf")),
        ("number", None),
        ("check", 1),
        ("text", 5),
        ("text", "x" * 1_000_000),
        ("choice", "zzz"),
        ("choice", ["a"]),
        ("rgb", [256, 0, 0]),
        ("rgb", [0, 0]),
        ("rgb", [0.5, 0, 0]),
        ("vector", [0, 0, 10]),
        ("vector", [0, 0, float("nan")]),
        ("vector", {"a": 1}),
        ("off", True),
    ],
)
def test_a_value_that_a_widget_does_not_offer_is_ignored(
    name: str,
    value: Any,
    widgets: dict[str, Any],
    call: Callable[..., Any],
    wait_until: Callable[[Callable[[], bool]], None],
) -> None:
    before = widgets[name].value
    peer = call()
    assign(peer, widgets[name], value=value)
    assign(peer, widgets["done"], value=True)
    wait_until(lambda: widgets["done"].value)
    assert widgets[name].value == before


def test_only_the_value_of_a_widget_can_be_set(
    widgets: dict[str, Any],
    call: Callable[..., Any],
    wait_until: Callable[[Callable[[], bool]], None],
) -> None:
    peer = call()
    assign(peer, widgets["slider"], removed=True)
    assign(peer, widgets["slider"], value=0.1, update_cb=[])
    assign(peer, widgets["done"], value=True)
    wait_until(lambda: widgets["done"].value)
    assert not widgets["slider"]._impl.removed
    assert widgets["slider"].value == 0.5


def test_a_browsers_own_widgets_are_guarded_as_well(
    server: viser.ViserServer,
    call: Callable[..., Any],
    wait_until: Callable[[Callable[[], bool]], None],
) -> None:
    peer = call()
    peer.look()
    wait_until(lambda: len(server.get_clients()) == 1)
    slider = next(iter(server.get_clients().values())).gui.add_slider("own", 0.0, 1.0, 0.1, 0.5)
    assign(peer, slider, value=7.0)
    assign(peer, slider, update_cb=[])
    assign(peer, slider, value=0.9)
    wait_until(lambda: slider.value == 0.9)
    assert slider._impl.update_cb == []


def test_buttons_can_be_pressed(
    server: viser.ViserServer,
    call: Callable[..., Any],
    wait_until: Callable[[Callable[[], bool]], None],
) -> None:
    pressed: list[str] = []
    button = server.gui.add_button("go")
    group = server.gui.add_button_group("way", ("left", "right"))
    button.on_click(lambda _: pressed.append("go"))
    group.on_click(lambda event: pressed.append(event.target.value))
    peer = call()
    peer.look()
    wait_until(lambda: len(server.get_clients()) == 1)
    assign(peer, button, value=True)
    wait_until(lambda: pressed == ["go"])
    assign(peer, group, value="right")
    wait_until(lambda: pressed == ["go", "right"])


@pytest.mark.parametrize(
    "message",
    [
        b"\xff garbage",
        b"\x80",
        {"type": ["ViewerCameraMessage"]},
        {"type": "ShareUrlRequest"},
        {"type": "NoSuchMessage"},
        {"type": "GuiUpdateMessage", "uuid": [], "updates": {"value": 1}},
        {"type": "GuiUpdateMessage"},
        {"type": "GuiUpdateMessage", "uuid": "a", "updates": {"value": 1}, "more": 1},
        {"type": "GetRenderResponseMessage", "payload": b"", "render_uuid": "a"},
        {"type": "ViewerCameraMessage", "wxyz": "abcd"},
        {"type": "CommandTriggerMessage", "uuid": 3},
        {
            "type": "TransformControlsUpdateMessage",
            "name": "a",
            "wxyz": [1, 0, 0, 0],
            "position": [0, 0, float("nan")],
        },
    ],
)
def test_a_message_that_webviz_does_not_know_is_dropped_and_the_next_one_heard(
    message: Any,
    server: viser.ViserServer,
    widgets: dict[str, Any],
    call: Callable[..., Any],
    wait_until: Callable[[Callable[[], bool]], None],
) -> None:
    peer = call()
    peer.send(message)
    assign(peer, widgets["done"], value=True)
    wait_until(lambda: widgets["done"].value)
    assert server._share_tunnel is None

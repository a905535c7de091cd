"""Untrusted clients are refused, and browsers may only do what webviz offers them."""

from __future__ import annotations

import http.client
import socket
import threading
from typing import Any

import pytest
import viser
import websockets.exceptions
from several import Make
from viser_internals import is_shared, state_of
from waiting import until

from webviz.scene import CannotListen, PortInUse, open_server


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


def test_a_websocket_from_another_origin_is_refused(call: Make) -> None:
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
    capfd: pytest.CaptureFixture[str],
) -> None:
    before = set(threading.enumerate())
    server = open_server(port=0)
    port = server.get_port()
    server.stop()
    until(lambda: set(threading.enumerate()) <= before)
    socket.create_server(("127.0.0.1", port)).close()
    assert capfd.readouterr() == ("", "")


def test_nothing_that_viser_shows_itself_can_be_operated(
    server: viser.ViserServer,
    call: Make,
) -> None:
    pressed: list[str] = []
    gui = server.gui
    check, upload = gui.add_checkbox("check", False), gui.add_upload_button("upload")
    form, command = gui.add_form("form"), gui.add_command("command")
    gui.add_button("go").on_click(lambda _: pressed.append("go"))
    upload.on_upload(lambda _: pressed.append("upload"))
    command.on_trigger(lambda _: pressed.append("command"))
    peer = call()
    own = {"uuid": state_of(check).uuid}
    for message in (
        {"type": "GuiUpdateMessage", "updates": {"value": True}} | own,
        {"type": "GuiUpdateMessage", "updates": {"removed": True}} | own,
        {"type": "GuiFormDirtyMessage", "uuid": state_of(form).uuid},
        {"type": "GuiFormSubmitMessage", "uuid": state_of(form).uuid},
        {"type": "GuiButtonHoldMessage", "frequency": 10.0} | own,
        {"type": "CommandTriggerMessage", "uuid": state_of(command).uuid},
        {
            "type": "FileTransferStartUpload",
            "source_component_uuid": state_of(upload).uuid,
            "transfer_uuid": "a",
            "filename": "a",
            "mime_type": "",
            "part_count": 1,
            "size_bytes": 1,
        },
    ):
        peer.send(message)
    peer.look()
    until(lambda: len(server.get_clients()) == 1)
    assert not check.value
    assert not state_of(check).removed
    assert pressed == []
    assert "GuiFormDirtyMessage" not in {message["type"] for message in call().replay()}


@pytest.mark.parametrize(
    "message",
    [
        b"\xff garbage",
        b"\x80",
        {"type": ["ViewerCameraMessage"]},
        {"type": "ShareUrlRequest"},
        {"type": "NoSuchMessage"},
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
    call: Make,
) -> None:
    peer = call()
    peer.send(message)
    peer.look()
    until(lambda: len(server.get_clients()) == 1)
    assert not is_shared(server)

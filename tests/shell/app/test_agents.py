"""Agents: what they see and read, and what their role lets them do, through the protocol's SDK."""

from __future__ import annotations

import asyncio
import base64
import io
import socket
import sys
import threading
from collections.abc import Awaitable, Callable, Coroutine, Iterator
from concurrent.futures import ThreadPoolExecutor
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, TypeVar

import httpx2
import numpy as np
import PIL.Image
import pytest
from mcp.client.client import Client
from mcp.client.stdio import StdioServerParameters, stdio_client
from mcp.client.streamable_http import streamable_http_client
from waiting import until

import webviz
from webviz.api.roles import Role
from webviz.data.messages import encode
from webviz.server.access.access import Access
from webviz.server.access.tokens import make
from webviz.shell.agents.agent_tools import AgentTools
from webviz.shell.agents.caller import AgentCaller
from webviz.shell.agents.server import HttpServer, make_server
from webviz.shell.testing.messages import header
from webviz.shell.testing.source import HandFedSource

SCAN = {"angle_max": 0.3, "angle_increment": 0.1, "range_max": 9.0, "ranges": [1.0, 2.0, 3.0, 2.0]}
Call = Callable[..., str]
T = TypeVar("T")


@pytest.fixture
def journal() -> list[str]:
    return []


@pytest.fixture
def tools(viewer: webviz.Viewer, journal: list[str]) -> AgentTools:
    return AgentTools(viewer, lambda who, text: journal.append(f"{who.name}: {text}"))


def finished(work: Coroutine[Any, Any, T]) -> T:
    """The outcome of asynchronous work; the browser of other tests has a loop in this thread."""
    with ThreadPoolExecutor(1) as thread:
        return thread.submit(asyncio.run, work).result()


def answers_of(tools: AgentTools, role: Role, *calls: tuple[str, dict[str, Any]]) -> list[str]:
    """The answers to calls of one agent."""

    async def work() -> list[str]:
        server = make_server(tools, lambda: AgentCaller("ada", role))
        async with Client(server) as client:
            answers = [await client.call_tool(name, values) for name, values in calls]
            return [each.content[0].text for each in answers]  # pyright: ignore[reportAttributeAccessIssue]

    return finished(work())


def publish(source: HandFedSource) -> None:
    values = SCAN | {"header": header("laser", source.now)}
    source.put("/scan", "sensor_msgs/msg/LaserScan", encode("sensor_msgs/msg/LaserScan", values))


def test_one_call_explains_a_missing_scan(
    viewer: webviz.Viewer, source: HandFedSource, tools: AgentTools, journal: list[str]
) -> None:
    viewer.config = {"fixed_frame": "map", "displays": [{"type": "LaserScan", "name": "Scan"}]}
    publish(source)
    (answer,) = answers_of(tools, Role.WATCHER, ("explain", {"display": "Scan"}))
    findings, _, statuses = answer.partition("\nFixed frame: map.\n")
    first = "Findings, in the order of repair:\nERROR TF001: No node publishes transforms."
    assert findings.startswith(first)
    assert " Scan (LaserScan, id display" in statuses
    assert '"laser" has no pose in "map"' in statuses
    assert journal == ["ada: asked what is wrong with Scan"]


def test_messages_topics_and_transforms_are_given_in_sentences(
    viewer: webviz.Viewer, source: HandFedSource, tools: AgentTools
) -> None:
    publish(source)
    stop = threading.Event()

    def keep_publishing() -> None:
        while not stop.wait(0.05):
            publish(source)

    thread = threading.Thread(target=keep_publishing)
    thread.start()
    try:
        topics, message, none, missing = answers_of(
            tools,
            Role.WATCHER,
            ("topics", {}),
            ("read", {"topic": "/scan"}),
            ("read", {"topic": "/scna"}),
            ("transform", {"target": "map", "source": "laser"}),
        )
    finally:
        stop.set()
        thread.join()
    assert "/scan: sensor_msgs/msg/LaserScan from /test" in topics
    assert "header.frame_id: 'laser'" in message
    assert "ranges: 4 values [1, 2, 3, 2]" in message
    assert "Did you mean `/scan`?" in none
    assert "laser" in missing


def test_a_role_decides_what_an_agent_may_do(
    viewer: webviz.Viewer, tools: AgentTools, journal: list[str], tmp_path: Path
) -> None:
    frame = ("act", {"command": "SetFixedFrame", "fields": {"frame": "odom"}})
    (refusal,) = answers_of(tools, Role.WATCHER, frame)
    assert "SetFixedFrame needs an operator" in refusal
    assert viewer.fixed_frame == "map"
    assert journal == ["ada: was refused SetFixedFrame"]
    (answer,) = answers_of(tools, Role.OPERATOR, frame)
    assert (viewer.fixed_frame, answer) == ("odom", "Done.")
    assert journal[1:] == ["ada: SetFixedFrame {'frame': 'odom'}"]
    elsewhere = tmp_path / "stolen.yaml"
    answers = answers_of(
        tools,
        Role.OWNER,
        ("act", {"command": "Save", "fields": {"path": str(elsewhere)}}),
        ("act", {"command": "Nothing"}),
        ("act", {"command": "SetFixedFrame", "fields": {"frme": "odom"}}),
        ("explain", {"display": "Scan"}),
    )
    assert "Pages open and save config files in" in answers[0]
    assert not elsewhere.exists()
    assert "Unknown command `Nothing`" in answers[1]
    assert "unknown field `frme`" in answers[2]
    assert "There is no display `Scan`" in answers[3]


@pytest.fixture
def over_http(tools: AgentTools) -> Iterator[tuple[str, dict[str, str]]]:
    """Return where agents are served, and the secrets of tokens by their name."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    now = datetime.now(UTC)
    tokens = {"ada": make("ada", Role.WATCHER, now), "bob": make("bob", Role.OPERATOR, now)}
    access = Access(asks=True, others=tuple(tokens.values()))
    server = HttpServer(tools, access, "127.0.0.1", port)
    thread = threading.Thread(target=server.run)
    thread.start()
    until(lambda: _answers(port))
    yield (
        f"http://127.0.0.1:{port}/mcp",
        {name: token.secret for name, token in tokens.items()},
    )
    server.stop()
    thread.join()


def _answers(port: int) -> bool:
    with socket.socket() as probe:
        return probe.connect_ex(("127.0.0.1", port)) == 0


def test_a_token_over_http_gives_its_role_and_is_required(
    viewer: webviz.Viewer, over_http: tuple[str, dict[str, str]]
) -> None:
    url, secrets = over_http

    async def act(secret: str) -> str:
        headers = {"Authorization": f"Bearer {secret}"}
        async with (
            httpx2.AsyncClient(headers=headers) as http,
            Client(streamable_http_client(url, http_client=http)) as client,
        ):
            result = await client.call_tool(
                "act", {"command": "SetFixedFrame", "fields": {"frame": "odom"}}
            )
            return result.content[0].text  # pyright: ignore[reportAttributeAccessIssue]

    assert "needs an operator" in finished(act(secrets["ada"]))
    assert viewer.fixed_frame == "map"
    assert finished(act(secrets["bob"])) == "Done."
    for headers in ({}, {"Authorization": "Bearer guessed"}, {"Authorization": secrets["bob"]}):
        answer = httpx2.post(url, headers=headers, json={"jsonrpc": "2.0", "id": 1, "method": "x"})
        assert (answer.status_code, "Bearer TOKEN" in answer.text) == (401, True)
    foreign = {"Authorization": f"Bearer {secrets['bob']}", "Host": "evil.example"}
    assert httpx2.post(url, headers=foreign, json={}).status_code == 421


def test_a_program_that_speaks_on_its_standard_streams(tmp_path: Path) -> None:
    """Pictures, and what is at one of their pixels."""
    config = tmp_path / "grid.yaml"
    config.write_text(
        "version: 1\nview: {type: TopDownOrtho, scale: 40}\n"
        "displays: [{type: Axes, length: 4, radius: 1}]\n"
    )
    command = ["-m", "webviz", "mcp", "--port", "0", "--no-autosave", "-d", str(config)]

    async def work(client: Client) -> tuple[list[Any], str]:
        result = await client.call_tool("see", {"views": [{"type": "Orbit", "distance": 9}, None]})
        at = await client.call_tool("select", {"x": 440, "y": 300})
        return [*result.content], at.content[0].text  # pyright: ignore[reportAttributeAccessIssue]

    pictures, at = run(StdioServerParameters(command=sys.executable, args=command), work)
    pixels = [
        np.asarray(PIL.Image.open(io.BytesIO(base64.b64decode(each.data)))) for each in pictures
    ]
    assert [each.shape for each in pixels] == [(600, 800, 3)] * 2
    assert pixels[1][300, 440].argmax() == 0, "the x axis is red"
    assert (pixels[0] != pixels[1]).any()
    assert "Axes" in at


def run(program: StdioServerParameters, work: Callable[[Client], Awaitable[Any]]) -> Any:
    async def talk() -> Any:
        async with Client(stdio_client(program)) as client:
            return await work(client)

    return finished(talk())

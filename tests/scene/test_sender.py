"""Many browsers: each is sent what it lacks, packed once for all."""

from __future__ import annotations

import numpy as np
import pytest
from several import Make
from viser import _messages as wire
from viser.infra._infra import ClientId
from viser_internals import queue_message
from websockets.frames import Frame, Opcode

from webviz.scene import ViserScene
from webviz.server.sending.frame_header import header


@pytest.mark.parametrize("size", [0, 125, 126, 65535, 65536, 70000])
def test_headers_are_those_of_whole_binary_frames(size: int) -> None:
    data = bytes(size)
    assert header(size) + data == Frame(Opcode.BINARY, data).serialize(mask=False)


def test_browsers_that_lack_the_same_receive_the_same_bytes(scene: ViserScene, call: Make) -> None:
    """Packed for each, the times in the frames would differ."""
    peers = [call() for _ in range(3)]
    for peer in peers:
        peer.replay()
    for points in (np.zeros(3), np.zeros(100_000)):
        scene.link.update("/webviz/a", {"points": points})
        scene.link.flush()
        assert len({peer.frame() for peer in peers}) == 1


def test_a_browser_is_not_sent_messages_that_exclude_it(scene: ViserScene, call: Make) -> None:
    peers = [call(), call()]
    for peer in peers:
        peer.replay()
    excluded = wire.SetPositionMessage("/webviz/a", (1.0, 0.0, 0.0))
    excluded.excluded_self_client = ClientId(0)
    with scene.link.atomic():
        queue_message(scene.link.server, excluded)
        scene.link.set_position("/webviz/b", (1.0, 0.0, 0.0))
    names = [[message["name"] for message in peer.receive()] for peer in peers]
    assert sorted(names) == [["/webviz/a", "/webviz/b"], ["/webviz/b"]]


def test_messages_queued_while_a_browser_joins_reach_it(scene: ViserScene, call: Make) -> None:
    for index in range(300):
        scene.link.set_position(f"/webviz/{index}", (0.0, 0.0, 0.0))
    peer = call()
    scene.link.set_position("/webviz/late", (0.0, 0.0, 0.0))
    scene.link.flush()
    names: set[str] = set()
    while "/webviz/late" not in names:
        names |= {message.get("name", "") for message in peer.receive()}
    assert {f"/webviz/{index}" for index in range(300)} <= names

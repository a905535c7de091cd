"""The first browser of a viewer to which nothing arrives."""

from __future__ import annotations

import pytest

import webviz
from tests.scene.conftest import Peer
from tests.support.guest import Served
from webviz.engine.loop import turn
from webviz.shell.testing.source import HandFedSource


def test_it_sees_the_scene_before_the_next_turn_of_an_idle_viewer(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(turn, "IDLE_S", 600.0)
    with webviz.Viewer(port=0, source=HandFedSource()) as viewer:
        viewer.config = {"displays": [{"type": "Grid", "name": "Ground"}]}
        peer = Peer(Served(viewer.port))
        peer.look()
        names = {message.get("name", "") for message in peer.replay()}
        while not any(name.endswith("/grid") for name in names):
            names |= {message.get("name", "") for message in peer.receive(timeout=20.0)}
        peer.close()

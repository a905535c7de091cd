"""A viewer of live topics, with a folder of bags that pages may open."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from bags import strings
from waiting import until

import webviz
from tests.support.guest import Guest, Served
from webviz.data.messages import encode
from webviz.shell.testing.messages import stamped_transform
from webviz.shell.testing.source import SECOND, HandFedSource

TF = "tf2_msgs/msg/TFMessage"


@dataclass
class LibraryViewer:
    """A viewer and what lies beside it.

    Args:
        viewer: of live topics, in whose memory there is a transform.
        folder: of the bags that pages may open.
        outside: a folder that was not named.
        guest: a page of the owner.
    """

    viewer: webviz.Viewer
    folder: Path
    outside: Path
    guest: Guest

    def store(self, name: str) -> dict[str, Any]:
        """Return the values of a store as a page gets them first."""
        self.guest.send("Watch", store=name)
        while (values := self.guest.receive("Values"))["store"] != name:
            pass
        self.guest.send("Unwatch", store=name)
        return dict(values["set"])

    def bags(self) -> list[str]:
        """Return the names of the bags that the page lists, once there are some."""
        self.guest.send("Watch", store="bags")
        while not (bags := self.guest.receive("Values")["set"].get("bags")):
            pass
        self.guest.send("Unwatch", store="bags")
        return sorted(bag["name"] for bag in bags)

    def names(self) -> tuple[str, ...]:
        """Return the names of the bag that is played."""
        playback = self.viewer.state.playback
        return () if playback is None else playback.names


@pytest.fixture
def library(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[LibraryViewer]:
    (work := tmp_path / "work").mkdir()
    (library := tmp_path / "library").mkdir()
    (outside := tmp_path / "outside").mkdir()
    monkeypatch.chdir(work)
    strings(0.0, 1.0, 2.0).write_file(library / "run.mcap")
    strings(0.0, 1.0).write_file(outside / "secret.mcap")
    source = HandFedSource()
    with contextlib.ExitStack() as stack:
        viewer = stack.enter_context(webviz.Viewer(port=0, source=source, library=[library]))
        guest = Guest(Served(viewer.port))
        stack.callback(guest.close)

        def remembered() -> bool:
            source.now += SECOND
            transform = stamped_transform("map", "base_link", source.now)
            source.put("/tf", TF, encode(TF, {"transforms": [transform]}))
            memory = viewer.state.memory
            return memory is not None and memory.size > 0

        until(remembered)
        yield LibraryViewer(viewer, library, outside, guest)

"""Viewers that play a bag or remember live topics, turn by turn."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from bags import START_NS, Bag, ns
from drives import CONFIG

from webviz.commands import Seek
from webviz.engine.commands import Command
from webviz.engine.loop import FrameLoop
from webviz.files.opening import parse
from webviz.shell.testing.recording import RecordingScene
from webviz.shell.testing.seeking import BagViewer, visible_nodes
from webviz.shell.testing.source import HandFedSource
from webviz.sources import Offer, Raw
from webviz.sources.bag.files import BagFiles
from webviz.sources.past_state import PlaybackState
from webviz.sources.recording.entries_history import WallClock

TURNS = 10_000
LOOK_S = 0.005
AGO_S = 9.0
"""Time in seconds since a drive began."""


@pytest.fixture
def theater(tmp_path: Path) -> Iterator[Callable[..., BagViewer]]:
    """Open a bag in a viewer; all are closed at the end."""
    viewers: list[BagViewer] = []

    def make(bag: Bag | Path | list[Path], config: str = "displays: []\n") -> BagViewer:
        paths = (
            bag.write_file(tmp_path / f"bag{len(viewers)}.mcap") if isinstance(bag, Bag) else bag
        )
        viewers.append(BagViewer(paths, config))
        return viewers[-1]

    yield make
    for each in viewers:
        each.close()


class SteadySource(HandFedSource):
    """A source whose time is that of the machine, as far as a drive is concerned."""

    began_s = 0.0
    """Monotonic time in seconds when the drive began."""

    def now_ns(self) -> int:
        return START_NS + ns(time.monotonic() - self.began_s)


class LiveDrive:
    """A viewer of live topics that have just carried a recorded drive."""

    def __init__(self, path: Path, config: str, ago_s: float = AGO_S) -> None:
        self.source = SteadySource()
        self.source.began_s = self.began_s = time.monotonic() - ago_s
        self.scene = RecordingScene()
        self.files = BagFiles([path])
        for channel in self.files.channels:
            self.source.topics[channel.topic] = Offer(channel.publishers, type=channel.type)
        self.loop = FrameLoop(parse(config, "the config"), self.source, self.scene, strict=True)
        self.loop.turn()
        for message in self.files.messages(self.files.channels, self.files.start_ns):
            at_s = (message.stamp_ns - START_NS) / 1e9
            raw = Raw(message.cdr, message.stamp_ns, self.began_s + at_s)
            self.source.inbox.put(message.topic, raw)
            self.loop.turn()

    def do(self, command: Command) -> str:
        answer = self.loop.enqueue(command)
        for _ in range(TURNS):
            self.loop.turn()
            if answer.done() and not self.loop.is_busy():
                return answer.result()
            self.source.inbox.arrived.wait(LOOK_S)  # for the disk
            self.source.inbox.arrived.clear()
        raise AssertionError("not done")

    def seek(self, at_s: float) -> None:
        """Show a time of the drive."""
        began_ns = WallClock().stamp_ns(self.began_s)
        self.do(Seek((began_ns - self.playback.start_ns) / 1e9 + at_s))

    @property
    def playback(self) -> PlaybackState:
        state = self.loop.state().playback
        assert state is not None
        return state

    def visible_nodes(self) -> dict[str, Any]:
        return visible_nodes(self.loop, self.scene)

    def close(self) -> None:
        self.loop.close()
        self.files.close()


@pytest.fixture
def drive(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[..., LiveDrive]]:
    monkeypatch.chdir(tmp_path)
    with contextlib.ExitStack() as stack:

        def make(bag: Bag, config: str = CONFIG, ago_s: float = AGO_S) -> LiveDrive:
            drive = LiveDrive(bag.write_file(tmp_path / "run.mcap"), config, ago_s)
            stack.callback(drive.close)
            return drive

        yield make

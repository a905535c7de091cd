"""A viewer that plays a bag, turn by turn."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from bags import Bag

from webviz.engine.commands import Command, Refresh
from webviz.engine.loop import FrameLoop
from webviz.engine.state import State
from webviz.files.opening import parse
from webviz.shell.testing.recording import RecordingScene
from webviz.sources.bag.source import BagSource
from webviz.sources.past_state import PlaybackState

TURNS = 10_000


class Theater:
    """A viewer of a bag that only runs in `turn`."""

    def __init__(self, paths: Path | list[Path], config: str) -> None:
        self.paths = paths
        self.source = BagSource(paths)
        self.scene = RecordingScene()
        self.loop = FrameLoop(parse(config, "the config"), self.source, self.scene, strict=True)
        self.turn()

    def turn(self) -> None:
        self.loop.turn()

    def do(self, command: Command) -> State:
        """Carry out a command; the state when it is answered."""
        answer = self.loop.enqueue(command)
        self.turn_until(answer.done)
        answer.result()
        return self.loop.state()

    def turn_until(self, is_reached: Callable[[], bool]) -> None:
        for _ in range(TURNS):
            if is_reached():
                return
            self.turn()
        raise AssertionError("not reached")

    @property
    def playback(self) -> PlaybackState:
        state = self.do(Refresh()).playback
        assert state is not None
        return state

    def nodes(self) -> list[Any]:
        """Poses and nodes that are seen."""
        # In which slot of a display a sample is drawn makes no difference.
        return sorted(((pose, node) for _, pose, node in self.scene.visible()), key=repr)

    def close(self) -> None:
        self.loop.close()
        self.source.close()


@pytest.fixture
def theater(tmp_path: Path) -> Iterator[Callable[..., Theater]]:
    """Open a bag in a viewer; all are closed at the end."""
    made: list[Theater] = []

    def make(bag: Bag | Path | list[Path], config: str = "displays: []\n") -> Theater:
        paths = bag.write(tmp_path / f"bag{len(made)}") if isinstance(bag, Bag) else bag
        made.append(Theater(paths, config))
        return made[-1]

    yield make
    for each in made:
        each.close()

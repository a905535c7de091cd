"""Comparison of a seek in a bag with playing it from the start."""

from __future__ import annotations

import contextlib
import dataclasses
import random
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from webviz import commands
from webviz.api.pictures import Packet
from webviz.engine.commands import Command
from webviz.engine.loop import FrameLoop
from webviz.engine.state import Row, State
from webviz.files import opening
from webviz.files.config import Config
from webviz.shell.app.reading import read_config
from webviz.shell.testing.recording import RecordingScene
from webviz.sources.bag.history import BagHistory
from webviz.sources.past_state import PlaybackState
from webviz.sources.player import Player

MAX_TURNS = 100_000
_DURATION = re.compile(r"\b\d+(\.\d+)? (ms|s|min|h)\b")
LOOK_S = 0.02
"""Time in seconds for slow work of displays, per turn."""


class BagViewer:
    """A viewer of a bag without a browser, which only runs in `turn`.

    Args:
        bag: a file or folder, or several, or a history, which is closed with the viewer.
        config: YAML, or a config; None for the displays of the bag's topics.
    """

    def __init__(
        self, bag: Path | Sequence[Path] | BagHistory, config: str | Config | None = None
    ) -> None:
        self.source = Player(bag if isinstance(bag, BagHistory) else BagHistory(bag))
        self.scene = RecordingScene()
        if config is None:
            config = read_config(None, self.source)
        elif isinstance(config, str):
            config = opening.parse(config, "the config")
        self.loop = FrameLoop(config, self.source, self.scene, strict=True)
        self.turn()

    def turn(self) -> None:
        """One turn of the frame loop."""
        self.loop.turn()

    def do(self, command: Command) -> State:
        """Carry out a command, turn until it is answered and drawn, and return the state then.

        Raises:
            webviz.Error: it is refused.
        """
        answer = self.loop.enqueue(command)
        self.turn_until(answer.done)
        answer.result()
        self.settle()
        return self.loop.state()

    def play_to(self, at_s: float) -> None:
        """Play from the position to a time, in seconds from the start, as fast as possible."""
        at_ns = self.source.history.start_ns + round(at_s * 1e9)
        while self.source.reached_ns < at_ns:
            self.source.play_step(at_ns)
            self.turn()
            self.settle()

    def settle(self) -> None:
        """Turn until the slow work of displays is drawn."""
        self.turn()
        self.turn_until(lambda: not self.loop.is_busy())

    def turn_until(self, is_reached: Callable[[], bool]) -> None:
        """Turn until a condition holds.

        Raises:
            AssertionError: it does not for a long time.
        """
        for _ in range(MAX_TURNS):
            if is_reached():
                return
            self.source.inbox.arrived.clear()
            self.turn()
            if self.loop.is_busy():
                self.source.inbox.arrived.wait(LOOK_S)
        raise AssertionError("The viewer did not reach this state.")

    def visible_nodes(self) -> dict[str, Any]:
        """Return the nodes that are seen of each display, with their poses in the fixed frame."""
        return visible_nodes(self.loop, self.scene)

    @property
    def playback(self) -> PlaybackState:
        """The recording, and where in it the viewer is."""
        playback = self.do(commands.Refresh()).playback
        assert playback is not None
        return playback

    @property
    def rows(self) -> Sequence[Row]:
        """The displays with their statuses."""
        return self.loop.state().rows

    def close(self) -> None:
        """End the viewer and close the bag."""
        self.loop.close()
        self.source.close()


def check_seeks(
    bag: Path | Sequence[Path],
    config: str | Config | None = None,
    *,
    times: Sequence[float] = (),
    count: int = 10,
    seed: int = 0,
) -> None:
    """Check that after a seek each display shows what it shows when the bag is played to there.

    Statuses are compared, too, but for the durations in their texts, which are read once a second.

    Use it for displays that override `Display.lookback`, `history`, `fold` or `accept`. Which
    messages are dropped when more than `filter_size` wait for transforms depends on the speed of
    playing; choose a large one for bags whose transforms come late.

    Args:
        bag: a file or folder, or several.
        config: YAML, or a config; None for the displays of the bag's topics.
        times: where to seek in this order, in seconds from the start; none for times by chance.
        count: number of times by chance.
        seed: of chance.

    Raises:
        AssertionError: a display differs; names it and the time.
    """
    with _opened(bag, config) as sought, _opened(bag, config) as played:
        duration_s = (sought.source.history.end_ns - sought.source.history.start_ns) / 1e9
        chance = random.Random(seed)
        targets = times or [round(chance.uniform(0, duration_s), 3) for _ in range(count)]
        truth: dict[float, tuple[dict[str, Any], Mapping[str, str]]] = {}
        for at_s in sorted(set(targets)):
            played.play_to(at_s)
            played.settle()
            truth[at_s] = played.visible_nodes(), _statuses(played)
        for before_s, at_s in zip([0.0, *targets], targets, strict=False):
            sought.do(commands.Seek(at_s))
            nodes, statuses = truth[at_s]
            when = f"differs at {at_s:g} s after a seek from {before_s:g} s"
            for display, sought_nodes in sought.visible_nodes().items():
                if plain(sought_nodes) != plain(nodes[display]):
                    raise AssertionError(
                        f"{display} {when}:\n"
                        f"  sought: {_summary(sought_nodes)}\n  played: {_summary(nodes[display])}"
                    )
            reported = _statuses(sought)
            for key in sorted(reported.keys() | statuses.keys()):
                if reported.get(key) != statuses.get(key):
                    raise AssertionError(
                        f"The status {key} {when}:\n"
                        f"  sought: {reported.get(key)}\n  played: {statuses.get(key)}"
                    )


def visible_nodes(loop: FrameLoop, scene: RecordingScene) -> dict[str, Any]:
    """Return the nodes that are seen of each display, with their poses in the fixed frame."""
    by_display: dict[str, Any] = {}
    for row in loop.state().rows:
        nodes = [(pose, node) for _, pose, node in scene.visible(f"{row.id}/")]
        # In which slot of a display a sample is drawn makes no difference.
        by_display[f"{row.id} {row.name}"] = sorted(nodes, key=repr)
    return by_display


def plain(value: Any) -> Any:
    """Return what a value of dataclasses, sequences and arrays consists of, for comparison.

    Pictures compare equal only to those of the same message object.
    """
    if isinstance(value, np.ndarray):
        return value.dtype.str, value.shape, value.tobytes()
    if isinstance(value, Packet):
        return plain(value.data)  # packets are numbered as they arrive
    if isinstance(value, msgspec.Struct):  # a message, whose class each viewer may define anew
        return type(value).__name__, plain(msgspec.structs.astuple(value))
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        fields = dataclasses.fields(value)
        return type(value).__name__, [
            plain(getattr(value, field.name)) for field in fields if field.compare
        ]
    if isinstance(value, list | tuple):
        return [plain(each) for each in value]
    return repr(value) if isinstance(value, float) else value  # NaN differs from itself


@contextlib.contextmanager
def _opened(bag: Path | Sequence[Path], config: str | Config | None) -> Iterator[BagViewer]:
    with contextlib.closing(BagViewer(bag, config)) as viewer:
        yield viewer


def _statuses(viewer: BagViewer) -> Mapping[str, str]:
    """Return the level and text of each status, without durations."""
    state = viewer.loop.state()
    # Of a file, more becomes known the more of it was read.
    statuses = {key: status for key, status in state.statuses.items() if key != "Bag"}
    # How well displays agree is looked at once a second.
    others = {runner.id: runner.external_statuses.keys() for runner in viewer.loop.runners()}
    for row in state.rows:
        statuses |= {
            f"{row.id} {row.name}: {key}": status
            for key, status in row.statuses.items()
            if key not in others.get(row.id, ())
        }
    return {key: f"{s.level.name} {_DURATION.sub('_', s.text)}" for key, s in statuses.items()}


def _summary(nodes: Any) -> str:
    return f"{len(nodes)} nodes: {str(nodes)[:2000]}"

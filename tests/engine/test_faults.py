"""Whatever raises, the frame loop goes on, and says what went wrong."""

from __future__ import annotations

import gc
import inspect
import sys
import weakref
from collections.abc import Mapping, Sequence
from operator import attrgetter
from typing import Annotated, Any

import pytest
from bench import Bench, Benches
from dots import SECOND

from webviz import (
    Comparable,
    Context,
    Display,
    Draggable,
    Frames,
    Hit,
    Input,
    Keep,
    Lookback,
    Sample,
    Selective,
    SelfPlacing,
    Sweep,
    Topic,
)
from webviz.api.capabilities import CAPABILITIES
from webviz.api.connection import GraphConnection
from webviz.api.handles import Control, Drag, Handle
from webviz.api.nodes import Pose
from webviz.api.status import Level
from webviz.commands import DragHandle, Identify, Refresh, SetBackground, SetProperty
from webviz.engine.commands import NodePicks
from webviz.engine.parts.displays import DisplaysPart

DOT = Pose()
KNOB = {"m1": Handle("Knob", None, (Control("", "button"),))}


class Unprintable(Exception):
    """Exception whose text raises one, too."""

    def __str__(self) -> str:
        raise ValueError("not even this can be told")


class Sound(Display):
    """A dot per turn, to see that the rest goes on."""

    turns: int = 0

    def tick(self, ctx: Context) -> None:
        self.turns += 1
        ctx.points("dot", [[self.turns, 0, 0]], (0, 0, 0), 0.1)


class Faulty(Display, Comparable, Draggable, Selective, Sweep):
    """Raises in one of its hooks."""

    topic: Annotated[Topic, Input("geometry_msgs/msg/PoseStamped")] = Topic("/pose")
    hook: str = ""
    leaves: bool = False

    def _raise_in(self, hook: str) -> None:
        if hook == self.hook:
            if self.leaves:
                sys.exit(3)
            raise Unprintable

    def new_state(self) -> None:
        self._raise_in("new_state")

    def history(self) -> Keep:
        self._raise_in("history")
        return Keep()

    def lookback(self, name: str) -> Lookback:
        self._raise_in("lookback")
        return Lookback()

    def listens(self, name: str) -> bool:
        self._raise_in("listens")
        return True

    def waits(self, name: str) -> bool:
        self._raise_in("waits")
        return True

    def duration_ns(self, message: Any) -> int:
        self._raise_in("duration_ns")
        return 0

    def accept(self, new: Sample, buffered: Sequence[Sample]) -> bool | str:
        self._raise_in("accept")
        return True

    def depends(self, ctx: Context) -> object:
        self._raise_in("depends")
        return None

    def draw(self, sample: Sample, ctx: Context) -> None:
        self._raise_in("draw")

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        self._raise_in("draw_all")

    def tick(self, ctx: Context) -> None:
        self._raise_in("tick")
        ctx.points("dot", [[0, 0, 0]], (0, 0, 0), 0.1)

    def inspect(self, hit: Hit, ctx: Context) -> None:
        self._raise_in("inspect")

    def consistency_input(self, samples: Sequence[Sample], ctx: Context) -> None:
        self._raise_in("consistency_input")

    def communicate(self, connection: GraphConnection, ctx: Context) -> None:
        self._raise_in("communicate")

    def handles(self, ctx: Context) -> Mapping[str, Handle]:
        self._raise_in("handles")
        return KNOB

    def drag(self, drag: Drag, connection: GraphConnection, ctx: Context) -> None:
        self._raise_in("drag")


class FaultyFold(Faulty, SelfPlacing):
    """Raises when it folds, or when it places that."""

    def fold(self, name: str, sample: Sample, state: Any) -> Any:
        self._raise_in("fold")
        return sample.message

    def places(self, name: str) -> bool:
        self._raise_in("places")
        return True

    def place(self, message: Any, frames: Frames) -> None:
        self._raise_in("place")


HOOKS = sorted(
    name
    for base in (Display, *CAPABILITIES)
    for name, hook in vars(base).items()
    if inspect.isfunction(hook)
)


def feed(b: Bench) -> None:
    """Let the next turn have something to do in every part."""
    b.source.now += SECOND // 10
    b.clock += 0.3
    b.transform("map", "base", b.source.now)
    b.pose("/pose", "base", b.source.now)


@pytest.mark.parametrize("leaves", [False, True], ids=["raises", "exits"])
@pytest.mark.parametrize("hook", HOOKS)
def test_an_exception_of_a_hook_is_a_status_of_its_display_and_logged_once(
    bench: Benches, caplog: pytest.LogCaptureFixture, hook: str, leaves: bool
) -> None:
    faulty_class = FaultyFold if hook in ("fold", "place", "places") else Faulty
    faulty = faulty_class(name="Faulty", hook=hook, leaves=leaves)
    sound = Sound(name="Sound")
    b = bench(faulty, sound, strict=False)
    dot = NodePicks("display1/tick/", "dot", ((1, 0, (0.0, 0.0, 0.0), None),))
    for _ in range(5):
        feed(b)
        b.viewer.enqueue(Identify(dot))
        b.viewer.enqueue(DragHandle("display1", Drag("m1", 0, "press")))
        b.turn(keep_up=True)
    before = sound.turns
    feed(b)
    level, text = b.statuses(0)["Display"]
    assert level == "ERROR"
    assert ("SystemExit: 3" if leaves else "Unprintable") in text
    assert sound.turns > before
    assert len([record for record in caplog.records if record.exc_info]) == 1


PARTS = {
    "source.now_ns": "Source",
    "source.offers": "Source",
    "source.want": "Source",
    "source.inbox.drain": "Source",
    "source.inbox.received": "Topics",
    "source.inbox.dropped": "",
    "viewer._time.ros.step": "Time",
    "viewer._arrivals._transforms._listener.take": "Transforms",
    "viewer._showing._views.follow": "Views",
    "viewer._showing._views.followed": "Views",
    "scene.has_watchers": "Scene",
    "scene.flush": "Scene",
    "scene.set_background": "Scene",
    "scene.set_pose": "",
    "scene.upsert": "",
    "viewer._show": "Panel",
}
"""Hook the frame loop calls, and the key of the status that reports it; "" is the display's."""


@pytest.mark.parametrize("part", PARTS)
def test_an_exception_of_a_part_is_a_status_and_logged_once_and_the_rest_goes_on(
    bench: Benches,
    caplog: pytest.LogCaptureFixture,
    monkeypatch: pytest.MonkeyPatch,
    part: str,
) -> None:
    sound = Sound(name="Sound")
    b = bench(Faulty(name="Faulty"), sound, strict=False)
    path, _, name = part.rpartition(".")
    owner = attrgetter(path)(b)
    calls: list[int] = []

    def boom(*args: Any, **options: Any) -> None:
        calls.append(1)
        raise Unprintable

    feed(b)
    b.turn(keep_up=True)
    logged = []
    with monkeypatch.context() as patch:
        patch.setattr(owner, name, boom)
        before = sound.turns
        for shade in range(5):
            feed(b)
            answer = b.viewer.enqueue(SetBackground((shade, 0, 0)))
            b.turn(keep_up=True)
            assert answer.done()
            logged.append(len([record for record in caplog.records if record.exc_info]))
        assert calls
        assert sound.turns == before + 5
        state = b.viewer.state()
    rows = [status for row in state.rows for status in row.statuses.values()]
    statuses = [state.statuses[PARTS[part]]] if PARTS[part] else rows
    assert any(status.level is Level.ERROR and "Unprintable" in status.text for status in statuses)
    assert logged[0] in (1, 2), "two displays may have met it"
    assert logged[-1] == logged[0]


def test_a_command_that_raises_is_refused_and_the_next_is_done(
    bench: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    b = bench(Sound(name="Sound"), strict=False)

    def boom(*args: Any) -> None:
        raise Unprintable

    with monkeypatch.context() as patch:
        patch.setattr(b.viewer.get(DisplaysPart).list, "set", boom)
        command = b.viewer.enqueue(SetProperty("display1", "enabled", False))
        b.turn()
    assert "Unprintable" in str(command.exception())
    answer = b.viewer.enqueue(Refresh())
    b.turn()
    assert answer.result() == ""


@pytest.mark.parametrize("part", PARTS)
def test_strict_raises_exceptions_of_parts(
    bench: Benches, monkeypatch: pytest.MonkeyPatch, part: str
) -> None:
    b = bench(Faulty(name="Faulty"), Sound(name="Sound"))
    path, _, name = part.rpartition(".")
    owner = attrgetter(path)(b)

    def boom(*args: Any, **options: Any) -> None:
        raise Unprintable

    with monkeypatch.context() as patch:
        patch.setattr(owner, name, boom)
        feed(b)
        b.viewer.enqueue(SetBackground((1, 2, 3)))
        with pytest.raises(Unprintable):
            b.turn(keep_up=True)


def test_a_turn_that_raises_does_not_end_the_loop(
    bench: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    b = bench(strict=False)
    turns: list[int] = []
    arrived = b.source.inbox.arrived

    def boom() -> None:
        raise Unprintable

    def begin() -> None:
        """Begin a turn, with which there is nothing new."""
        turns.append(1)
        if len(turns) == 3:
            b.viewer.stop()

    monkeypatch.setattr(b.viewer.context, "is_watched", boom)
    monkeypatch.setattr(arrived, "clear", begin)
    b.viewer.run()
    assert len(turns) == 3
    b.viewer.update()
    assert b.viewer.statuses["Frame loop"].text.startswith("Frame loop failed: Unprintable")


def test_a_command_that_fails_leaves_memory_at_once(bench: Benches) -> None:
    b = bench(Sound(name="Sound"))
    errors: list[str] = []
    gc.collect()
    gc.disable()  # it stops all threads, for longer the more there is
    try:
        answer = b.viewer.enqueue(SetProperty("display1", "nothing", 1))
        waiting = weakref.ref(answer)
        answer.add_done_callback(lambda done: errors.append(str(done.exception())))
        b.until_done(answer)
        del answer
        assert errors
        assert errors[0].startswith("Not changed")
        assert waiting() is None
    finally:
        gc.enable()

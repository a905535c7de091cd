"""Parts of a viewer: each owns its commands and its fields of the state."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import pytest
from bench import Benches

from webviz import Error, commands
from webviz.api.status import Level, Status
from webviz.commands import Load, Pause, Refresh, Reset
from webviz.engine.commands import Command, FileCommand, Sender
from webviz.engine.feature import Feature
from webviz.engine.parts import Batches, Handler, Part, PartContext
from webviz.engine.parts.part import overrides
from webviz.engine.requests import Job, Refused
from webviz.engine.state import State
from webviz.shell.testing.source import SECOND

KINDS = (Command, FileCommand)
"""Bases of commands, which are not sent."""


class Boom(Exception):
    """Exception that no code expects."""


class Count(Command, frozen=True):
    """Count up."""

    step: int = 1


class Counter(Part):
    """A part that is not webviz's own."""

    name = "Counter"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self.count = 0
        self.senders: list[Sender] = []

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        return {Count: self._count}

    def reset(self) -> None:
        self.count = 0

    def state(self) -> Mapping[str, Any]:
        return {"count": (self.count, tuple(self.senders))}

    def statuses(self) -> Mapping[str, Status]:
        return {"Counter": Status(Level.OK, f"{self.count} so far.")}

    def _count(self, command: Count, sender: Sender) -> str:
        if command.step < 0:
            raise Error("A counter cannot go back. Reset it instead.")
        self.count += command.step
        self.senders.append(sender)
        return f"Counted to {self.count}."


class Ticker(Part):
    """Counts turns."""

    name = "Ticker"
    turns = 0

    def take(self, batches: Batches) -> None:
        self.turns += 1

    def state(self) -> Mapping[str, Any]:
        return {"turns": self.turns}


def test_a_part_that_is_added_does_its_commands_and_shows_its_state(bench: Benches) -> None:
    b = bench(parts=[Counter])
    b.do(Count())
    state = b.do(Count(2), Sender(browser=4))
    assert state.more["count"] == (3, (Sender(None), Sender(4)))
    assert b.ask(Count(0)) == "Counted to 3."
    assert state.statuses["Counter"].text == "3 so far."
    assert b.refusal(Count(-1)) == "A counter cannot go back. Reset it instead."
    assert b.do(Reset()).more["count"][0] == 0


class Listener(Part):
    """Notes what others have carried out."""

    name = "Listener"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self.commands: list[tuple[str, Sender]] = []

    def after(self, command: Command, sender: Sender) -> None:
        self.commands.append((type(command).__name__, sender))


def test_a_part_observes_commands_of_other_parts(bench: Benches) -> None:
    b = bench(parts=[Counter, Listener])
    b.do(Count(), Sender(browser=4))
    b.refusal(Count(-1))
    b.do(Load("displays: []", "x.yaml"))  # has a slow part
    assert b.viewer.get(Listener).commands == [("Count", Sender(4)), ("Load", Sender())]


HOOKS = sorted(
    name
    for name, hook in vars(Part).items()
    if inspect.isfunction(hook) and not name.startswith("_") and name != "watched"  # by pages
)
PARTS = [
    "Autosave",
    "Bags",
    "Black box",
    "Config",
    "Connection",
    "Counter",
    "Displays",
    "Doctor",
    "Driving",
    "Files",
    "Goals",
    "Handles",
    "History",
    "Inspected topics",
]
PARTS += [
    "Latency",
    "Layouts",
    "Outputs",
    "Own past",
    "Panels",
    "People",
    "Playback",
    "Plug-in panels",
    "Plugins",
    "Recording",
    "Report",
    "Rights",
    "Saved views",
    "Selection",
    "Settings",
    "Share",
    "TF",
    "Time",
    "Tools",
    "Topics",
    "Transforms",
    "Views",
    "What if",
]


@pytest.mark.parametrize("name", PARTS)
def test_a_part_whose_every_method_raises_does_not_stop_the_others(
    bench: Benches,
    monkeypatch: pytest.MonkeyPatch,
    caplog: pytest.LogCaptureFixture,
    tmp_path: Path,
    name: str,
) -> None:
    calls = set[str]()

    def boom(hook: str) -> Callable[..., None]:
        def call(*args: Any) -> None:
            calls.add(hook)
            raise Boom

        return call

    options: dict[str, Any] = {"strict": False, "autosave": tmp_path / "last.yaml"}
    whole = bench(parts=[Counter, Ticker], **options)
    (sound,) = (part for part in whole.viewer.parts if part.name == name)
    kinds = [*sound.handles]
    handlers = dict.fromkeys(kinds, boom("handles"))
    monkeypatch.setattr(type(sound), "handles", property(lambda _: handlers))
    b = bench(parts=[Counter, Ticker], **options)
    parts = {part.name: part for part in b.viewer.parts}
    assert sorted(parts) == sorted([*PARTS, "Ticker"])
    part = parts[name]
    hooks = {hook for hook in HOOKS if overrides(part, hook)}  # the others are not called
    before = b.viewer.get(Ticker).turns
    with monkeypatch.context() as patch:
        for hook in hooks:
            patch.setattr(part, hook, boom(hook))
        for kind in kinds:
            answer = b.viewer.enqueue(
                kind(**dict.fromkeys(kind.__struct_fields__))
            )  # never looked into
            b.turn(keep_up=True)
            assert "Boom" in str(answer.exception(0))
        b.source.now -= 10 * SECOND  # everything is reset
        state = b.do(Count(0)) if name != "Counter" else b.do(Refresh())
        b.viewer.update()
        if hooks:
            assert b.viewer.statuses[name].text.startswith(f"{name} failed: Boom")
            assert b.viewer.statuses[name].level is Level.ERROR
        assert state.more["turns"] > before + len(kinds)
        b.viewer.close()
    assert calls == {*hooks, *(["handles"] if kinds else ())}
    failed = [record for record in caplog.records if record.exc_info]
    assert len(failed) == bool(hooks or kinds)


def test_a_command_that_no_part_owns_is_refused(bench: Benches) -> None:
    b = bench()
    answer = b.viewer.enqueue(Count())
    b.turn()
    with pytest.raises(Refused, match=r"No part of this viewer handles Count\. Add one\."):
        answer.result(0)


def test_only_commands_about_files_have_a_slow_part(bench: Benches) -> None:
    class Slow(Part):
        @property
        def handles(self) -> Mapping[type[Command], Handler]:
            return {Count: lambda command, sender: Job(lambda: 1, str)}

    b = bench(parts=[Slow], strict=False)
    assert "no FileCommand" in b.refusal(Count())
    assert b.do(Refresh())


def test_two_parts_cannot_own_one_command(bench: Benches) -> None:
    class Other(Part):
        @property
        def handles(self) -> Mapping[type[Command], Handler]:
            return {Pause: lambda command, sender: None}

    with pytest.raises(ValueError, match="two parts handle Pause"):
        bench(parts=[Other])


def test_every_command_and_every_field_of_the_state_has_one_owner(bench: Benches) -> None:
    b = bench()
    parts = b.viewer.parts
    names = [name for part in parts for name in part.state()]
    assert len(set(names)) == len(names)
    # Features have others besides.
    assert {*State.__struct_fields__} <= {*names, "more"}
    mechanism = (part for part in parts if not isinstance(part, Feature))
    assert all(hasattr(State, name) for part in mechanism for name in part.state())
    public = [getattr(commands, name) for name in commands.__all__]
    command_types = {cls for cls in public if isinstance(cls, type) and issubclass(cls, Command)}
    assert {kind for part in parts for kind in part.handles} == command_types - {*KINDS}

"""Undo and redo of everything that changes displays, tools, panels, settings or saved views."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from typing import Any, Literal

import msgspec
from msgspec.structs import replace

from webviz.api.roles import Role
from webviz.engine.commands import Command, Sender
from webviz.engine.feature import Feature, command, store
from webviz.engine.parts.config import RESTORE, ConfigPart, Restore
from webviz.engine.parts.part import PartContext
from webviz.engine.store import PageStore
from webviz.features.undo.diff import ConfigDiff, UndoSnapshot, difference
from webviz.features.undo.rebasing import rebased
from webviz.files.config import ConfigError

MAX_STEPS = 100
SAME_S = 1.5
"""Changes of one property that follow each other within it are one step, as when it is dragged."""


class HistoryStep(msgspec.Struct, frozen=True):
    """Something that was changed.

    Args:
        number: of the change; undo and redo are changes too.
        label: what was done, in a few words.
        browser: that did it, None for a program.
        removed: name of what was removed, "" for other changes.
        restored: what was shown again of the last session, "" for other changes.
    """

    number: int
    label: str
    browser: int | None
    removed: str = ""
    restored: str = ""


class UndoHistory(PageStore, frozen=True):
    """Undo and redo steps, each with the newest first."""

    undo: tuple[HistoryStep, ...] = ()
    redo: tuple[HistoryStep, ...] = ()


class _UndoEntry(msgspec.Struct, frozen=True):
    """A step, and the snapshots around it."""

    step: HistoryStep
    before: UndoSnapshot
    after: UndoSnapshot


class UndoFeature(Feature):
    """The steps that can be taken back or done again, whichever browser or program did them."""

    name = "History"
    module = "undo.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._files = context.get(ConfigPart)
        self._undo: deque[_UndoEntry] = deque(maxlen=MAX_STEPS)
        self._redo: deque[_UndoEntry] = deque(maxlen=MAX_STEPS)
        self._count = 0
        self._last: tuple[float, Sender, tuple[str, str] | None] = (-SAME_S, Sender(), None)
        self._now = UndoSnapshot()
        self._now = self._snapshot()

    @store()
    def history(self, argument: str = "") -> UndoHistory:
        """Return the steps that can be undone and redone."""
        undo = tuple(entry.step for entry in reversed(self._undo))
        redo = tuple(entry.step for entry in reversed(self._redo))
        return UndoHistory(undo, redo)

    def state(self) -> Mapping[str, Any]:
        """Return the steps that can be undone and redone."""
        return {"history": self.history()}

    def after(self, command: Command, sender: Sender) -> None:
        """Note what a command has changed."""
        before, self._now = self._now, self._snapshot()
        change = difference(before, self._now)
        if not change.label:
            return
        if self._goes_on(change, sender):
            before = self._undo.pop().before
            change = difference(before, self._now)
        others = [each for each in self._redo if each.step.browser != sender.browser]
        self._redo = deque(others, MAX_STEPS)
        if change.label:  # else it is as it was before
            self._count += 1
            label, by = command.label or change.label, sender.browser
            restored = label.removeprefix(RESTORE) if isinstance(command, Restore) else ""
            step = HistoryStep(self._count, label, by, change.removed, restored)
            self._undo.append(_UndoEntry(step, before, self._now))

    def _goes_on(self, difference: ConfigDiff, sender: Sender) -> bool:
        """Return whether a step belongs to the one before."""
        now = self.context.clock()
        then, *same = self._last
        self._last = now, sender, difference.property
        if not self._undo:
            return False
        if sender.step:
            return same[0] == sender
        is_soon = now - then < SAME_S
        return is_soon and difference.property is not None and same == [sender, difference.property]

    @command(Role.OPERATOR)
    def undo(self, sender: Sender, steps: int = 1, own: bool = False) -> str:
        """Take back the newest steps that changed displays, tools, settings or saved views.

        Args:
            steps: how many.
            own: prefer those of the sender; what others have done since stays.
        """
        return self._travel("undo", steps, sender, own)

    @command(Role.OPERATOR)
    def redo(self, sender: Sender, steps: int = 1, own: bool = False) -> str:
        """Do again what was taken back.

        Args:
            steps: how many.
            own: prefer what the sender has taken back.
        """
        return self._travel("redo", steps, sender, own)

    def _travel(self, verb: Literal["undo", "redo"], steps: int, sender: Sender, own: bool) -> str:
        is_back = verb == "undo"
        back, forth = (self._undo, self._redo) if is_back else (self._redo, self._undo)
        participle = "Undone" if is_back else "Redone"
        if not back:
            raise ConfigError(f"There is nothing to {verb}.")
        labels = []
        snapshot = self._now
        for _ in range(max(1, min(steps, len(back)))):
            entry = _newest(back, sender if own else None)
            self._count += 1
            step = replace(entry.step, number=self._count, browser=sender.browser)
            forth.append(_UndoEntry(step, entry.after, entry.before))
            snapshot = rebased(snapshot, entry.after, entry.before)
            labels.append(entry.step.label)
        self._show(snapshot)
        self._now = self._snapshot()
        self._last = (-SAME_S, Sender(), None)
        return (
            f"{participle}: {labels[0]}."
            if len(labels) == 1
            else f"{participle}: {len(labels)} steps."
        )

    def _snapshot(self) -> UndoSnapshot:
        before, files = self._now, self._files
        return UndoSnapshot(
            files.settings.settings,
            files.displays.list.snapshots(before.displays),
            files.tools.snapshots(before.tools),
            files.panels.snapshots(before.panels),
            files.origin(),
        )

    def _show(self, snapshot: UndoSnapshot) -> None:
        files = self._files
        files.displays.list.restore(snapshot.displays)
        files.tools.restore(snapshot.tools)
        files.panels.restore(snapshot.panels)
        files.settings.settings = snapshot.settings
        files.views.start_with(snapshot.settings.view)
        files.set_origin(snapshot.origin)


def _newest(steps: deque[_UndoEntry], of: Sender | None) -> _UndoEntry:
    """Take the newest step, or that of a sender if it has one."""
    own = (at for at in reversed(range(len(steps))) if of and steps[at].step.browser == of.browser)
    at = next(own, len(steps) - 1)
    entry = steps[at]
    del steps[at]
    return entry

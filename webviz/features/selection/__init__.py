"""Selections of browsers in the scene, and the details displays report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from typing import Any, ClassVar

import msgspec

from webviz.api.errors import Error
from webviz.api.picking import Details
from webviz.api.roles import Role
from webviz.data.transforms.errors import format_stamp
from webviz.engine.commands import NodePicks, Sender
from webviz.engine.feature import Feature, command, store
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.part import PartContext
from webviz.engine.pipeline import Runner
from webviz.engine.pipeline.details import details_tree, first_line
from webviz.engine.pipeline.picking import PickedItem
from webviz.engine.state import Row
from webviz.engine.store import PageStore
from webviz.features.selection.statistics import Statistics, ValueRange

MAX_SELECTED = 1000
"""Things that one browser selects."""
MAX_LIVE = 50
"""Largest number of selected things whose values are kept up to date."""
EVERY_S = 0.5
"""Interval between updates."""
MAX_PAST = 20
"""Messages that are held for a selection alone, because newer ones have replaced them."""

CLICK_AGAIN = "It has been replaced since the click. Click again."
REPLACED = "A newer message has replaced this one; the values are those of the selected message."


class Thing(msgspec.Struct, frozen=True):
    """A selected item.

    Args:
        display, name: id and name of its display.
        title: of the item.
        tree: of values, see `webviz.data.messages.to_tree`.
        note: a sentence, or "".
    """

    display: str
    name: str
    title: str
    tree: Mapping[str, Any]
    note: str


class DisplayShare(msgspec.Struct, frozen=True):
    """The items of one display: its name, their number, and the extents of their numbers."""

    name: str
    count: int
    ranges: Sequence[ValueRange]


class SelectionInfo(msgspec.Struct, frozen=True):
    """All items.

    Args:
        total: before any limit.
        live: how many are kept up to date at most.
        count: of those selected.
        displays: of several items.
    """

    total: int
    live: int
    count: int
    displays: Sequence[DisplayShare] | msgspec.UnsetType = msgspec.UNSET


class SelectionStore(PageStore, frozen=True):
    """The selection of a browser: the items by id, and "/info" on all of them."""

    spread: ClassVar = {"things": ""}

    things: Mapping[str, Thing]
    info: SelectionInfo | msgspec.UnsetType = msgspec.field(name="/info", default=msgspec.UNSET)


class SelectedStore(PageStore, frozen=True):
    """Display of each selected item by id, and whether the item moves and stays the same."""

    spread: ClassVar = {"things": ""}

    things: Mapping[str, tuple[str, bool]]


NOTHING = SelectionStore({})


class PickingStore(PageStore, frozen=True):
    """The ids of displays that are not selectable, each with False."""

    spread: ClassVar = {"selectable": ""}

    selectable: Mapping[str, bool]


class _Selected(msgspec.Struct, frozen=True):
    """One thing, and the display that drew it."""

    runner: Runner
    item: PickedItem

    @property
    def is_moving(self) -> bool:
        """Return whether it stays the same thing wherever it goes, such as a frame."""
        return not self.item.hit.samples


class _Selection(msgspec.Struct):
    """Selection of one browser.

    Args:
        things: by the ids that the browser gave them.
        total: how many there were to select.
        store, values: for the page, and the same for programs.
        told_at: when that was made, None if it is out of date.
    """

    things: dict[int, _Selected] = msgspec.field(default_factory=dict)
    total: int = 0
    store: SelectionStore = NOTHING
    values: Mapping[str, Any] = msgspec.field(default_factory=dict)
    told_at: float | None = None

    @property
    def displays(self) -> Mapping[int, tuple[str, bool]]:
        """The display of each thing, and whether it moves, by its id."""
        return {id: (each.runner.id, each.is_moving) for id, each in self.things.items()}


class SelectionFeature(Feature):
    """Finds what browsers pick, and asks its displays about it while a page shows it."""

    name = "Selection"
    module = "selection.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._holders: frozenset[int] = frozenset()
        self._viewers: frozenset[int] = frozenset()
        self._is_picking = False
        self._selections: dict[int, _Selection] = {}

    def keep_up(self, commanded: bool) -> None:
        """Forget what belongs to removed displays, and renew what is looked at."""
        runners = self._displays.list.runners()
        for runner in runners:
            runner.scene_diff.remember(self._is_picking)
        current, now = set(runners), self.context.clock()
        for browser, selection in self._selections.items():
            if not current.issuperset(each.runner for each in selection.things.values()):
                things = selection.things.items()
                selection.things = {id: each for id, each in things if each.runner in current}
                selection.told_at = None
            is_few = len(selection.things) <= MAX_LIVE
            is_old = selection.told_at is None or (is_few and now >= selection.told_at + EVERY_S)
            if browser in self._viewers and is_old:
                selection.told_at = now
                selection.store = self._store(selection)
                selection.values = msgspec.to_builtins(selection.store.by_key())

    def is_attended(self) -> bool:
        """Return whether a page shows its selection."""
        return bool(self._viewers)

    def watched(self, stores: Set[str]) -> None:
        """Report on the selections that pages watch."""

        def browsers(name: str) -> frozenset[int]:
            numbers = (each.partition(":")[2] for each in stores if each.startswith(f"{name}:"))
            return frozenset(int(each) for each in numbers if each.isdecimal())

        holders, viewers = browsers("selected"), browsers("selection")
        self.inspect_selections(holders, viewers, "picking" in stores)

    @store(is_private=True)
    def selection(self, browser: str) -> SelectionStore:
        """Return the details of what a browser has selected."""
        selection = self._selection_of(browser)
        return selection.store if selection and int(browser) in self._viewers else NOTHING

    @store(is_private=True)
    def selected(self, browser: str) -> SelectedStore:
        """Return what a browser has selected."""
        selection = self._selection_of(browser)
        return SelectedStore(
            {str(id): each for id, each in selection.displays.items()} if selection else {}
        )

    @store(of=lambda part: part.rows)
    def picking(self, argument: str) -> PickingStore:
        """Return which displays are not selectable; watched while a page is about to select."""
        rows = (row for row in self.rows if not getattr(row.display, "selectable", True))
        return PickingStore({row.id: False for row in rows})

    @property
    def rows(self) -> Sequence[Row]:
        """Return the list of displays."""
        return self._displays.rows

    @property
    def _displays(self) -> DisplaysPart:
        return self.context.get(DisplaysPart)

    def _selection_of(self, browser: str) -> _Selection | None:
        return self._selections.get(int(browser)) if browser.isdecimal() else None

    def state(self) -> Mapping[str, Any]:
        """Return what browsers have selected, and what is known of it for those that show it."""
        selections, viewers = self._selections.items(), self._viewers
        values = {id: each.values if id in viewers else {} for id, each in selections}
        return {"selected": {id: each.displays for id, each in selections}, "selections": values}

    @command(None)
    def inspect_selections(
        self,
        holders: frozenset[int] = frozenset(),
        viewers: frozenset[int] = frozenset(),
        is_picking: bool = False,
    ) -> None:
        """Report on what browsers have selected.

        Args:
            holders: ids of the browsers that may have a selection.
            viewers: those that show its values.
            is_picking: whether any browser is about to select.
        """
        for browser in self._holders - holders:
            self._selections.pop(browser, None)
        for browser in viewers - self._viewers:
            if browser in self._selections:
                self._selections[browser].told_at = None
        self._holders, self._viewers, self._is_picking = holders, viewers, is_picking

    @command(Role.WATCHER)
    def select(
        self,
        sender: Sender,
        picks: tuple[NodePicks, ...] = (),
        keep: tuple[int, ...] = (),
        total: int = 0,
    ) -> str:
        """Select things for the browser that sends this, in place of its previous selection.

        Args:
            picks: what is selected anew.
            keep: ids of what was selected before and remains so.
            total: how many things there were to select.
        """
        count = sum(len(each.items) for each in picks)
        if sender.browser is None:
            raise Error("Only a browser can select.")
        if count + len(keep) > MAX_SELECTED:
            raise Error(f"Select at most {MAX_SELECTED} things at once.")
        before = self._selections.get(sender.browser, _Selection()).things
        things = _affordable({id: before[id] for id in keep if id in before})
        new: dict[int, _Selected] = {}
        for each in picks:
            new |= self._find(each)
        if not (things or picks):
            self._selections.pop(sender.browser, None)
            return ""
        if count and not new:
            raise Error(CLICK_AGAIN)
        selection = _Selection(things | new, total)
        self._selections[sender.browser] = selection
        return self._line(next(iter(new.values()))) if len(new) == 1 else ""

    @command(Role.WATCHER)
    def identify(self, picks: NodePicks) -> str:
        """Answer with one line about a thing, "" if it does not exist any more."""
        things = self._find(picks)
        return self._line(next(iter(things.values()))) if things else ""

    def _find(self, picks: NodePicks) -> dict[int, _Selected]:
        id = picks.group.partition("/")[0]
        runner = next((each for each in self._displays.list.active() if each.id == id), None)
        hits = runner.find(picks) if runner else {}
        return {id: _Selected(runner, each) for id, each in hits.items()} if runner else {}

    def _line(self, selected: _Selected) -> str:
        details = self._details(selected)
        if details is None:
            return ""
        parts = (selected.runner.display.name, details.title, first_line(details.values))
        return " · ".join(part for part in parts if part)

    def _details(self, selected: _Selected) -> Details | None:
        return selected.runner.inspect(selected.item, self.context.frames)

    def _store(self, selection: _Selection) -> SelectionStore:
        """Return what a page shows of each thing, and of all."""
        things: dict[str, Thing] = {}
        by_title: dict[tuple[str, str], list[Any]] = {}
        counted: dict[str, Statistics] = {}
        for id, selected in selection.things.items():
            runner, hit = selected.runner, selected.item
            details = self._details(selected)
            title = details.title if details else str(hit.hit.id or hit.hit.key)
            tree = details_tree(details.values if details else {})
            alike = by_title.setdefault((runner.id, title), [])
            if tree in alike:
                continue  # another part of the same thing
            alike.append(tree)
            note = "" if runner.shows(hit) else REPLACED
            if details is None:
                note = "It no longer exists."
            own = tree["fields"]
            fields = own | {k: v for k, v in self._whereabouts(hit).items() if k not in own}
            name = runner.display.name
            things[str(id)] = Thing(runner.id, name, title, {"fields": fields}, note)
            statistics = counted.setdefault(runner.id, Statistics(runner.display.name))
            where = hit.position(self.context.frames) if hit.hit.id is not None else None
            statistics.add(details.values if details else {}, where)
        count = len(selection.things)
        several = sum(each.count for each in counted.values()) > 1
        shares = [
            DisplayShare(each.name, each.count, list(each.ranges())) for each in counted.values()
        ]
        info = SelectionInfo(
            max(selection.total, count), MAX_LIVE, count, shares if several else msgspec.UNSET
        )
        return SelectionStore(things, info)

    def _whereabouts(self, item: PickedItem) -> dict[str, str]:
        """Return the details known of anything that is drawn."""
        hit = item.hit
        details: dict[str, str] = {}
        if (position := item.position(self.context.frames)) is not None:
            frame, xyz = position
            name = "Position" if hit.id is not None else "Clicked point"
            details[f"{name} in {frame}"] = f"{', '.join(f'{c:.4f}' for c in xyz)} m"
        if hit.frame:
            details["Frame"] = hit.frame
        if hit.samples and (stamp_ns := hit.sample.stamp_ns):
            details["Stamp"] = f"{format_stamp(stamp_ns)} s"
        return details


def _affordable(things: Mapping[int, _Selected]) -> dict[int, _Selected]:
    """Return the items without those of the oldest messages that only the selection holds."""
    past: dict[int, None] = {}
    for each in reversed(list(things.values())):
        if not each.runner.shows(each.item):
            past.setdefault(id(each.item.hit.sample))
    dropped = set(list(past)[MAX_PAST:])
    return {
        number: each
        for number, each in things.items()
        if each.is_moving or id(each.item.hit.sample) not in dropped
    }

"""Recordings that the rules of the config make of what was just remembered."""

from __future__ import annotations

import re
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import Future, wait
from contextlib import suppress
from datetime import datetime
from pathlib import Path
from typing import Any

import msgspec

from webviz.api.declared import Topic
from webviz.api.errors import Error
from webviz.api.group import DisplayGroup
from webviz.api.registry import type_name
from webviz.api.roles import Role
from webviz.api.rule import DOCTOR
from webviz.api.status import Level, Status
from webviz.data.disk import in_thread
from webviz.data.recordings import RecordingError
from webviz.data.recordings.folder_writing import RecordingFolder
from webviz.data.words import joined
from webviz.engine.feature import Feature, store
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.part import PartContext
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.state import Row
from webviz.features.black_box.observation import LEVEL_TYPES, TopicObserver, WatchedMoment
from webviz.features.black_box.rules import RuleWatcher
from webviz.features.black_box.saved import (
    FOLDER,
    BlackBoxState,
    BlackBoxStore,
    SavedMoment,
    black_box_store,
    listed,
)
from webviz.features.recording import new_folder
from webviz.files.config import Settings, WatchRule
from webviz.files.config import nearest as nearest_name
from webviz.sources import Subscriber, Subscription
from webviz.sources.recording import Entry, Recorder, Remembered
from webviz.sources.recording.memory import MemoryHistory
from webviz.sources.recording.recent import OVERHEAD

BEFORE_S, AFTER_S = 60.0, 10.0
"""Time around the moment at which a rule fires that is saved, as far as it is remembered."""
SETTLE_S = 3.0
"""Time after the first message of a display in which its status does not count: while a robot
starts, transforms and other topics are still missing."""
MOMENT = "%Y-%m-%d_%H-%M-%S"
GIGABYTE = 10**9
LIMIT = "which is the limit. Delete recordings, or raise watch_limits.gigabytes."
LAST_S = 0.5
"""Time for the disk to make a folder when the viewer ends."""
RESERVE = GIGABYTE // 2
"""Bytes of the disk that recordings leave free: robots with a full disk fail in other ways, too."""


class _Saving(msgspec.Struct):
    """A recording that is being made."""

    title: str
    until_s: float
    past: Sequence[Entry]
    max_bytes: int
    bound: str
    folder: Future[RecordingFolder]
    recorder: Recorder | None = None
    closed: Future[None] | None = None


class BlackBoxFeature(Feature):
    """Saves what led to a problem, and what came of it.

    On a bag, which has no memory, no rule fires. Rules about displays wait while the past is shown.
    """

    name = "Black box"
    module = "black_box.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._memory = context.player.memory
        self._heard: dict[str, float] = {}
        """Monotonic time in seconds when the first message was noticed, by display."""
        self._observer = TopicObserver()
        self._watcher = RuleWatcher(())
        self._subscriber = Subscriber()
        self._types: dict[str, list[str]] = {}
        """The last type of each topic of the rules, in a list."""
        self._saving: _Saving | None = None
        self._listing: Future[tuple[tuple[SavedMoment, ...], int]] | None = None
        self._saved: tuple[SavedMoment, ...] = ()
        self._free = 0
        """Bytes of the disk."""
        self._problem = ""
        if self._memory is not None:
            context.player.inbox.read_along(lambda: self._observer.put)

    def subscriptions(self) -> Mapping[str, Subscription]:
        """Return the topics of the rules, as the first type of each that can be read."""
        subscriptions: dict[str, Subscription] = {}
        for rule in self._watcher.rules:
            name = self._resolved(rule)
            offer = self.context.offers.get(name)
            types = [publisher.type for publisher in offer.publishers] if offer else []
            types = [each for each in types if not rule.level or each in LEVEL_TYPES]
            # A driver that crashes takes its topic along: that is what a rule is to notice.
            if types := types or self._types.get(name, []):
                self._types[name] = types[:1]
                subscriptions[name] = Subscription(types[0], Topic(name))
        return self._subscriber.subscribe(subscriptions)

    @property
    def _settings(self) -> Settings:
        return self.context.get(SettingsPart).settings

    def keep_up(self, commanded: bool) -> None:
        """Follow the rules, and what is being saved."""
        memory, settings = self._memory, self._settings
        if memory is None:
            return
        if self._watcher.rules != settings.watch:
            self._watcher = RuleWatcher(settings.watch)
            self._types.clear()
            self._problem = ""
            self._list()
        if not self._watcher.rules:
            return
        types = self._subscriber_types()
        leveled = {t: w for t, w in types.items() if w in LEVEL_TYPES}
        paths = {
            rule.path: types[topic]
            for rule in self._watcher.rules
            if rule.path and (topic := rule.watched_topic) in types
        }
        self._observer.observe([*types], leveled, paths)
        if self._listing is None:  # else it is not known yet how much may be saved
            for rule in self._watcher.fired(self._observation(self.context.player.is_live)):
                self._save(rule, memory)
        self._go_on(memory)

    def state(self) -> Mapping[str, Any]:
        """Return the recordings."""
        return {"black_box": None if self._memory is None else self._recordings()}

    def _recordings(self) -> BlackBoxState:
        listing = self._listing
        if listing is not None and listing.done():
            self._listing = None
            self._saved, self._free = ((), 0) if listing.exception() else listing.result()
        return BlackBoxState(self._saved, self._saving.title if self._saving else "")

    @store(Role.OWNER)
    def black_box(self, argument: str) -> BlackBoxStore | None:
        """Return recordings that rules made, None without any rule or recording."""
        box = None if self._memory is None else self._recordings()
        return black_box_store(box, bool(self._settings.watch))

    def statuses(self) -> Mapping[str, Status]:
        """Reasons why nothing is saved, and rules that are about nothing."""
        if self._problem:
            return {"Black box": Status(Level.WARN, self._problem)}
        if self._memory is None:
            return {}
        names = [row.name for row in self.context.get(DisplaysPart).rows]
        for rule in self._watcher.rules:
            watched = rule.condition.subject if rule.condition else rule.display
            is_display = watched != DOCTOR and not watched.startswith("/")
            if watched and is_display and names and watched not in names:
                text = f"A rule watches the display `{watched}`, which does not exist."
                remedy = nearest_name(watched, names)
                return {"Black box": Status(Level.WARN, f"{text} {remedy}")}
        if self._watcher.rules and not self._memory.recent.is_on:
            text = (
                "Rules have nothing to save, because nothing is remembered. Raise memory.seconds."
            )
            return {"Black box": Status(Level.WARN, text)}
        return {}

    def close(self) -> None:
        """Complete what is being saved, also if a rule fired in the last moment."""
        saving, memory = self._saving, self._memory
        if saving is None or memory is None:
            return
        if saving.recorder is None:
            wait([saving.folder], LAST_S)
            if not saving.folder.done():
                saving.folder.add_done_callback(_abandon)
            elif saving.folder.exception() is None:
                self._recorder(saving, saving.folder.result(), memory)
        if saving.recorder is not None:
            saving.recorder.close()

    def _subscriber_types(self) -> dict[str, str]:
        return {topic: subscription.type for topic, subscription in self.subscriptions().items()}

    def _resolved(self, rule: WatchRule) -> str:
        try:
            topic = rule.watched_topic
            return self.context.player.resolve(topic) if topic else ""
        except ValueError:
            return ""

    def _observation(self, is_live: bool) -> WatchedMoment:
        now_s = time.monotonic()
        displays: dict[str, Level] = {}
        settled = self._settled(now_s)
        for row in settled if is_live else ():  # else they are about the past
            displays[row.name] = max(displays.get(row.name, Level.OK), row.level)
        rows = self.context.get(DisplaysPart).rows
        starting = {row.name for row in rows} - {row.name for row in settled}
        rates, levels = self._observer.rates(now_s), self._observer.levels(now_s)
        for rule in self._watcher.rules:
            name = self._resolved(rule)
            if name in rates:
                rates[rule.topic] = rates[name]
            if name in levels:
                levels[rule.topic] = levels[name]
        hidden_skip = {
            each.rule.text: None if each.rule.subject in starting else each.holds
            for each in (self.context.verdicts if is_live else ())
        }
        numbers = self._observer.numbers()
        return WatchedMoment(now_s, displays, rates, levels, numbers, hidden_skip)

    def _settled(self, now_s: float) -> Sequence[Row]:
        """Return the displays whose status counts, and the groups that contain some."""
        has_frames = bool(self.context.buffer.frames())
        heard: dict[str, float] = {}
        for runner in self.context.get(DisplaysPart).list.active():
            received = has_frames if runner.has_received is None else runner.has_received
            if received or runner.id in self._heard:
                heard[runner.id] = self._heard.get(runner.id, now_s)
        self._heard = heard
        settled = {id_ for id_, at_s in heard.items() if now_s - at_s >= SETTLE_S}
        return [
            row
            for row in self.context.get(DisplaysPart).rows
            if row.id in settled or (row.type == type_name(DisplayGroup) and settled)
        ]

    def _save(self, rule: WatchRule, memory: MemoryHistory) -> None:
        """Begin to save, unless that goes on already or is too much."""
        if self._saving is not None or not memory.recent.is_on:
            return
        now = datetime.now()
        self._problem, (max_bytes, bound) = self._excess(now), self._room()
        if self._problem:
            return
        cause = re.sub(r"[^A-Za-z0-9]+", "_", rule.title).strip("_")[:60]
        path = Path(FOLDER).absolute() / f"{now:{MOMENT}}_{cause}"
        past = _newest(memory, max_bytes)
        folder = in_thread(lambda: new_folder(path))
        folder.add_done_callback(lambda _: self.context.player.inbox.arrived.set())
        until_s = time.monotonic() + AFTER_S
        self._saving = _Saving(rule.title, until_s, past.whole, max_bytes, bound, folder)

    def _excess(self, now: datetime) -> str:
        """Return the reason why no more may be saved; "" if more may."""
        limits = self._settings.watch_limits
        today = f"{now:{MOMENT}}".partition("_")[0]
        count = sum(each.path.name.startswith(today) for each in self._saved)
        if count >= limits.per_day:
            return (
                f"A rule fired, but {count} recordings were made today, which is the limit. Raise "
                "watch_limits.per_day."
            )
        room, bound = self._room()
        return f"A rule fired, but {bound}" if room <= 0 else ""

    def _room(self) -> tuple[int, str]:
        """Return the bytes that may still be saved, and what bounds them."""
        limit = round(self._settings.watch_limits.gigabytes * GIGABYTE)
        size, free = sum(each.size for each in self._saved), self._free
        left = f"its disk has {free / GIGABYTE:.1f} GB left. Make room, so that it can go on."
        return min(
            (limit - size, f"{FOLDER} has {size / GIGABYTE:.1f} GB, {LIMIT}"),
            (free - RESERVE, left),
        )

    def _go_on(self, memory: MemoryHistory) -> None:
        """Record until the time is up, then complete the files."""
        saving = self._saving
        if saving is None or not saving.folder.done():
            return
        try:
            folder = saving.folder.result()
        except (Error, OSError) as error:
            self._end(str(error))
            return
        inbox = self.context.player.inbox
        if saving.recorder is None:
            inbox.read_along(lambda: self._recorder(saving, folder, memory).put)
        elif saving.closed is None and (
            time.monotonic() >= saving.until_s or saving.recorder.problem or saving.recorder.is_full
        ):
            inbox.forget(saving.recorder.put)
            saving.closed = in_thread(saving.recorder.close)
            saving.closed.add_done_callback(lambda _: inbox.arrived.set())
        elif saving.closed is not None and saving.closed.done():
            self._end(saving.recorder.problem)
            if saving.recorder.is_full:
                self._problem = f"The last recording was cut short: {saving.bound}"

    def _recorder(
        self, saving: _Saving, folder: RecordingFolder, memory: MemoryHistory
    ) -> Recorder:
        """Return the recorder, between two messages: those since the rule fired are in memory."""
        past = list(saving.past)
        past += memory.recent.after(past[-1][1].arrived_s) if past else []
        saving.recorder = Recorder(folder, memory.recorded_channels, past, saving.max_bytes)
        return saving.recorder

    def _end(self, problem: str) -> None:
        self._saving = None
        self._problem = problem and joined(
            problem, "A rule fired, but its messages were not saved."
        )
        self._list()

    def _list(self) -> None:
        self._listing = in_thread(listed)
        self._listing.add_done_callback(lambda _: self.context.player.inbox.arrived.set())


def _abandon(future: Future[RecordingFolder]) -> None:
    """Close a folder that was made too late."""
    if future.exception() is None:
        with suppress(RecordingError):
            future.result().close()


def _newest(memory: MemoryHistory, max_bytes: int) -> Remembered:
    """Return the messages before this moment, as far back as they fit."""
    past = memory.recent.last(BEFORE_S)
    size = 0
    for _, raw in reversed(past.messages):
        size += len(raw.cdr) + OVERHEAD
        if size > max_bytes:
            return memory.recent.last(time.monotonic() - raw.arrived_s)
    return past

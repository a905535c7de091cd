"""Recordings that the rules of the config make of what was just remembered."""

from __future__ import annotations

import itertools
import re
import shutil
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import Future
from datetime import datetime
from pathlib import Path
from typing import Any

import msgspec

from webviz.api.declared import Topic
from webviz.api.errors import Error
from webviz.api.group import DisplayGroup
from webviz.api.registry import type_name
from webviz.api.rule import DOCTOR, Verdict
from webviz.api.status import Level, Status
from webviz.data.disk import in_thread
from webviz.data.recordings.folder_writing import RecordingFolder
from webviz.data.words import joined
from webviz.engine.parts.display_list import DisplayList
from webviz.engine.parts.part import Core, Part
from webviz.engine.parts.recording import new_folder
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.state import Row
from webviz.engine.watch import RuleWatcher, TopicObserver, WatchedMoment
from webviz.engine.watch.observation import LEVEL_TYPES
from webviz.files.config import WatchRule
from webviz.files.config import nearest as nearest_name
from webviz.sources import Subscriber, Subscription
from webviz.sources.past_state import BlackBoxState, SavedMoment
from webviz.sources.player import Player
from webviz.sources.recording import Entry, Recorder, Remembered
from webviz.sources.recording.memory import MemoryHistory
from webviz.sources.recording.recent import OVERHEAD

FOLDER = "webviz_black_box"
"""In the working folder."""
BEFORE_S, AFTER_S = 60.0, 10.0
"""Time around the moment at which a rule fires that is saved, as far as it is remembered."""
SETTLE_S = 3.0
"""Time after the first message of a display in which its status does not count: while a robot
starts, transforms and other topics are still missing."""
PARTS = "metadata.yaml", "*.mcap"
"""Of a recording; either may be missing if it was cut off or has no messages."""
MOMENT = "%Y-%m-%d_%H-%M-%S"
GIGABYTE = 10**9
LIMIT = "which is the limit. Delete recordings, or raise watch_limits.gigabytes."
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


class BlackBoxPart(Part):
    """Saves what led to a problem, and what came of it.

    Args:
        core: shared by all parts.
        settings: have the rules.
        player: has the memory; on a bag, which has none, no rule fires. Rules about displays wait
            while the past is shown.
        displays: those that are shown.
    """

    name = "Black box"

    def __init__(
        self,
        core: Core,
        settings: SettingsPart,
        player: Player,
        displays: DisplayList,
    ) -> None:
        super().__init__(core)
        self._settings = settings
        self._player = player
        self._memory = player.memory
        self._displays = displays
        self._heard: dict[str, float] = {}
        """By display, when its first message was noticed, in monotonic seconds."""
        self._observer = TopicObserver()
        self._watcher = RuleWatcher(())
        self._subscriber = Subscriber()
        self._types: dict[str, list[str]] = {}
        """The last type of each topic of the rules, in a list."""
        self._rows: Sequence[Row] = ()
        self._verdicts: Sequence[Verdict] = ()
        self._saving: _Saving | None = None
        self._listing: Future[tuple[tuple[SavedMoment, ...], int]] | None = None
        self._saved: tuple[SavedMoment, ...] = ()
        self._free = 0
        """Bytes of the disk."""
        self._problem = ""
        if self._memory is not None:
            player.inbox.read_along(lambda: self._observer.put)

    def subscriptions(self) -> Mapping[str, Subscription]:
        """Return the topics of the rules, as the first type of each that can be read."""
        wanted: dict[str, Subscription] = {}
        for rule in self._watcher.rules:
            name = self._resolved(rule)
            offer = self.core.offers.get(name)
            types = [publisher.type for publisher in offer.publishers] if offer else []
            types = [each for each in types if not rule.level or each in LEVEL_TYPES]
            # A driver that crashes takes its topic along: that is what a rule is to notice.
            if types := types or self._types.get(name, []):
                self._types[name] = types[:1]
                wanted[name] = Subscription(types[0], Topic(name))
        return self._subscriber.subscribe(wanted)

    def look(self, rows: Sequence[Row], verdicts: Sequence[Verdict]) -> None:
        """Take the displays of the last state, and what became of the rules."""
        self._rows = rows
        self._verdicts = verdicts

    def keep_up(self, commanded: bool) -> None:
        """Follow the rules, and what is being saved."""
        memory, settings = self._memory, self._settings.settings
        if memory is None:
            return
        if self._watcher.rules != settings.watch:
            self._watcher = RuleWatcher(settings.watch)
            self._types.clear()
            self._problem = ""
            self._list()
        if not self._watcher.rules:
            return
        wanted = self._subscriber_types()
        leveled = {t: w for t, w in wanted.items() if w in LEVEL_TYPES}
        paths = {
            rule.path: wanted[topic]
            for rule in self._watcher.rules
            if rule.path and (topic := rule.watched_topic) in wanted
        }
        self._observer.observe([*wanted], leveled, paths)
        if self._listing is None:  # else it is not known yet how much may be saved
            for rule in self._watcher.fired(self._observation(self._player.is_live)):
                self._save(rule, memory)
        self._go_on(memory)

    def state(self) -> Mapping[str, Any]:
        """Return the recordings."""
        if self._memory is None:
            return {"black_box": None}
        listing = self._listing
        if listing is not None and listing.done():
            self._listing = None
            self._saved, self._free = ((), 0) if listing.exception() else listing.result()
        return {"black_box": BlackBoxState(self._saved, self._saving.title if self._saving else "")}

    def statuses(self) -> Mapping[str, Status]:
        """Reasons why nothing is saved, and rules that are about nothing."""
        if self._problem:
            return {"Black box": Status(Level.WARN, self._problem)}
        if self._memory is None:
            return {}
        names = [row.name for row in self._rows]
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
        """Complete what is being saved."""
        if self._saving is not None and self._saving.recorder is not None:
            self._saving.recorder.close()

    def _subscriber_types(self) -> dict[str, str]:
        return {topic: subscription.type for topic, subscription in self.subscriptions().items()}

    def _resolved(self, rule: WatchRule) -> str:
        try:
            topic = rule.watched_topic
            return self.core.player.resolve(topic) if topic else ""
        except ValueError:
            return ""

    def _observation(self, is_live: bool) -> WatchedMoment:
        now_s = time.monotonic()
        displays: dict[str, Level] = {}
        settled = self._settled(now_s)
        for row in settled if is_live else ():  # else they are about the past
            displays[row.name] = max(displays.get(row.name, Level.OK), row.level)
        starting = {row.name for row in self._rows} - {row.name for row in settled}
        rates, levels = self._observer.rates(now_s), self._observer.levels(now_s)
        for rule in self._watcher.rules:
            name = self._resolved(rule)
            if name in rates:
                rates[rule.topic] = rates[name]
            if name in levels:
                levels[rule.topic] = levels[name]
        kept = {
            each.rule.text: None if each.rule.subject in starting else each.holds
            for each in (self._verdicts if is_live else ())
        }
        numbers = self._observer.numbers()
        return WatchedMoment(now_s, displays, rates, levels, numbers, kept)

    def _settled(self, now_s: float) -> Sequence[Row]:
        """Return the displays whose status counts, and the groups that contain some."""
        has_frames = bool(self.core.buffer.frames())
        heard: dict[str, float] = {}
        for runner in self._displays.active():
            received = has_frames if runner.has_received is None else runner.has_received
            if received or runner.id in self._heard:
                heard[runner.id] = self._heard.get(runner.id, now_s)
        self._heard = heard
        settled = {id_ for id_, at_s in heard.items() if now_s - at_s >= SETTLE_S}
        return [
            row
            for row in self._rows
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
        folder.add_done_callback(lambda _: self.core.player.inbox.arrived.set())
        until_s = time.monotonic() + AFTER_S
        self._saving = _Saving(rule.title, until_s, past.whole, max_bytes, bound, folder)

    def _excess(self, now: datetime) -> str:
        """Return the reason why no more may be saved; "" if more may."""
        limits = self._settings.settings.watch_limits
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
        limit = round(self._settings.settings.watch_limits.gigabytes * GIGABYTE)
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
        inbox = self._player.inbox
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
        """Between two messages: what came since the rule fired is in memory."""
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
        self._listing = in_thread(_listed)
        self._listing.add_done_callback(lambda _: self.core.player.inbox.arrived.set())


def _newest(memory: MemoryHistory, max_bytes: int) -> Remembered:
    """Return the messages before this moment, as far back as they fit."""
    past = memory.recent.last(BEFORE_S)
    size = 0
    for _, raw in reversed(past.messages):
        size += len(raw.cdr) + OVERHEAD
        if size > max_bytes:
            return memory.recent.last(time.monotonic() - raw.arrived_s)
    return past


def _listed() -> tuple[tuple[SavedMoment, ...], int]:
    """Return the recordings in the folder, the newest first, and the free bytes of its disk."""
    files = itertools.chain(*(Path(FOLDER).absolute().glob(f"*/{name}") for name in PARTS))
    paths = {file.parent for file in files}
    saved = tuple(
        SavedMoment(path, sum(each.stat().st_size for each in path.iterdir()))
        for path in sorted(paths, reverse=True)
    )
    return saved, shutil.disk_usage(Path.cwd()).free

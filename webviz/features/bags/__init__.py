"""Bags in the page: those that lie on this machine are played in the place of live topics."""

from __future__ import annotations

import contextlib
import functools
import os
import shutil
import tempfile
import time
from collections.abc import Callable, Sequence, Set
from concurrent.futures import Future
from pathlib import Path
from typing import Any, TypeVar

import msgspec

from webviz.api.errors import Error
from webviz.api.group import DisplayGroup
from webviz.api.roles import Role
from webviz.data.disk import DiskThreads, in_thread
from webviz.engine.commands import FileCommand, Sender
from webviz.engine.feature import command, store
from webviz.engine.forms import sendable
from webviz.engine.parts.comparison_config import NAME as COMPARISON_NAME
from webviz.engine.parts.comparison_config import with_comparison, without_comparison
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.panels import PanelsPart
from webviz.engine.parts.part import PartContext
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.parts.time import TimePart
from webviz.engine.requests import Job
from webviz.engine.store import PageStore
from webviz.features.bags.uploading import Uploads
from webviz.files.config import Config
from webviz.files.report import read_report
from webviz.page.dispatcher import Dispatcher, PageFeature
from webviz.page.page_request import PageRequest
from webviz.sources.bag.comparison import Align, ComparisonRun
from webviz.sources.bag.history import BagHistory

BLACK_BOX = "webviz_black_box"
"""The folder in the working folder where rules save recordings."""
BAGS = (".mcap", ".db3", ".bag", ".zstd", ".zst", ".lz4")
REPORT = ".zip"
METADATA = "metadata.yaml"
MAX_LISTED = 200
MAX_ENTRIES = 10_000
"""Largest number of entries of a folder that are looked at."""
LISTING_S = 2.0
"""Interval between listings while a page shows them."""
NOT_LISTED = (
    "Not opened: pages open bags of the library and those that this viewer wrote. Start webviz "
    "with --library to name its folder."
)
NO_LIVE = "A bag is already open. Start webviz with --bag to play another one."
ELSEWHERE = "Not opened: {} is a link to another folder. Copy the bag into the library."
NOTHING_BESIDE = (
    "Not compared: open a bag first, beside which the second run is shown. A viewer that was "
    "started with a bag takes --ghost."
)
PAGES_ONLY = "Only pages upload files. Programs know the path."

_disk = DiskThreads(4)
"""Threads for files that pages upload."""

T = TypeVar("T")

Compared = tuple[BagHistory, BagHistory]
"""The recording that is shown, and what takes its place."""


class Bag(msgspec.Struct, frozen=True):
    """A bag, or a bug report with one.

    Args:
        path: absolute.
        name: of the file or folder.
        folder: of it.
        megabytes: of the file, or of the files in the folder.
        changed_s: when it was written, in seconds since 1970.
    """

    path: str
    name: str
    folder: str
    megabytes: float
    changed_s: int


class BagsStore(PageStore, frozen=True):
    """The bags that pages may open, the newest first.

    Args:
        bags: at most `MAX_LISTED`.
        can_open: whether there are live topics, in whose place they are shown.
        has_library: whether a folder was named.
        opened: the name of the bag that is shown in the place of live topics, "" for none.
        second: the name of the second run that is shown beside it, "" for none.
    """

    bags: Sequence[Bag]
    can_open: bool
    has_library: bool
    opened: str
    second: str


class BagsFeature(PageFeature):
    """Opens bags while live topics are remembered, and returns to these."""

    name = "Bags"
    module = "bags.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._folders = [Path(BLACK_BOX).absolute(), *map(Path.absolute, context.host.bag_folders)]
        self._is_watched = False
        self._listing: Future[Sequence[Bag]] | None = None
        self._next_s = 0.0
        self._bags: Sequence[Bag] = ()
        self._unpacked: list[Path] = []
        self._uploads = Uploads()
        self._compared: BagHistory | None = None
        """The recording that was shown with a second run last."""

    def attach(self, dispatcher: Dispatcher) -> None:
        """Take files of pages, which no frame waits for."""
        dispatcher.take("BeginUpload", self._begin)
        dispatcher.take("UploadPart", self._add)

    def watched(self, stores: Set[str]) -> None:
        """List the folders only while a page shows them."""
        self._is_watched, self._next_s = bool(stores), 0.0

    def keep_up(self, commanded: bool) -> None:
        """List the folders again now and then; a second run goes with its recording."""
        if self._compared is not None and self.context.player.history is not self._compared:
            self._remove_comparison()
        if self._listing is not None and self._listing.done():
            self._bags = () if self._listing.exception() else self._listing.result()
            self._listing = None
        if self._is_watched and self._listing is None and time.monotonic() >= self._next_s:
            self._next_s = time.monotonic() + LISTING_S
            written = [each.path for each in self.context.outputs.all]
            with contextlib.suppress(OSError):
                self._listing = in_thread(lambda: _listed(self._folders, written))
                self._listing.add_done_callback(lambda _: self.context.player.inbox.arrived.set())

    @store(Role.OWNER)
    def bags(self, argument: str) -> BagsStore:
        """Return the bags that pages may open."""
        player = self.context.player
        history = player.history if player.is_opened else None
        bag = history if isinstance(history, BagHistory) else None
        return BagsStore(
            self._bags,
            player.live is not None,
            len(self._folders) > 1,
            opened=str(sendable(bag.paths[0].name)) if bag else "",
            second=str(sendable(bag.comparison.path.name)) if bag and bag.comparison else "",
        )

    @command(Role.OWNER, FileCommand)
    def open_recording(self, path: str, sender: Sender) -> Job[BagHistory]:
        """Play a recording, or that of a bug report, in the place of live topics.

        `ReturnToLive` ends it; live topics are remembered meanwhile.

        Args:
            path: a file or folder. Browsers can choose those of the library, of the black box, and
                what this viewer wrote.
        """
        place = Path(path)
        check = sender.browser is not None
        if check and not self._is_offered(place):
            raise Error(NOT_LISTED)

        if self.context.player.live is None:
            raise Error(NO_LIVE)

        def opened() -> BagHistory:
            if check:
                _refuse_elsewhere(place)
            return BagHistory(self._bag_of(place))

        return Job(opened, self.context.get(TimePart).show)

    @command(Role.OWNER, FileCommand)
    def compare_recording(self, path: str, sender: Sender, align: Align = "start") -> Job[Compared]:
        """Show a second run beside the recording that was opened: tinted, on one timeline.

        `EndComparison` ends it, as does opening another recording.

        Args:
            path: a file or folder, as for `OpenRecording`.
            align: "start" lets both begin together, "stamp" keeps its times, "path" moves it to
                where the robots are closest.
        """
        place, history = Path(path), self._opened()
        check = sender.browser is not None
        if check and not self._is_offered(place):
            raise Error(NOT_LISTED)

        def opened() -> Compared:
            if check:
                _refuse_elsewhere(place)
            comparison = ComparisonRun(self._bag_of(place), align)
            both = BagHistory(history.paths, history.extras, history.remappings, comparison)
            return history, both

        return Job(opened, self._show_compared)

    @command(Role.OWNER, FileCommand)
    def end_comparison(self) -> Job[Compared]:
        """Show the recording alone again, at the same position."""
        opened = self._opened()
        if opened.comparison is None:
            raise Error("No second run is shown.")
        return Job(
            lambda: (opened, BagHistory(opened.paths, opened.extras, opened.remappings)),
            self._show_compared,
        )

    def _opened(self) -> BagHistory:
        """Return the recording that was opened.

        Raises:
            Error: there is none.
        """
        player = self.context.player
        if not (player.is_opened and isinstance(player.history, BagHistory)):
            raise Error(NOTHING_BESIDE)
        return player.history

    def _show_compared(self, compared: Compared) -> str:
        """Show the recording with or without a second run, and its displays, where it is now."""
        before, after = compared
        player = self.context.player
        if player.history is not before:
            after.close()
            raise Error("Not compared: another recording was opened meanwhile.")
        at_ns, is_playing = player.position_ns, player.is_playing
        answer = self.context.get(TimePart).show(after)
        player.seek(at_ns)
        if not is_playing:
            player.pause()
        self._remove_comparison()
        if after.comparison is not None:
            self._add_comparison(after)
            self._compared = after
        return answer

    def _add_comparison(self, both: BagHistory) -> None:
        displays, panels = self.context.get(DisplaysPart).list, self.context.get(PanelsPart).list
        settings = self.context.get(SettingsPart)
        config = Config(settings.settings, displays.items(), panels=panels.items())
        counts = len(config.displays), len(config.panels)
        config = with_comparison(config, both)
        settings.settings = config.settings
        displays.add(config.displays[counts[0] :])
        for panel in config.panels[counts[1] :]:
            panels.add(panel)

    def _remove_comparison(self) -> None:
        self._compared = None
        settings = self.context.get(SettingsPart)
        alone = without_comparison(settings.settings)
        if alone.robots == settings.settings.robots:
            return
        settings.settings = alone
        displays, panels = self.context.get(DisplaysPart).list, self.context.get(PanelsPart).list
        for entry in tuple(displays.entries):
            group = entry.content
            if isinstance(group, DisplayGroup) and group.name == COMPARISON_NAME:
                displays.remove(entry.id)
        with contextlib.suppress(Error):  # it may have been removed
            panels.remove(COMPARISON_NAME)

    @command(Role.OWNER, is_noted=True)
    def begin_upload(self, name: str, size: int) -> None:
        """Begin to send a bag or a bug report in parts; answered with their `token`.

        Args:
            name: of the file.
            size: in bytes.
        """
        raise Error(PAGES_ONLY)

    @command(Role.OWNER)
    def upload_part(self, token: str, offset: int, text: str) -> None:
        """Send the next part; the answer to the last one has the `path` to open.

        Args:
            token: of the upload.
            offset: in bytes.
            text: the part in base64.
        """
        raise Error(PAGES_ONLY)

    # Called on the event loop

    def _begin(self, page_request: PageRequest, command: Any) -> None:
        if self.context.player.live is None:
            page_request.refuse(NO_LIVE)
            return
        begin = functools.partial(
            self._uploads.begin, page_request.browser, command.name, command.size
        )

        def answer(future: Future[str]) -> None:
            if not page_request.refused_by(future):
                page_request.answer(f"Uploading {command.name}.", token=future.result())

        _start(page_request, begin, answer)

    def _add(self, page_request: PageRequest, command: Any) -> None:
        part = (page_request.browser, command.token, command.offset, command.text)

        def answer(future: Future[Path | None]) -> None:
            if not page_request.refused_by(future):
                page_request.answer(path=str(future.result() or ""))

        _start(page_request, functools.partial(self._uploads.add, *part), answer)

    def close(self) -> None:
        """Remove what was unpacked and uploaded."""
        self._uploads.close()
        for folder in self._unpacked:
            shutil.rmtree(folder, ignore_errors=True)

    def _is_offered(self, place: Path) -> bool:
        if "\0" in str(place) or not place.is_absolute() or ".." in place.parts:
            return False
        own = (each.path for each in self.context.outputs.all)
        return place.parent in self._folders or place in {*own, *self._uploads.complete}

    def _bag_of(self, place: Path) -> Path:
        """Return the bag to read; that of a report is unpacked first. Blocks."""
        if place.suffix.lower() != REPORT:
            return place
        folder = Path(tempfile.mkdtemp(prefix="webviz-report-"))
        self._unpacked.append(folder)
        return read_report(place, folder).bag


def _start(
    page_request: PageRequest, work: Callable[[], T], answer: Callable[[Future[T]], object]
) -> None:
    """Wait for the disk in a thread."""
    try:
        _disk.start(work).add_done_callback(answer)
    except OSError as error:
        page_request.refuse(f"Not uploaded: {error.strerror}. Try again later.")


def _refuse_elsewhere(place: Path) -> None:
    """Refuse links that lead out of a folder, and what is neither a file nor a folder.

    Raises:
        Error: it is one of these.
    """
    if os.path.dirname(os.path.realpath(place)) != os.path.realpath(place.parent):
        raise Error(ELSEWHERE.format(place.name))
    if not (place.is_file() or place.is_dir()):
        raise Error(f"Not opened: {place.name} is not a bag. Choose another file.")


def _listed(folders: Sequence[Path], written: Sequence[Path]) -> Sequence[Bag]:
    """Return the bags in folders and among files that were written; blocks."""
    by_path: dict[Path, Bag] = {}
    for folder in folders:
        with contextlib.suppress(OSError), os.scandir(folder) as entries:
            for entry, _ in zip(entries, range(MAX_ENTRIES), strict=False):
                _note(Path(entry.path), by_path)
    for path in written:
        _note(path, by_path)
    bags = sorted(by_path.values(), key=lambda bag: (-bag.changed_s, bag.name))
    return bags[:MAX_LISTED]


def _note(path: Path, bags: dict[Path, Bag]) -> None:
    """Note a file if it looks like a bag."""
    with contextlib.suppress(OSError, Error):
        if path.is_dir():
            files = [each for each in path.iterdir() if each.suffix in BAGS]
            if not files and not (path / METADATA).is_file():
                return
        elif path.suffix.lower() in (*BAGS, REPORT):
            files = [path]
        else:
            return
        _refuse_elsewhere(path)
        size = sum(file.stat().st_size for file in files)
        changed_s = int(path.stat().st_mtime)
        name, folder = str(sendable(path.name)), str(sendable(str(path.parent)))
        bags[path] = Bag(str(sendable(str(path))), name, folder, round(size / 1e6, 1), changed_s)

"""Bags in the page: those that lie on this machine are played in the place of live topics."""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
import time
from collections.abc import Sequence, Set
from concurrent.futures import Future
from pathlib import Path

import msgspec

from webviz.api.errors import Error
from webviz.api.roles import Role
from webviz.data.disk import in_thread
from webviz.engine.commands import FileCommand, Sender
from webviz.engine.feature import Feature, command, store
from webviz.engine.forms import sendable
from webviz.engine.parts.part import Core
from webviz.engine.parts.playback import PlaybackPart
from webviz.engine.requests import Job
from webviz.engine.store import PageStore
from webviz.files.report import read_report
from webviz.sources.bag.history import BagHistory

BLACK_BOX = "webviz_black_box"
"""The folder in the working folder where rules save recordings."""
BAGS = (".mcap", ".db3", ".bag", ".zstd", ".zst", ".lz4")
REPORT = ".zip"
METADATA = "metadata.yaml"
MAX_LISTED = 200
MAX_ENTRIES = 10_000
"""Of a folder that are looked at."""
LISTING_S = 2.0
"""Interval between listings while a page shows them."""
NOT_LISTED = (
    "Not opened: pages open bags of the library and those that this viewer wrote. Start webviz "
    "with --library to name its folder."
)
ELSEWHERE = "Not opened: {} is a link to another folder. Copy the bag into the library."


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
    """

    bags: Sequence[Bag]
    can_open: bool
    has_library: bool


class BagsFeature(Feature):
    """Opens bags while live topics are remembered, and returns to these."""

    name = "Bags"
    module = "bags.js"

    def __init__(self, core: Core) -> None:
        super().__init__(core)
        self._folders = [Path(BLACK_BOX).absolute(), *map(Path.absolute, core.host.library)]
        self._is_watched = False
        self._listing: Future[Sequence[Bag]] | None = None
        self._next_s = 0.0
        self._bags: Sequence[Bag] = ()
        self._unpacked: list[Path] = []

    def watched(self, stores: Set[str]) -> None:
        """List the folders only while a page shows them."""
        self._is_watched, self._next_s = bool(stores), 0.0

    def keep_up(self, commanded: bool) -> None:
        """List the folders again now and then."""
        if self._listing is not None and self._listing.done():
            self._bags = () if self._listing.exception() else self._listing.result()
            self._listing = None
        if self._is_watched and self._listing is None and time.monotonic() >= self._next_s:
            self._next_s = time.monotonic() + LISTING_S
            written = [each.path for each in self.core.outputs.all]
            with contextlib.suppress(OSError):
                self._listing = in_thread(lambda: _listed(self._folders, written))
                self._listing.add_done_callback(lambda _: self.core.player.inbox.arrived.set())

    @store(Role.OWNER)
    def bags(self, argument: str) -> BagsStore:
        """Return the bags that pages may open."""
        can_open = self.core.player.live is not None
        return BagsStore(self._bags, can_open, len(self._folders) > 1)

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

        def opened(place: Path) -> BagHistory:
            if check:
                _refuse_elsewhere(place)
            return BagHistory(self._bag_of(place))

        return self.core.get(PlaybackPart).open(place, opened)

    def close(self) -> None:
        """Remove what was unpacked."""
        for folder in self._unpacked:
            shutil.rmtree(folder, ignore_errors=True)

    def _is_offered(self, place: Path) -> bool:
        if "\0" in str(place) or not place.is_absolute() or ".." in place.parts:
            return False
        return place.parent in self._folders or any(
            each.path == place for each in self.core.outputs.all
        )

    def _bag_of(self, place: Path) -> Path:
        """Return the bag to read; that of a report is unpacked first. Blocks."""
        if place.suffix.lower() != REPORT:
            return place
        folder = Path(tempfile.mkdtemp(prefix="webviz-report-"))
        self._unpacked.append(folder)
        return read_report(place, folder).bag


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
    found: dict[Path, Bag] = {}
    for folder in folders:
        with contextlib.suppress(OSError), os.scandir(folder) as entries:
            for entry, _ in zip(entries, range(MAX_ENTRIES), strict=False):
                _note(Path(entry.path), found)
    for path in written:
        _note(path, found)
    bags = sorted(found.values(), key=lambda bag: (-bag.changed_s, bag.name))
    return bags[:MAX_LISTED]


def _note(path: Path, found: dict[Path, Bag]) -> None:
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
        found[path] = Bag(str(sendable(str(path))), name, folder, round(size / 1e6, 1), changed_s)

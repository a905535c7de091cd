"""Sharing the shown moment as one HTML file, which opens without webviz."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Mapping
from concurrent.futures import Future, wait
from pathlib import Path
from typing import Any, Protocol

import msgspec

from webviz.api.errors import Error
from webviz.api.status import Level
from webviz.data.disk import DiskThreads
from webviz.data.names import new_path
from webviz.data.words import counted
from webviz.data.working_folder import working_folder
from webviz.engine.commands import Command, ListMoment, Sender, ShareMoment, StopSharing
from webviz.engine.parts.files import FilesPart
from webviz.engine.parts.part import Core, Handler, Part
from webviz.engine.parts.shown_moment import as_seen, slice_around
from webviz.engine.state import State
from webviz.files import config as config_file
from webviz.files.config import Config
from webviz.sources.past_state import SharingState
from webviz.sources.player import Player
from webviz.sources.slices import Slice, write_slice

MAX_SLICE = 2_000_000_000
"""Bytes of the messages on the disk while the file is made."""
ENDING_S = 5.0
"""For an export that was stopped, when the viewer ends."""
STEP = 100
"""Steps of the progress that is shown."""

_exports = DiskThreads(8)
"""For files that take minutes to be made."""


class SharedMoment(msgspec.Struct, frozen=True):
    """A recording to make a file of.

    Args:
        bag: MCAP file.
        config: YAML file.
        path: of the file to make, in a folder that is removed afterwards.
        name: of the config, for the page; "" for none.
        at_s: moment to begin with, in seconds from the start of the bag.
    """

    bag: Path
    config: Path
    path: Path
    name: str
    at_s: float


class Exporter(Protocol):
    """Makes the file, in any thread."""

    def __call__(
        self, moment: SharedMoment, tell: Callable[[float], object], stopped: threading.Event
    ) -> str:
        """Make it; returns its length and size as the end of a sentence.

        Args:
            moment: what to make.
            tell: called with the share that is done.
            stopped: set once the file is not wanted any more.

        Raises:
            Error: one sentence.
        """
        ...


class _Running(msgspec.Struct):
    """An export that goes on."""

    stopped: threading.Event
    done: Future[str]
    share: float = 0.0


class SharingPart(Part):
    """Writes what is shown as one HTML file, one at a time.

    Args:
        core: shared by all parts.
        files: have the config.
        player: of what is shown.
        state: the last state, from any thread.
        export: makes the file; None if it cannot be made.
    """

    name = "Share"

    def __init__(
        self,
        core: Core,
        files: FilesPart,
        player: Player,
        state: Callable[[], State],
        export: Exporter | None,
    ) -> None:
        super().__init__(core)
        self._files = files
        self._player = player
        self._state = state
        self._export = export
        self._running: _Running | None = None
        self._told = SharingState()

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """The handler of each command."""
        return {ListMoment: self._list, ShareMoment: self._share, StopSharing: self._stop}

    def keep_up(self, commanded: bool) -> None:
        """Notice that an export has ended."""
        running = self._running
        if running is None or not running.done.done():
            return
        self._running = None
        if running.stopped.is_set():
            return
        error = running.done.exception()
        level = Level.OK if error is None else Level.ERROR
        if error is None:
            text = running.done.result()
        else:
            known = isinstance(error, Error)
            text = str(error) if known else self.core.guard.note("Share", error)
        self._told = SharingState(number=self._told.number + 1, level=level, text=text)

    def state(self) -> Mapping[str, Any]:
        """Return the export that goes on, and the answer to the last one."""
        told, running = self._told, self._running
        share = None if running is None else int(running.share * STEP) / STEP
        return {"sharing": SharingState(share, told.number, told.level, told.text)}

    def close(self) -> None:
        """Stop an export."""
        if self._running is not None:
            self._running.stopped.set()
            wait([self._running.done], ENDING_S)

    def _list(self, command: ListMoment, sender: Sender) -> str:
        part, source = slice_around(self._player)
        state = self._state()
        displays = sum(row.type != "Group" for row in state.rows)
        of = "memory" if source == "live" else "the bag"
        return "\n".join(
            (
                f"{part.seconds:.1f} s of {counted(part.topics, 'topic')} from {of}; it opens at "
                "the moment that is shown",
                f"The scene with {counted(displays, 'display')}, your view, panels and images",
                "Names of topics, frames, nodes and displays, and the texts that are shown",
            )
        )

    def _share(self, command: ShareMoment, sender: Sender) -> str:
        export = self._export
        if export is None:
            raise Error("This viewer cannot make files to share. Use `webviz export`.")
        if command.path and sender.browser is not None:
            raise Error("A page cannot choose the file to share.")
        if self._running is not None:
            raise Error("Another file is being made. Wait for it, or stop it.")
        part, _ = slice_around(self._player)
        config = as_seen(self._files.config(), self._state(), sender)
        path = Path(command.path).absolute() if command.path else new_path("webviz_run", ".html")
        name = self._files.path.name if self._files.path else ""
        stopped = threading.Event()

        def work() -> str:
            return _made(part, config, (path, name), export, tell, stopped)

        def tell(share: float) -> None:
            running.share = share

        try:
            running = self._running = _Running(stopped, _exports.start(work))
        except OSError as error:
            raise Error(f"Failed: {error.strerror}.") from error
        return f"Making {path.name}. Panels and scene stay usable meanwhile."

    def _stop(self, command: StopSharing, sender: Sender) -> str:
        if self._running is None:
            raise Error("No file is being made.")
        self._running.stopped.set()
        return "Stopped; no file was written."


def _made(
    part: Slice,
    config: Config,
    target: tuple[Path, str],
    export: Exporter,
    tell: Callable[[float], object],
    stopped: threading.Event,
) -> str:
    """Write the messages and the config to a temporary folder, and make the file of them."""
    path, name = target
    try:
        with working_folder(".webviz_share_", path.parent) as folder:
            bag, shown = folder / f"{path.stem}.mcap", folder / "config.yaml"

            def unchanged(data: bytes) -> bytes:
                if stopped.is_set():
                    raise Error("Stopped.")
                return data

            written = write_slice(part, bag, MAX_SLICE, unchanged)
            shown.write_text(config_file.dump(config), encoding="utf-8")
            at_s = (written.at_ns - written.first_ns) / 1e9
            made = folder / path.name
            size = export(SharedMoment(bag, shown, made, name, at_s), tell, stopped)
            made.replace(path)
            return f"Saved {path.name}: {size}"
    except OSError as error:
        reason = os.strerror(error.errno) if error.errno else str(error)
        raise Error(f"Cannot write {path}: {reason}. Choose another place.") from error

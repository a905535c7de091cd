"""Sharing the shown moment as one HTML file, which opens without webviz."""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Mapping
from concurrent.futures import Future, wait
from pathlib import Path
from typing import Any

import msgspec

from webviz.api.errors import Error
from webviz.api.roles import Role
from webviz.api.status import Level
from webviz.data.disk import DiskThreads
from webviz.data.names import new_path
from webviz.data.words import counted
from webviz.data.working_folder import working_folder
from webviz.engine.commands import Sender
from webviz.engine.feature import Feature, command, store
from webviz.engine.forms import sendable
from webviz.engine.parts.config import ConfigPart
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.part import HostProgram, PartContext
from webviz.engine.parts.views import ViewsPart
from webviz.engine.store import PageStore
from webviz.features.sharing.exporting import SharedMoment, export
from webviz.files import config as config_file
from webviz.files.config import Config
from webviz.sources.slices import Slice, margins, slice_around, write_slice

MAX_SLICE = 2_000_000_000
"""Bytes of the messages on the disk while the file is made."""
ENDING_S = 5.0
"""Time in seconds for an export that was stopped, when the viewer ends."""
STEP = 100
"""Steps of the progress that is shown."""

_exports = DiskThreads(8)
"""Threads for files that take minutes to be made."""


class _Running(msgspec.Struct):
    """An export that goes on."""

    stopped: threading.Event
    done: Future[str]
    path: Path
    sender: Sender
    share: float = 0.0


class SharingState(msgspec.Struct, frozen=True):
    """Files that share the shown moment.

    Args:
        share: that is done of the one that is being made, None for none.
        number: how many have ended.
        level, text: how the last one ended.
    """

    share: float | None = None
    number: int = 0
    level: Level = Level.OK
    text: str = ""


class SharingStore(PageStore, frozen=True):
    """The same, for pages."""

    share: float | None
    number: int
    level: str
    text: str


class SharingFeature(Feature):
    """Writes what is shown as one HTML file, one at a time."""

    name = "Share"
    module = "sharing.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._running: _Running | None = None
        self._ended = SharingState()

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
            self.context.outputs.add(running.path, "shared", text, running.sender)
        else:
            is_expected = isinstance(error, Error)
            text = str(error) if is_expected else self.context.boundary.note("Share", error)
        self._ended = SharingState(number=self._ended.number + 1, level=level, text=text)

    def state(self) -> Mapping[str, Any]:
        """Return the export that goes on, and the answer to the last one."""
        running = self._running
        share = None if running is None else int(running.share * STEP) / STEP
        return {"sharing": msgspec.structs.replace(self._ended, share=share)}

    @store(Role.OWNER)
    def sharing(self, argument: str) -> SharingStore:
        """Return the file that is being made of what is shown, and how the last one ended."""
        state: SharingState = self.state()["sharing"]
        text = str(sendable(state.text))
        return SharingStore(state.share, state.number, state.level.name.lower(), text)

    def close(self) -> None:
        """Stop an export."""
        if self._running is not None:
            self._running.stopped.set()
            wait([self._running.done], ENDING_S)

    @command(Role.OWNER)
    def list_moment(self, before_s: float | None = None, after_s: float | None = None) -> str:
        """Answer with what `ShareMoment` would write, one line per part.

        Args:
            before_s, after_s: as those of `ShareMoment`.
        """
        part, source = slice_around(self.context.player, margins(before_s, after_s))
        displays = sum(row.type != "Group" for row in self.context.get(DisplaysPart).rows)
        of = "memory" if source == "live" else "the bag"
        return "\n".join(
            (
                f"{part.seconds:.1f} s of {counted(part.topics, 'topic')} from {of}; it opens at "
                "the moment that is shown",
                f"The scene with {counted(displays, 'display')}, your view, panels and images",
                "Names of topics, frames, nodes and displays, and the texts that are shown",
            )
        )

    @command(Role.OWNER)
    def share_moment(
        self,
        sender: Sender,
        path: str = "",
        before_s: float | None = None,
        after_s: float | None = None,
    ) -> str:
        """Begin to write the moment that is shown, and the time around it, as one HTML file.

        Args:
            path: of the file, only for programs; "" is one in the working folder, named by the
                time.
            before_s, after_s: seconds around the moment; without, the selected span or half a
                minute of a bag, and all that is remembered of live topics.
        """
        context, files = self.context, self.context.get(ConfigPart)
        if context.host.offer is None:
            raise Error("This viewer cannot make files to share. Use `webviz export`.")
        if path and sender.browser is not None:
            raise Error("A page cannot choose the file to share.")
        if self._running is not None:
            raise Error("Another file is being made. Wait for it, or stop it.")
        part, _ = slice_around(context.player, margins(before_s, after_s))
        config = context.get(ViewsPart).as_seen(files.config(), sender)
        output = Path(path).absolute() if path else new_path("webviz_run", ".html")
        name = files.path.name if files.path else ""
        stopped = threading.Event()

        def work() -> str:
            return _export(part, config, (output, name), context.host, progress, stopped)

        def progress(share: float) -> None:
            running.share = share

        try:
            running = self._running = _Running(stopped, _exports.start(work), output, sender)
        except OSError as error:
            raise Error(f"Failed: {error.strerror}.") from error
        running.done.add_done_callback(lambda _: self.context.player.inbox.arrived.set())
        return f"Making {output.name}. Panels and scene stay usable meanwhile."

    @command(Role.OWNER)
    def stop_sharing(self) -> str:
        """Stop writing such a file, and remove it."""
        if self._running is None:
            raise Error("No file is being made.")
        self._running.stopped.set()
        return "Stopped; no file was written."


def _export(
    part: Slice,
    config: Config,
    target: tuple[Path, str],
    host: HostProgram,
    progress: Callable[[float], object],
    stopped: threading.Event,
) -> str:
    """Write the messages and the config to a temporary folder, and make the file of them."""
    path, name = target
    try:
        with working_folder(".webviz_share_", path.parent) as folder:
            bag, config_path = folder / f"{path.stem}.mcap", folder / "config.yaml"

            def unchanged(data: bytes) -> bytes:
                if stopped.is_set():
                    raise Error("Stopped.")
                return data

            written = write_slice(part, bag, MAX_SLICE, unchanged)
            config_path.write_text(config_file.dump(config), encoding="utf-8")
            at_s = (written.at_ns - written.first_ns) / 1e9
            temporary = folder / path.name
            size = export(
                SharedMoment(bag, config_path, temporary, name, at_s), host, progress, stopped
            )
            temporary.replace(path)
            return f"Saved {path.name}: {size}"
    except OSError as error:
        reason = os.strerror(error.errno) if error.errno else str(error)
        raise Error(f"Cannot write {path}: {reason}. Choose another place.") from error

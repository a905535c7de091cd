"""Files reach people: those that a viewer wrote are found, downloaded and opened in the page."""

from __future__ import annotations

import base64
import functools
import os
import stat
from collections.abc import Mapping
from concurrent.futures import Future
from pathlib import Path
from typing import Any, ClassVar

import msgspec

from webviz.api.errors import Error
from webviz.api.roles import Role
from webviz.data.disk import DiskThreads
from webviz.engine.feature import command, store
from webviz.engine.forms import sendable
from webviz.engine.parts.outputs import OutputFile
from webviz.engine.store import PageStore
from webviz.page.dispatcher import Dispatcher, PageFeature
from webviz.page.page_request import PageRequest

BLOCK = 768 << 10
"""Bytes of a file that are sent at once: 1 MB in base64."""
MAX_FILES = 1000
"""Largest number of files of a folder."""
PAGES_ONLY = "Only pages read files in parts. Programs know the path."

_disk = DiskThreads(4)
"""Threads for files that pages download."""


class WrittenFile(msgspec.Struct, frozen=True):
    """A file that was written; see `webviz.engine.parts.outputs.OutputFile`."""

    path: str
    name: str
    kind: str
    text: str
    browser: int | None


class OutputsStore(PageStore, frozen=True):
    """The newest files by number."""

    spread: ClassVar = {"files": ""}

    files: Mapping[str, WrittenFile]


class OutputsFeature(PageFeature):
    """Lets owners see and download recordings, reports and shared moments."""

    name = "Outputs"
    module = "outputs.js"

    def attach(self, dispatcher: Dispatcher) -> None:
        """Take the requests for parts of files, which no frame waits for."""
        dispatcher.take("ReadOutput", self._read)

    @store(Role.OWNER)
    def outputs(self, argument: str) -> OutputsStore:
        """Return the files that were written."""
        return OutputsStore(
            {str(each.number): _written_file(each) for each in self.context.outputs.all}
        )

    @command(Role.OWNER)
    def read_output(self, number: int, file: int = 0, offset: int = 0) -> None:
        """Answer with a part of a file that was written, in base64.

        Args:
            number: of the output.
            file: index of the file, of a folder with several.
            offset: of the part, in bytes.
        """
        raise Error(PAGES_ONLY)

    # Called on the event loop

    def _read(self, page_request: PageRequest, command: Any) -> None:
        output = self.context.outputs.find(command.number)
        if output is None:
            page_request.refuse("This file is no longer listed. Copy it from the viewer's machine.")
            return

        def answer(future: Future[dict[str, str]]) -> None:
            if not page_request.refused_by(future):
                page_request.answer(**future.result())

        read = functools.partial(part_of, output.path, command.file, command.offset)
        try:
            _disk.start(read).add_done_callback(answer)
        except OSError as error:
            page_request.refuse(f"Not read: {error.strerror}. Try again later.")


def part_of(path: Path, number: int, offset: int) -> dict[str, str]:
    """Return a part of a file in base64 with its name and size, and how many files there are.

    Args:
        path: of a file, or of a folder of which the files are read in the order of their names.
        number: of the file in the folder.
        offset: in bytes.

    Raises:
        Error: it cannot be read; one sentence.
    """
    try:
        files = [path]
        if path.is_dir():
            files = sorted(each for each in path.iterdir() if each.is_file())[:MAX_FILES]
        if not (0 <= number < len(files)) or offset < 0:
            raise Error(f"{path.name} has no such part. Reload the page.")
        # What was put in its place meanwhile is neither followed nor waited for.
        flags = os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC
        with open(os.open(files[number], flags), "rb") as file:
            about = os.fstat(file.fileno())
            if not stat.S_ISREG(about.st_mode):
                raise Error(f"{files[number].name} is not a regular file.")
            file.seek(offset)
            data = file.read(BLOCK)
    except OSError as error:
        raise Error(f"Cannot read {path.name}: {error.strerror or error}.") from error
    return {
        "name": files[number].name,
        "count": str(len(files)),
        "size": str(about.st_size),
        "data": base64.b64encode(data).decode("ascii"),
    }


def _written_file(output: OutputFile) -> WrittenFile:
    path, name, text = (str(sendable(t)) for t in (str(output.path), output.path.name, output.text))
    return WrittenFile(path, name, output.kind, text, output.browser)

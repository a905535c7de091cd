"""Bags and reports that pages send in parts, one at a time."""

from __future__ import annotations

import base64
import binascii
import contextlib
import secrets
import shutil
import tempfile
import threading
import time
from pathlib import Path

import msgspec

from webviz.api.errors import Error
from webviz.data.names import file_problem_of

SUFFIXES = (".mcap", ".db3", ".zip")
MAX_BYTES = 4_000_000_000
"""Limit in bytes of a file."""
MAX_TOTAL = 8_000_000_000
"""Limit in bytes of all files; they are kept until the viewer ends, since one of them may be
played."""
RESERVE = 1_000_000_000
"""Bytes of the disk that uploads leave free."""
BLOCK = 512 << 10
"""Bytes of a part."""
SILENCE_S = 30.0
"""Time after which an upload that does not go on makes room for another."""


class _Running(msgspec.Struct):
    """An upload that goes on."""

    token: str
    browser: int
    path: Path
    size: int
    written: int
    heard_s: float


class Uploads:
    """Files in a temporary folder; from any thread, as all methods wait for the disk."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._folder: Path | None = None
        self._running: _Running | None = None
        self._total = 0
        self.complete: frozenset[Path] = frozenset()
        """The files that have come whole."""

    def begin(self, browser: int, name: str, size: int) -> str:
        """Begin to take a file; returns the token of its parts.

        Raises:
            Error: it is not taken; one sentence.
        """
        if "/" in name or "\\" in name or file_problem_of(name) or name.startswith("."):
            raise Error("Not uploaded: this is not a valid file name. Rename the file.")
        if not name.lower().endswith(SUFFIXES):
            raise Error(f"Not uploaded: expected a file that ends with {', '.join(SUFFIXES)}.")
        if not 0 < size <= MAX_BYTES:
            raise Error("Not uploaded: the limit is 4 GB. Copy the file into a library folder.")
        try:
            return self._begun(browser, name, size)
        except OSError as error:
            raise Error(f"Not uploaded: {error.strerror}. Make room first.") from error

    def _begun(self, browser: int, name: str, size: int) -> str:
        with self._lock:
            running = self._running
            if running is not None:
                is_silent = time.monotonic() - running.heard_s > SILENCE_S
                if running.browser != browser and not is_silent:
                    raise Error("Not uploaded: another file is under way. Wait for it.")
                self._discard()
            if self._total + size > MAX_TOTAL:
                raise Error("Not uploaded: 8 GB were uploaded, which is the limit until a restart.")
            folder = self._ensured_folder()
            if shutil.disk_usage(folder).free - size < RESERVE:
                raise Error("Not uploaded: the disk of the viewer is too full. Make room first.")
            token = secrets.token_hex(8)
            (place := folder / token).mkdir()
            path = place / name
            path.touch(exist_ok=False)
            self._running = _Running(token, browser, path, size, 0, time.monotonic())
            return token

    def add(self, browser: int, token: str, offset: int, text: str) -> Path | None:
        """Take a part in base64; returns the file once it is complete.

        Raises:
            Error: it is not the next part; one sentence.
        """
        try:
            data = base64.b64decode(text, validate=True)
        except (binascii.Error, ValueError) as error:
            raise Error("Not uploaded: a part is damaged. Try again.") from error
        with self._lock:
            running = self._running
            if running is None or (running.token, running.browser) != (token, browser):
                raise Error("Not uploaded: it was ended. Try again.")
            is_next = offset == running.written and 0 < len(data) <= BLOCK
            if not is_next or offset + len(data) > running.size:
                self._discard()
                raise Error("Not uploaded: the parts do not fit. Try again.")
            try:
                with running.path.open("ab") as file:
                    file.write(data)
            except OSError as error:
                self._discard()
                raise Error(f"Not uploaded: {error.strerror}. Make room first.") from error
            running.written += len(data)
            running.heard_s = time.monotonic()
            self._total += len(data)
            if running.written < running.size:
                return None
            self._running = None
            self.complete |= {running.path}
            return running.path

    def close(self) -> None:
        """Remove all files."""
        with self._lock:
            if self._folder is not None:
                shutil.rmtree(self._folder, ignore_errors=True)

    def _ensured_folder(self) -> Path:
        if self._folder is None:
            self._folder = Path(tempfile.mkdtemp(prefix="webviz-uploads-"))
        return self._folder

    def _discard(self) -> None:
        """Remove what has come of the one that goes on."""
        if self._running is not None:
            self._total -= self._running.written
            with contextlib.suppress(OSError):
                shutil.rmtree(self._running.path.parent)
            self._running = None

"""The file of a run: the page, its modules, and the recorded chunks."""

from __future__ import annotations

import base64
from collections.abc import Iterator, Mapping
from importlib import resources
from typing import IO, Any

import msgspec

from webviz.scene.constants import CONSTANTS
from webviz.server.channel.modules import Modules
from webviz.server.http.viser_page import client_page, with_head

POLICY = "; ".join(
    (
        "default-src 'none'",
        "script-src 'unsafe-inline' 'unsafe-eval' blob: data:",
        "worker-src blob:",
        "style-src 'unsafe-inline'",
        "img-src data: blob:",
        "font-src data:",
        "connect-src data: blob:",
        "base-uri 'none'",
        "form-action 'none'",
    )
)
"""As the server's (`webviz.server.http.requests.add_policy`), without any server."""
HEAD = f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">\n'
END = b"</body>"
LINE = 3 << 18
"""Bytes that are encoded at once; a multiple of three, so that none of the text is padding."""


class RunFile:
    """Writes the file piece by piece; nothing of the recording is in it but as base64.

    Args:
        file: to write to.
    """

    def __init__(self, file: IO[bytes]) -> None:
        self._file = file
        own = (resources.files("webviz.shell.export") / "head.html").read_bytes()
        page = with_head(client_page(), HEAD.encode() + own + Modules(CONSTANTS).head)
        start, end, rest = page.rpartition(END)
        self._rest = end + rest
        file.write(start)
        self.client_bytes = len(page)
        """Size of everything but the recording."""
        self.bytes = len(page)
        """Size so far."""

    def write_chunk(self, packed: bytes) -> int:
        """Add a chunk of the tape; the size of the file with it."""
        self._write("chunk", packed)
        return self.bytes

    def finish(self, about: Mapping[str, Any]) -> None:
        """End the file.

        Args:
            about: the index of the chunks, and what holds for the run as a whole.
        """
        self._write("about", msgspec.json.encode(about))
        self._file.write(self._rest)

    def _write(self, kind: str, data: bytes) -> None:
        for part in (f'<script type="webviz/{kind}">'.encode(), *_text(data), b"</script>\n"):
            self._file.write(part)
            self.bytes += len(part)


def _text(data: bytes) -> Iterator[bytes]:
    for start in range(0, len(data), LINE):
        yield base64.b64encode(data[start : start + LINE])

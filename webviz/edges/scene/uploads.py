"""Limits the files that a browser may upload."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

MAX_BYTES = 16 << 20
"""Announced size of all files in transfer at once."""
MAX_OPEN = 4
MAX_NAME = 255

START, PART = "FileTransferStartUpload", "FileTransferPart"
PART_BYTES = 512 * 1024
"""The page cuts files into parts of this size."""


@dataclass
class _Upload:
    size: int
    parts: int
    received: int = 0
    numbers: set[int] = field(default_factory=set)


class Uploads:
    """The files that a browser is sending.

    viser keeps every part until the file is complete or the browser disconnects, whatever the
    sizes. Here a part is accepted only once, if its file was announced and within the announced
    size; a file counts as long as viser waits for it.
    """

    def __init__(self) -> None:
        self._open: dict[str, _Upload] = {}

    def accepts(self, message: dict[str, Any]) -> bool:
        """Whether to accept a message that announces a file or carries a part of one."""
        transfer = message.get("transfer_uuid")
        if not isinstance(transfer, str) or len(transfer) > MAX_NAME:
            return False
        if message.get("type") == START:
            return self._accepts_start(transfer, message)
        return self._accepts_part(transfer, message)

    def _accepts_start(self, transfer: str, message: dict[str, Any]) -> bool:
        size, parts = message.get("size_bytes"), message.get("part_count")
        words = [message.get("filename"), message.get("mime_type")]
        if not all(isinstance(word, str) and len(word) <= MAX_NAME for word in words):
            return False
        if type(size) is not int or type(parts) is not int or size < 0:
            return False
        if parts != -(-size // PART_BYTES) or transfer in self._open:
            return False
        reserved = sum(upload.size for upload in self._open.values())
        if reserved + size > MAX_BYTES or len(self._open) >= MAX_OPEN:
            return False
        if parts:
            self._open[transfer] = _Upload(size, parts)
        return True

    def _accepts_part(self, transfer: str, message: dict[str, Any]) -> bool:
        upload = self._open.get(transfer)
        number, content = message.get("part_index"), message.get("content")
        if upload is None or type(number) is not int or not isinstance(content, bytes):
            return False
        if not 0 <= number < upload.parts or number in upload.numbers:
            return False
        if upload.received + len(content) > upload.size:
            return False
        upload.received += len(content)
        upload.numbers.add(number)
        if len(upload.numbers) == upload.parts:
            del self._open[transfer]
        return True

"""Decompression within bounds, whatever the data claims."""

from __future__ import annotations

import io
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

import lz4.frame
import zstandard

MAX_BYTES = 256 << 20
"""Size of the largest chunk or message that is read. Recorders close chunks at 1 to 4 MiB, or
after the one message that is larger; the largest clouds and maps of real robots have 100 MB."""
MAX_FILE = 8 << 30
"""Size to which a compressed file is unpacked."""
KEPT_FREE = 1 << 30
"""Bytes that stay free on the disk it is unpacked to."""
COMPRESSIONS = ("", "zstd", "lz4")
MARKS = {b"\x28\xb5\x2f\xfd": "zstd", b"\x04\x22\x4d\x18": "lz4"}
"""First bytes of compressed data."""
FAULTS = (zstandard.ZstdError, RuntimeError, EOFError, OSError, ValueError)
"""Errors that damaged data raises: lz4 raises RuntimeError."""
_BLOCK = 1 << 17
"""Bytes at a time. Of damaged data, those before the damaged block are kept."""


def unpack(data: bytes, compression: str, limit: int) -> tuple[bytes, str]:
    """Unpack data of one or several frames, whether or not they contain their size.

    Args:
        data: of a chunk or message.
        compression: of `COMPRESSIONS`.
        limit: bytes to return at most.

    Returns:
        The beginning that can be unpacked; and why the rest cannot be, "" if that is all.
    """
    if not compression:
        return data[:limit], _too_large(limit) if len(data) > limit else ""
    if (whole := _unpacked_at_once(data, compression, limit)) is not None:
        return whole, ""
    output = io.BytesIO()
    fault = ""
    try:
        for block in _blocks(io.BytesIO(data), compression):
            left = limit - output.tell()
            output.write(block[:left])
            if len(block) > left:
                fault = _too_large(limit)
                break
    except FAULTS:
        fault = f"its {compression} data is damaged"
    return output.getvalue(), fault


def unpack_message(data: bytes, encoding: str) -> tuple[bytes, str]:
    """Unpack a message that rosbag2 has compressed separately, which no other file needs to say.

    Messages in CDR begin with a zero, which no compressed data does.

    Args:
        data: as recorded.
        encoding: of its channel.

    Returns:
        The message, and why it is incomplete, "" if it is not.
    """
    compression = MARKS.get(data[:4], "") if encoding == "cdr" else ""
    return unpack(data, compression, MAX_BYTES) if compression else (data, "")


def _unpacked_at_once(data: bytes, compression: str, limit: int) -> bytes | None:
    """Unpack one frame that says that it has as many bytes as expected, None for any other.

    That takes half of the time of reading block by block.
    """
    if compression != "zstd":
        return None
    try:
        if zstandard.frame_content_size(data) != limit:
            return None
        whole = zstandard.ZstdDecompressor().decompress(data)
    except zstandard.ZstdError:
        return None
    return whole if len(whole) == limit else None


def unpack_file(path: Path, compression: str, folder: Path) -> tuple[Path, str]:
    """Unpack a file into a folder.

    Returns:
        The new file, which has the beginning that can be unpacked; and why the rest cannot be, ""
        if that is all.

    Raises:
        OSError: a file cannot be read or written.
    """
    target = folder / path.stem
    limit = min(MAX_FILE, max(0, shutil.disk_usage(folder).free - KEPT_FREE))
    size = 0
    with path.open("rb") as packed, target.open("wb") as unpacked:
        blocks = _blocks(packed, compression)
        while True:
            try:
                block = next(blocks, b"")
            except FAULTS:
                return target, f"its {compression} data is damaged or cut off"
            if not block:
                return target, ""
            size += len(block)
            if size > limit:
                return target, _too_large(limit)
            unpacked.write(block)


def _blocks(stream: BinaryIO, compression: str) -> Iterator[bytes]:
    if compression == "zstd":
        reader = zstandard.ZstdDecompressor().stream_reader(stream, read_across_frames=True)
    else:
        reader = lz4.frame.LZ4FrameFile(stream)
    with reader:
        while block := reader.read(_BLOCK):
            yield block


def _too_large(limit: int) -> str:
    return f"it expands to more than {limit:,} bytes".replace(",", " ")

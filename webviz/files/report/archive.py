"""Zip files of bug reports. Those that are read may come from strangers."""

from __future__ import annotations

import contextlib
import os
import secrets
import shutil
import struct
import zipfile
import zlib
from collections.abc import Mapping
from pathlib import Path

import msgspec

from webviz.data.words import plain
from webviz.files.report.content import VERSION, BugReport, ReportError, UnpackedReport

REPORT, CONFIG, SLICE = "report.json", "config.yaml", "slice.mcap"
PICTURES = ("picture.png", "picture.jpg")
MAX_SLICE = 2 << 30
LIMITS = {
    REPORT: 16 << 20,
    CONFIG: 4 << 20,
    SLICE: MAX_SLICE,
    **dict.fromkeys(PICTURES, 32 << 20),
}
"""Unpacked bytes of the members that are read; others are never unpacked."""
MAX_DIRECTORY = 64 << 10
"""Bytes of the table of contents, which is read as a whole."""
END, END_64 = b"PK\x05\x06", b"PK\x06\x07"
"""Signatures of the end of a zip file, and of the extension that allows for larger tables."""
END_BYTES = 22 + (1 << 16)
"""Bytes of the end with its comment."""
MAX_REASON = 200
"""Longest reason why a file is refused, in characters."""
BLOCK = 1 << 20


def write_report(path: Path, members: Mapping[str, bytes | Path]) -> int:
    """Write a zip file atomically, readable by its owner only.

    Args:
        path: of the file.
        members: content, or the file to copy, by name.

    Returns:
        Its size in bytes.

    Raises:
        ReportError: it cannot be written; what was there before is unchanged.
    """
    part = path.with_name(f".{secrets.token_hex(8)}.zip.part")
    try:
        with open(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "wb") as file:
            with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
                for name, content in members.items():
                    if isinstance(content, Path):  # its chunks are compressed already
                        archive.write(content, name, zipfile.ZIP_STORED)
                    else:
                        archive.writestr(name, content)
            file.flush()
            os.fsync(file.fileno())
        size = part.stat().st_size
        part.replace(path)
    except OSError as error:
        reason = error.strerror or error
        raise ReportError(f"Cannot write {path}: {reason}. Choose another place.") from error
    finally:
        with contextlib.suppress(OSError):
            part.unlink(missing_ok=True)
    return size


def read_report(path: Path, folder: Path) -> UnpackedReport:
    """Unpack a report, of which nothing is trusted.

    Args:
        path: of the zip file.
        folder: an empty one; only files of fixed names are written to it.

    Raises:
        ReportError: it is not a report, damaged, or too large; one sentence.
    """
    try:
        _refuse_large_directory(path)
        with zipfile.ZipFile(path) as archive:
            members = _members(path, archive)
            bag, config = folder / f"{path.stem}.mcap", folder / CONFIG
            picture = next((folder / name for name in PICTURES if name in members), None)
            _unpack(archive, members[SLICE], bag)
            _unpack(archive, members[CONFIG], config)
            if picture is not None:
                _unpack(archive, members[picture.name], picture)
            text = archive.read(members[REPORT])
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError) as error:
        raise _no_report(path, str(error) or "it is damaged") from error
    except OSError as error:
        raise ReportError(f"Cannot read {path}: {error.strerror or error}.") from error
    return UnpackedReport(_decoded(path, text), bag, config, picture)


def _refuse_large_directory(path: Path) -> None:
    """Refuse a table of contents that would fill the memory."""
    with path.open("rb") as file:
        file.seek(0, os.SEEK_END)
        file.seek(max(0, file.tell() - END_BYTES))
        tail = file.read()
    place = tail.rfind(END)
    if place < 0 or len(tail) < place + 22:
        raise _no_report(path, "it is not a zip file")
    (size,) = struct.unpack_from("<I", tail, place + 12)
    if size > MAX_DIRECTORY or tail[max(0, place - 20) : place].startswith(END_64):
        raise _no_report(path, "it contains too many files")


def _members(path: Path, archive: zipfile.ZipFile) -> dict[str, zipfile.ZipInfo]:
    """Return the members that are read, by name."""
    members: dict[str, zipfile.ZipInfo] = {}
    for info in archive.infolist():
        limit = LIMITS.get(info.filename)
        if limit is None:
            continue
        if info.filename in members:
            raise _no_report(path, f"it contains {info.filename} twice")
        if info.file_size > limit:
            megabytes = limit >> 20
            raise _no_report(path, f"{info.filename} is larger than {megabytes} MB")
        members[info.filename] = info
    for name in (REPORT, CONFIG, SLICE):
        if name not in members:
            raise _no_report(path, f"{name} is missing from it")
    return members


def _unpack(archive: zipfile.ZipFile, info: zipfile.ZipInfo, target: Path) -> None:
    """Write a member to a file; no more is read than it declares."""
    with archive.open(info) as source, target.open("xb") as file:
        shutil.copyfileobj(source, file, BLOCK)


def _decoded(path: Path, text: bytes) -> BugReport:
    try:
        report = msgspec.json.decode(text, type=BugReport)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise _no_report(path, f"report.json is invalid ({error})") from error
    if report.version != VERSION:
        raise _no_report(path, f"its version is {report.version}, not {VERSION}")
    return report


def _no_report(path: Path, why: str) -> ReportError:
    reason = plain(why, MAX_REASON).rstrip(".")  # zipfile quotes names of up to 64 KB
    return ReportError(
        f"{path} is not a bug report that can be opened: {reason}. Make it again with "
        "`webviz report`."
    )

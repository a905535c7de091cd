"""Recordings that rules made, as they are in their folder."""

from __future__ import annotations

import itertools
import shlex
import shutil
from collections.abc import Sequence
from pathlib import Path

import msgspec

from webviz.engine.forms import sendable
from webviz.engine.store import PageStore

FOLDER = "webviz_black_box"
"""Name of the folder in the working folder."""
MAX_LISTED = 50
"""Recordings that pages list."""
PARTS = "metadata.yaml", "*.mcap"
"""Parts of a recording; either may be missing if it was cut off or has no messages."""


class SavedMoment(msgspec.Struct, frozen=True):
    """A recording that a rule made.

    Args:
        path: of its folder, whose name has the time and the cause.
        size: bytes of its files.
    """

    path: Path
    size: int


class BlackBoxState(msgspec.Struct, frozen=True):
    """Recordings that rules made.

    Args:
        saved: those in the folder, the newest first.
        saving: cause of the one that goes on, "" for none.
    """

    saved: tuple[SavedMoment, ...] = ()
    saving: str = ""


class BlackBoxStore(PageStore, frozen=True):
    """Recordings that rules made.

    Args:
        saving: cause of the one that goes on, "" for none.
        saved: the newest first: name, megabytes, path, and the command to open it elsewhere.
    """

    saving: str
    saved: Sequence[tuple[str, float, str, str]]


def black_box_store(box: BlackBoxState | None, has_rules: bool) -> BlackBoxStore | None:
    """Return what pages show of recordings, None without any rule or recording."""
    if box is None or not (box.saved or has_rules):
        return None
    return BlackBoxStore(
        saving=str(sendable(box.saving)),
        saved=[
            (
                str(sendable(each.path.name)),
                round(each.size / 1e6, 1),
                str(sendable(str(each.path))),
                str(sendable(f"webviz --bag {shlex.quote(str(each.path))}")),
            )
            for each in box.saved[:MAX_LISTED]
        ],
    )


def listed() -> tuple[tuple[SavedMoment, ...], int]:
    """Return the recordings in the folder, the newest first, and the free bytes of its disk."""
    files = itertools.chain(*(Path(FOLDER).absolute().glob(f"*/{name}") for name in PARTS))
    paths = {file.parent for file in files}
    saved = tuple(
        SavedMoment(path, sum(each.stat().st_size for each in path.iterdir()))
        for path in sorted(paths, reverse=True)
    )
    return saved, shutil.disk_usage(Path.cwd()).free

"""Loading a robot description outside the frame loop."""

from __future__ import annotations

from pathlib import Path

import msgspec

from webviz import Context
from webviz.data.disk import DiskThreads
from webviz_urdf import Loading, LoadRequest, Robot

Loadings = dict[LoadRequest, Loading]
"""The robots being loaded."""


DISK_S = 5.0
"""A disk that takes longer, such as a dead network mount, does not respond."""
_disk = DiskThreads(16)


class Written(msgspec.Struct, frozen=True):
    """Time at which a file was last written, as the disk said.

    Args:
        path: of the file.
        at_ns: 0 if it is unknown.
        number: of the answer.
    """

    path: str = ""
    at_ns: int = 0
    number: int = 0


def last_written(path: str, before: Written, ctx: Context) -> Written:
    """Return when a file was last written, from a worker that asks the disk; `before` until it has.

    It is asked anew by every second call, as its answer leads to a call itself.
    """
    at_ns = ctx.background(("written", path, before.number), _written_ns, path)
    return before if at_ns is None else Written(path, at_ns, before.number + 1)


def _written_ns(path: str) -> int:
    try:
        return _disk.within(DISK_S, lambda: Path(path).expanduser().stat().st_mtime_ns)
    except (OSError, RuntimeError, ValueError):  # no such file, no response or home, a null byte
        return 0  # loading reports the cause


def load(request: LoadRequest, before: Loadings, ctx: Context, loadings: Loadings) -> Robot | None:
    """Return the robot, None while it is being loaded.

    Args:
        request: what to load.
        before: the loadings of the previous call.
        ctx: for the worker, and the status.
        loadings: receives the loading.

    Raises:
        RobotDescriptionError: it cannot be drawn; the text is one sentence.
    """
    loading = before.get(request) or Loading(request)
    robot = ctx.background(request, loading.run, stop=loading.stop)
    if robot is None:
        loadings[request] = loading
        ctx.loading(progress(loading))
    return robot


def progress(loading: Loading) -> str:
    """Return loading progress for a status."""
    finished, total, link = loading.at
    return f"Loading: {finished} of {total} shapes, at link '{link}'." if total else "Loading."

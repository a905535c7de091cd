"""The process in which `webviz_urdf.loading` loads robots."""

from __future__ import annotations

import contextlib
import pickle
import signal
import sys
import traceback
from collections.abc import Callable
from multiprocessing.connection import Connection
from pathlib import Path

import numpy as np
from PIL import Image

from webviz_urdf.load import load_asset, load_file, load_robot
from webviz_urdf.loading import DEADLINE_S, IDLE_S, RESULT_SHARE, Loaded, LoadRequest
from webviz_urdf.resolve import Resolver
from webviz_urdf.robot import RobotDescriptionError
from webviz_urdf.textures import MAX_PIXELS

try:
    import resource
except ImportError:  # not a Unix
    resource = None

STATM = Path("/proc/self/statm")


def main() -> None:
    """Serve requests until the connection is closed or idle for long."""
    connection = Connection(int(sys.argv[1]))
    # If the machine runs out of memory first, Linux ends this process.
    with contextlib.suppress(OSError):
        Path("/proc/self/oom_score_adj").write_text("1000")
    # For pictures in meshes; PIL refuses twice this number.
    Image.MAX_IMAGE_PIXELS = MAX_PIXELS // 2
    np.dot(
        np.eye(64), np.eye(64)
    )  # BLAS allocates memory of its own, without which it ends the process
    limit = _memory_limit()
    while connection.poll(IDLE_S):
        limit(None)
        try:
            request, resolver, skip, memory = connection.recv()
        except EOFError:
            return
        limit(len(request.data) + memory)
        connection.send_bytes(_answer(connection, request, resolver, skip, memory))
        signal.alarm(0)


def _memory_limit() -> Callable[[int | None], None]:
    """Return the function that limits the bytes that this process takes besides those it has.

    None lifts the limit. There is none on other systems than Linux, which do not tell the address
    space of a process.
    """
    if resource is None or not STATM.exists():
        return lambda more: None
    unix = resource
    used_bytes = int(STATM.read_text().split()[0]) * unix.getpagesize()
    _, hard = unix.getrlimit(unix.RLIMIT_AS)

    def limit(more: int | None) -> None:
        most = hard if more is None else used_bytes + more
        soft = most if hard == unix.RLIM_INFINITY else min(most, hard)
        unix.setrlimit(unix.RLIMIT_AS, (soft, hard))

    return limit


def _answer(
    connection: Connection,
    request: LoadRequest,
    resolver: Resolver,
    skip: dict[int, str],
    memory: int,
) -> bytes:
    """Return the result of a request, or an exception that says why there is none, serialised."""
    try:
        data = pickle.dumps(_load(connection, request, resolver, skip))
        if len(data) <= memory // RESULT_SHARE:
            return data
    except MemoryError:
        pass
    return pickle.dumps(MemoryError())


def _load(
    connection: Connection, request: LoadRequest, resolver: Resolver, skip: dict[int, str]
) -> Loaded | Exception:
    def progress(done: int, total: int, link: str) -> None:
        signal.alarm(round(2 * DEADLINE_S))  # in case the parent process is gone
        connection.send((done, total, link))

    try:
        if request.mesh or request.picture:
            progress(0, 1, "")
            return load_asset(request, resolver)
        if request.path:
            return load_file(_expanded(request.path), resolver, progress, request.collisions, skip)
        return load_robot(request.text, resolver, progress, request.collisions, skip)
    except RobotDescriptionError as error:
        return error
    except MemoryError:
        raise
    except Exception:
        return RuntimeError(traceback.format_exc())


def _expanded(path: str) -> Path:
    try:
        return Path(path).expanduser()
    except (RuntimeError, ValueError) as error:  # no such user, a null byte
        raise RobotDescriptionError(f"{path!r} is not a usable path: {error}.") from error

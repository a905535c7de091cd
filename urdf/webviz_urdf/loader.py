"""The process in which `webviz_urdf.loading` loads robots."""

from __future__ import annotations

import pickle
import resource
import signal
import sys
import traceback
from multiprocessing.connection import Connection
from pathlib import Path

import numpy as np
from PIL import Image

from webviz_urdf.load import load_asset, load_file, load_robot
from webviz_urdf.loading import DEADLINE_S, IDLE_S, RESULT_SHARE, Loaded, LoadRequest
from webviz_urdf.resolve import Resolver
from webviz_urdf.robot import RobotDescriptionError
from webviz_urdf.textures import MAX_PIXELS


def main() -> None:
    """Serve requests until the connection is closed or idle for long."""
    connection = Connection(int(sys.argv[1]))
    # If the machine runs out of memory first, the kernel ends this process.
    Path("/proc/self/oom_score_adj").write_text("1000")
    # For pictures in meshes; PIL refuses twice this number.
    Image.MAX_IMAGE_PIXELS = MAX_PIXELS // 2
    np.dot(
        np.eye(64), np.eye(64)
    )  # BLAS allocates memory of its own, without which it ends the process
    imports = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    while connection.poll(IDLE_S):
        resource.setrlimit(resource.RLIMIT_AS, (hard, hard))
        try:
            request, resolver, skip, memory = connection.recv()
        except EOFError:
            return
        limit = imports + len(request.data) + memory
        soft = limit if hard == resource.RLIM_INFINITY else min(limit, hard)
        resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
        connection.send_bytes(_answer(connection, request, resolver, skip, memory))
        signal.alarm(0)


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

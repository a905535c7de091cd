"""The program of the process in which `webviz_urdf.loading` loads robots."""

from __future__ import annotations

import resource
import signal
import sys
import traceback
from multiprocessing.connection import Connection
from pathlib import Path

from PIL import Image

from webviz_urdf.loading import DEADLINE_S, IDLE_S, MAX_MEMORY, LoadRequest
from webviz_urdf.resolve import Resolver
from webviz_urdf.robot import Robot, RobotDescriptionError
from webviz_urdf.textures import MAX_PIXELS


def main() -> None:
    """Load what is asked for until the other side goes, or is silent for long."""
    connection = Connection(int(sys.argv[1]))
    _limit()
    while connection.poll(IDLE_S):
        try:
            request, resolver, skip = connection.recv()
        except EOFError:
            return
        connection.send(_load(connection, request, resolver, skip))
        signal.alarm(0)


def _limit() -> None:
    _, most = resource.getrlimit(resource.RLIMIT_AS)
    soft = MAX_MEMORY if most == resource.RLIM_INFINITY else min(MAX_MEMORY, most)
    resource.setrlimit(resource.RLIMIT_AS, (soft, most))
    # If memory runs out before that, it is this process that goes.
    Path("/proc/self/oom_score_adj").write_text("1000")
    # Of pictures within meshes; PIL refuses what has twice as many.
    Image.MAX_IMAGE_PIXELS = MAX_PIXELS // 2


def _load(
    connection: Connection, request: LoadRequest, resolver: Resolver, skip: dict[int, str]
) -> Robot | Exception:
    def progress(done: int, total: int, link: str) -> None:
        signal.alarm(round(2 * DEADLINE_S))  # if nobody is left to end this process
        connection.send((done, total, link))

    try:
        return request.load(resolver, progress, skip)
    except RobotDescriptionError as error:
        return error
    except MemoryError:
        return RobotDescriptionError("The robot needs more memory than loading may take.")
    except Exception:
        return RuntimeError(traceback.format_exc())

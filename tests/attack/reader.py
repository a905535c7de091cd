"""The process that reads attacked files as the viewer does: names in, answers in JSON out."""

from __future__ import annotations

import json
import logging
import resource
import sys
import traceback
from collections.abc import Callable
from pathlib import Path

from webviz.api.declared import Topic
from webviz.api.errors import Error
from webviz.data.messages import MessageError
from webviz.files import opening
from webviz.sources import Subscription
from webviz.sources.bag.source import BagSource
from webviz_urdf import Resolver, load_robot
from webviz_urdf.robot import RobotDescriptionError
from webviz_urdf.textures import TextureError, open_image

MESH = (
    "<robot name='r'><link name='a'><visual><geometry><mesh filename='{}'/></geometry></visual>"
    "</link></robot>"
)
MAX_MEMORY = 3 << 30
"""Bytes of address space, half a gigabyte of which is taken by imports."""
MAX_STEPS = 1000
"""Of a bag that claims to be long."""


class _Refused(Exception):
    pass


def read(path: Path) -> None:
    """Read a file; raises what the viewer shows as a sentence."""
    match path.suffix:
        case ".yaml" | ".rviz":
            opening.text_of(opening.load(path), path.name)
        case ".mcap" | ".db3" | ".zst":
            try:
                _play(path)
            except MemoryError as error:
                raise AssertionError("a bag took all memory") from error
        case ".png":
            open_image(path).load()
        case ".urdf":
            load_robot(path.read_bytes().decode(errors="replace"), Resolver(roots=[]))
        case _:
            robot = load_robot(MESH.format(path), Resolver(roots=[path.parent]))
            if robot.missing:
                raise _Refused


def _play(path: Path) -> None:
    """Play a bag with all of its topics."""
    source = BagSource(path)
    try:
        wanted = {
            topic: Subscription(offer.publishers[0].type, Topic(topic))
            for topic, offer in source.offers().items()
            if offer.publishers
        }
        source.want(wanted)
        for _ in range(MAX_STEPS):
            source.play_step(source.end_ns)
            source.inbox.drain()
            if source.position_ns >= source.end_ns:
                break
    finally:
        source.close()


def serve(read: Callable[[Path], object]) -> None:
    """Read files until there are no more names.

    Args:
        read: reads one; raises what the viewer shows as a sentence.
    """
    logging.disable()
    resource.setrlimit(resource.RLIMIT_AS, (MAX_MEMORY, MAX_MEMORY))
    for line in sys.stdin:
        broken, is_refused = "", False
        try:
            read(Path(line.rstrip("\n")))
        except (Error, MessageError, RobotDescriptionError, TextureError, _Refused) as error:
            is_refused = True
            broken = f"several lines: {error}" if "\n" in str(error) else ""
        except MemoryError:
            is_refused = True
        except Exception:
            broken = traceback.format_exc()
        print(json.dumps({"refused": is_refused, "broken": broken}), flush=True)


if __name__ == "__main__":
    serve(read)

"""Reading and writing of a connection to a bridge, until it breaks."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Coroutine
from typing import Any

from webviz.sources.bridge.connection import BridgeConnection
from webviz.sources.bridge.session import BridgeSession, WireError


async def first_of(*work: Coroutine[Any, Any, None]) -> None:
    """Do all until the first ends, and end the others; raises its error."""
    tasks = [asyncio.ensure_future(each) for each in work]
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        outcomes = await asyncio.gather(*tasks, return_exceptions=True)
    for outcome in outcomes:
        if isinstance(outcome, Exception):
            raise outcome


async def read(
    socket: BridgeConnection, session: BridgeSession, malformed: Callable[[str], object]
) -> None:
    """Pass frames to a session, and report those that are not of the protocol."""
    while True:
        frame = await socket.recv()
        try:
            session.receive(frame)
        except WireError as error:
            malformed(str(error))


async def write(socket: BridgeConnection, outbox: asyncio.Queue[str | bytes]) -> None:
    """Send what is in the outbox."""
    while True:
        await socket.send(await outbox.get())

"""Many clients, in a process of their own, so that they do not disturb the one that is measured."""

from __future__ import annotations

import multiprocessing
import time
from collections.abc import Sequence
from multiprocessing.connection import Connection
from pathlib import Path

from side_by_side.log import Sighting
from side_by_side.scenes import SCENES

MAX_SHARP = 30
"""Clients that recognise publications; more only count, as that would take most of the machine."""
PATIENCE_S = 60.0


class CaseFailed(Exception):
    """A system did not do its part; the text says what."""


class Audience:
    """Clients that read, besides those of this process.

    Args:
        system: its name.
        scene: its name.
        port: of the system.
        folder: of the run.
        count: of the clients.
    """

    def __init__(self, system: str, scene: str, port: int, folder: Path, count: int) -> None:
        self._count = count
        if not count:
            return
        context = multiprocessing.get_context("spawn")
        self._pipe, theirs = context.Pipe()
        arguments = (theirs, system, scene, port, folder, count)
        self._process = context.Process(target=_attend, args=arguments, daemon=True)
        self._process.start()
        self._hear()  # all are connected

    @property
    def pids(self) -> Sequence[int]:
        """Of its process."""
        pid = self._process.pid if self._count else None
        return () if pid is None else (pid,)

    def seen(self) -> list[list[Sighting]]:
        """Return the publications seen by each client that recognises them.

        Raises:
            CaseFailed: a client was disconnected.
        """
        if not self._count:
            return []
        self._pipe.send(None)
        seen, is_connected = self._hear()
        if not is_connected:
            raise CaseFailed("one of many clients was disconnected")
        return seen

    def close(self) -> None:
        """Everybody leaves."""
        if self._count:
            self._process.terminate()
            self._process.join()

    def _hear(self) -> tuple[list[list[Sighting]], bool]:
        if not self._pipe.poll(PATIENCE_S):
            raise CaseFailed(f"the many clients did not answer within {PATIENCE_S:g} s")
        return self._pipe.recv()


def _attend(
    pipe: Connection, system: str, scene_name: str, port: int, folder: Path, count: int
) -> None:
    from side_by_side.systems.registry import SYSTEMS

    scene = SCENES[scene_name]
    watchers = [
        SYSTEMS[system].watch(port, folder, scene if index < MAX_SHARP else None, False)
        for index in range(count)
    ]
    deadline = time.monotonic() + PATIENCE_S / 2
    while not all(watcher.bytes for watcher in watchers) and time.monotonic() < deadline:
        time.sleep(0.05)
    pipe.send(([], True))
    pipe.recv()
    is_connected = all(watcher.is_connected for watcher in watchers)
    pipe.send(([list(watcher.sightings) for watcher in watchers[:MAX_SHARP]], is_connected))
    pipe.recv()

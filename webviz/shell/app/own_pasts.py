"""Viewers in this process that show one page each a past of its own."""

from __future__ import annotations

import logging
import secrets
import threading
from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path
from typing import TYPE_CHECKING

from webviz import commands
from webviz.api.errors import Error
from webviz.data.working_folder import working_folder
from webviz.engine.loop import FrameLoop
from webviz.engine.parts.part import HostProgram
from webviz.engine.parts.time import REWOUND
from webviz.files.config import Config
from webviz.page.pages import Pages
from webviz.scene import ViserScene
from webviz.scene.server import open_behind
from webviz.sources.graph import ReadOnly
from webviz.sources.player import Player
from webviz.sources.recording.moment import MomentHistory

if TYPE_CHECKING:
    from webviz.server.http.viser_server import Door

log = logging.getLogger("webviz")

MAX_PASTS = 4
MAX_PAGES = 4
"""Largest number of pages of one: a page that is loaded again comes before the one before it has
gone."""
TOO_MANY = (
    f"{MAX_PASTS} pages already look back for themselves, which is the limit. Look back for "
    "everybody, or wait until one of them returns to live."
)
ENDED = "The viewer is closing."


class OwnPasts:
    """Opens such viewers behind the server of this one, and closes them.

    Each has a frame loop and an event loop of its own, publishes nothing and writes no files.

    Args:
        front: of the server.
    """

    def __init__(self, front: Door) -> None:
        self._front = front
        self._lock = threading.Lock()
        self._loops: dict[str, FrameLoop | None] = {}
        """Loops by name; None while it is being opened."""
        self._threads: list[threading.Thread] = []
        self._is_closed = False

    def open(self, config: Config, history: MomentHistory, at_ns: int, cookie: str) -> str:
        """Show a moment of a history to one page; may take a second.

        Args:
            config: what to show, and from where.
            history: what there is.
            at_ns: the moment.
            cookie: of the browser that may come, "" if none is asked for.

        Returns:
            The address of the page, relative to that of the viewer.

        Raises:
            Error: there are too many, or it cannot be opened.
        """
        name = secrets.token_urlsafe(16)
        with self._lock:
            if self._is_closed:
                raise Error(ENDED)
            if len(self._loops) >= MAX_PASTS:
                raise Error(TOO_MANY)
            self._loops[name] = None
        opened: Future[None] = Future()
        run = threading.Thread(
            target=self._run,
            args=(name, config, history, at_ns, cookie, opened),
            name="webviz-own-past",
            daemon=True,
        )
        with self._lock:
            self._threads = [each for each in self._threads if each.is_alive()]
            self._threads.append(run)
            run.start()
        opened.result()
        return f".{self._front.tunnels.address(name)}"

    def close(self) -> None:
        """Close all."""
        with self._lock:
            self._is_closed = True
            loops, threads = [*self._loops.values()], [*self._threads]
        for loop in filter(None, loops):
            loop.stop()
        for thread in threads:
            thread.join()

    def _run(
        self,
        name: str,
        config: Config,
        history: MomentHistory,
        at_ns: int,
        cookie: str,
        opened: Future[None],
    ) -> None:
        """Serve such a viewer until it ends."""
        try:
            with working_folder(".webviz_past_") as folder:
                self._serve(name, config, history.prepared(), at_ns, cookie, folder, opened)
        except Exception as error:
            if not opened.done():
                opened.set_exception(Error(f"Cannot look back on its own: {error}."))
            else:
                log.exception("A look back of one page failed")
        finally:
            with self._lock:
                del self._loops[name]

    def _serve(
        self,
        name: str,
        config: Config,
        history: MomentHistory,
        at_ns: int,
        cookie: str,
        folder: Path,
        opened: Future[None],
    ) -> None:
        path, tunnels = str(folder / "socket"), self._front.tunnels
        server = open_behind(self._front, path, MAX_PAGES)
        ended: list[Callable[[], None]] = [server.stop]
        try:
            scene = ViserScene(server)
            show: list[Callable[[], object]] = [lambda: None]
            player = Player(history, ReadOnly(REWOUND))
            loop = FrameLoop(
                config,
                player,
                scene,
                lambda: show[0](),
                may_publish=False,
                host=HostProgram(leave=lambda: loop.stop()),
            )
            ended.insert(0, loop.close)
            scene.link.deferred.wake = player.inbox.arrived.set
            pages = Pages(server.channel, loop.enqueue, server.door.access, parts=loop.parts)
            show[0] = pages.update
            with self._lock:
                if self._is_closed:
                    raise Error(ENDED)
                self._loops[name] = loop
            loop.enqueue(commands.Seek((at_ns - history.origin_ns) / 1e9))
            tunnels.add(name, path, cookie)
            ended.insert(0, lambda: tunnels.remove(name))
            opened.set_result(None)
            ended.remove(loop.close)  # `run` does it
            loop.run()
        finally:
            for end in ended:
                end()

"""A viewer with a live topic and its memory, and pages that join it."""

from __future__ import annotations

import http.client
import threading
import time
from typing import Any

from waiting import until

import webviz
from tests.displays.test_path import path
from tests.support.guest import Guest, Served
from webviz.api.roles import Role
from webviz.commands import Refresh
from webviz.data.messages import encode
from webviz.shell.testing.source import HandFedSource
from webviz.sources.player import Player
from webviz.sources.recording.memory import MemoryHistory

PATH = "nav_msgs/msg/Path"
CONFIG = {"fixed_frame": "map", "displays": [{"type": "Path", "topic": "/plan"}]}


class MemoryViewer:
    """A viewer whose live topic goes on, and those who join it.

    Args:
        options: of the viewer.
    """

    def __init__(self, **options: Any) -> None:
        self.source = HandFedSource()
        self.memory = MemoryHistory(self.source)
        self.viewer = webviz.Viewer(port=0, source=Player(self.memory), **options)
        self.viewer.config = CONFIG
        self.guests: list[Guest] = []
        self._ended = threading.Event()
        self._is_paused = False
        self._feeding = threading.Thread(target=self._feed)
        self._feeding.start()
        until(lambda: self.memory.recent.size()[0] > 1.5)
        self.viewer.do(Refresh())

    def _feed(self) -> None:
        x = 0.0
        while not self._ended.wait(0.05):
            if self._is_paused:
                continue
            x += 0.1
            self.source.now = time.time_ns()
            message = {"header": {"frame_id": "map"}, **path((0.0, 0.0, 0.0), (x, 1.0, 0.0))}
            self.source.put("/plan", PATH, encode(PATH, message))

    def pause(self) -> None:
        """Let the topic be silent."""
        self._is_paused = True

    def resume(self) -> None:
        """Let it go on."""
        self._is_paused = False

    def headers(self, role: Role) -> dict[str, str]:
        """Return the cookie of a role, if one is asked for."""
        token = next((t for t in self.viewer.access.tokens if t.role == role.label), None)
        return {"Cookie": f"webviz_{self.viewer.port}={token.cookie}"} if token else {}

    def enter(self, role: Role = Role.OWNER, below: str = "/") -> Guest:
        """Join a page as a browser does."""
        self.guests.append(Guest(Served(self.viewer.port), below, **self.headers(role)))
        return self.guests[-1]

    def look_back(self, guest: Guest) -> str:
        """Have a page look back on its own; the path of its page, or why there is none."""
        guest.send("CommandRequest", number=1, command="LookBackAlone", arguments={"at_s": 1.0})
        message = guest.receive("CommandResult")
        return message["result"].get("address", "").removeprefix(".") or message["text"]

    def status(self, path: str, role: Role = Role.OWNER, method: str = "GET") -> int:
        """Return the status of a request for a page; `body` is its answer."""
        connection = http.client.HTTPConnection("127.0.0.1", self.viewer.port, timeout=60)
        connection.request(method, path, headers=self.headers(role))
        response = connection.getresponse()
        self.body = response.read()
        connection.close()
        return response.status

    def close(self) -> None:
        """End the pages and the viewer."""
        for guest in self.guests:
            guest.close()
        self._ended.set()
        self._feeding.join()
        self.viewer.close()

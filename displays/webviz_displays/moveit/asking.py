"""Requests to the node move_group for the whole of a scene."""

from __future__ import annotations

from concurrent.futures import CancelledError, Future

import msgspec

from webviz import Context, Error
from webviz.api.connection import GraphConnection
from webviz.data.messages import decode
from webviz.data.words import joined
from webviz_displays.moveit.scene import KnownScene, updated

SERVICE = "moveit_msgs/srv/GetPlanningScene"
ANSWER_S = 5.0
"""Time in seconds for move_group to answer."""
PAUSE_S = 5.0
"""Pause in seconds between two requests."""
MAX_TRIES = 12
"""Then only messages are shown; many robots publish scenes without that service."""


class Asking(msgspec.Struct):
    """The answer of move_group, once it came.

    Args:
        service: its full name.
        scene: the answer, None before.
        problem: why there is none, a sentence.
    """

    service: str = ""
    scene: KnownScene | None = None
    problem: str = ""
    _answer: Future[bytes] | None = None
    _received: bytes | None = None
    _next_s: float = 0.0
    _tries: int = msgspec.field(default=0)

    def step(self, namespace: str, connection: GraphConnection, ctx: Context) -> None:
        """Ask, or take the answer."""
        service = "/".join(["", *filter(None, namespace.split("/")), "get_planning_scene"])
        if service != self.service:
            self.service, self.scene, self.problem = service, None, ""
            self._answer, self._received, self._next_s, self._tries = None, None, 0.0, 0
        if self.scene is not None:
            return
        if self._received is not None:
            self._read(self._received, ctx)
            return
        if self._answer is None and self._tries < MAX_TRIES and connection.clock_s >= self._next_s:
            self._tries += 1
            try:
                self._answer = connection.query(service, SERVICE, ANSWER_S)
            except ValueError as error:
                self.problem = joined(str(error), "Correct the namespace.")
                self._tries = MAX_TRIES
                return
        if self._answer is not None and self._answer.done():
            self._take(self._answer, connection.clock_s)
            connection.wake()

    def _take(self, answer: Future[bytes], clock_s: float) -> None:
        self._answer, self._next_s = None, clock_s + PAUSE_S
        try:
            self._received = answer.result()
        except (Error, CancelledError) as error:
            self.problem = str(error)

    def _read(self, received: bytes, ctx: Context) -> None:
        """Read the answer in a thread, as it may be large."""
        try:
            scene = ctx.background(("answer", self._tries), _scene_of, received)
        except Error as error:
            self.problem, self._received = str(error), None
            return
        if scene is not None:
            self.problem, self.scene, self._received = "", scene, None


def _scene_of(answer: bytes) -> KnownScene:
    return updated(KnownScene(), decode(f"{SERVICE}_Response", answer).scene)

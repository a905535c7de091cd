"""Functions of agents: to see, read and act, with texts and pictures as results."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future, InvalidStateError
from typing import Any

from webviz import commands
from webviz.api.errors import Error
from webviz.api.status import LOADING, Status
from webviz.commands import Refresh
from webviz.engine.commands import Command
from webviz.engine.state import Inspected
from webviz.files.config import nearest
from webviz.page.dispatcher import command_of
from webviz.server.access import rules
from webviz.shell.agents import texts
from webviz.shell.agents.caller import AgentCaller
from webviz.shell.app.picture_controls import ViewChoice
from webviz.shell.app.viewer import Viewer
from webviz.shell.pictures.browser import Pixels

ATTENTION_S = 60.0
"""Time in seconds after a call for which the viewer draws and examines without a browser."""
SETTLING_S = 3.0
"""Time in seconds after the start for which other nodes are still being discovered."""
LOADING_S = 20.0
MESSAGE_S = 3.0
"""Time for a message to arrive."""
REST_S = 0.1
MAX_PICTURES = 4
MAX_SIDE = 1920


class AgentTools:
    """A viewer as agents know it. Methods may be called from any thread.

    Args:
        viewer: that is running.
        note: adds a line about a caller to the journal.
    """

    def __init__(self, viewer: Viewer, note: Callable[[AgentCaller, str], object]) -> None:
        self._viewer = viewer
        self._note = note
        self._began_s = time.monotonic()

    def explain(self, caller: AgentCaller, display: str = "") -> str:
        """Return findings of the doctor and statuses.

        Args:
            caller: for the journal.
            display: name of the only display to tell about, "" for all.

        Raises:
            Error: there is no such display.
        """
        self._begin(caller, f"asked what is wrong{f' with {display}' if display else ''}")
        time.sleep(max(0.0, self._began_s + SETTLING_S - time.monotonic()))
        deadline = time.monotonic() + LOADING_S
        self._viewer.doctor()
        while self._is_loading() and time.monotonic() < deadline:
            time.sleep(REST_S)
            self._viewer.do(Refresh())
        rows = self._viewer.rows
        if display and display not in {each for row in rows for each in (row.name, row.id)}:
            hint = nearest(display, [row.name for row in rows])
            raise Error(f"There is no display `{display}`: {hint}")
        return texts.bounded(texts.explanation(self._viewer, display))

    def see(
        self, caller: AgentCaller, views: Sequence[ViewChoice], width: int, height: int
    ) -> list[Pixels]:
        """Pictures of the scene with the images beside it, uint8 (height, width, 3) each.

        Raises:
            Error: a view is unknown, there are too many, or no browser is installed.
        """
        if not 1 <= len(views) <= MAX_PICTURES:
            raise Error(f"Ask for 1 to {MAX_PICTURES} views at once, not {len(views)}.")
        self._check_size(width, height)
        self._begin(caller, f"took {len(views)} pictures")
        views_or_none = [view or None for view in views]
        return self._viewer.screenshots(views_or_none, size=(width, height))

    def select(
        self, caller: AgentCaller, x: int, y: int, view: ViewChoice, width: int, height: int
    ) -> str:
        """Values of what a picture of this view and size has at a pixel.

        Raises:
            Error: the view is unknown, or no browser is installed.
        """
        self._check_size(width, height)
        self._begin(caller, f"selected at ({x}, {y})")
        selection = self._viewer.select(x, y, size=(width, height), view=view or None)
        return texts.bounded(texts.selection(selection)) or "There is nothing to select there."

    def topics(self, caller: AgentCaller) -> str:
        """All topics."""
        self._begin(caller, "read the topics")
        self._viewer.do(Refresh())
        fact = self._viewer.fact
        return texts.bounded(texts.topics(fact("offers"), fact("traffic")))

    def read(self, caller: AgentCaller, topic: str) -> str:
        """Return the newest message of a topic, or why there is none."""
        self._begin(caller, f"read {topic}")
        self._viewer.do(commands.InspectTopic(topic))
        try:
            inspected = self._received(topic)
        finally:
            self._viewer.do(commands.InspectTopic(""))
        if inspected is None:
            raise Error(f"The viewer is reading other topics. Read {topic} again.")
        hint = "" if inspected.type else nearest(topic, list(self._viewer.topics)).capitalize()
        return texts.bounded((*texts.message(topic, inspected), *([hint] if hint else ())))

    def transform(self, caller: AgentCaller, target: str, source: str) -> str:
        """Return the newest pose of a frame in another.

        Raises:
            Error: there is none, and why.
        """
        self._begin(caller, f"looked up {source} in {target}")
        return self._viewer.do(commands.LookUpTransform(target, source))

    def act(self, caller: AgentCaller, command: str, fields: Mapping[str, Any]) -> str:
        """Give a command of pages, with the rights of the caller.

        Args:
            caller: whose role decides.
            command: its name.
            fields: its values.

        Returns:
            Its answer.

        Raises:
            Error: it is unknown, needs another role, or failed.
        """
        reply: Future[Status] = Future()

        def report(status: Status) -> None:
            with contextlib.suppress(InvalidStateError):  # a tool may report more than once
                reply.set_result(status)

        if command not in command_names():
            raise Error(f"Unknown command `{command}`: {nearest(command, sorted(command_names()))}")
        try:
            built = command_of(command, dict(fields), report=report)
        except ValueError as error:
            raise Error(str(error)) from None
        assert isinstance(built, Command), "known"
        if refusal := caller.refusal(type(built)):
            self._note(caller, f"was refused {command}")
            raise Error(refusal)
        self._begin(caller, f"{command} {dict(fields)}")
        answer = self._viewer.do(built, caller.sender())
        if command == "UseTool":
            with contextlib.suppress(TimeoutError):
                return reply.result(MESSAGE_S).text
        return answer or "Done."

    @staticmethod
    def _check_size(width: int, height: int) -> None:
        if max(width, height) > MAX_SIDE:
            raise Error(f"Pictures have at most {MAX_SIDE} pixels in each direction.")

    def _begin(self, caller: AgentCaller, text: str) -> None:
        """Note a call, and have the viewer draw."""
        self._note(caller, text)
        self._viewer.attend(ATTENTION_S)

    def _received(self, topic: str) -> Inspected | None:
        """Return the topic once it has a message, or as it is after some seconds."""
        deadline = time.monotonic() + MESSAGE_S
        while True:
            self._viewer.do(Refresh())
            inspected = self._viewer.fact("inspected", {}).get(topic)
            if (inspected and inspected.message is not None) or time.monotonic() > deadline:
                return inspected
            time.sleep(REST_S)

    def _is_loading(self) -> bool:
        return any(LOADING in row.statuses for row in self._viewer.rows)


def command_names() -> set[str]:
    """Return the names of the commands that agents may give, as far as their role allows."""
    return {each.__name__ for each in rules.commands() if issubclass(each, Command)}

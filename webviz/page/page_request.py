"""A command that a page has asked for, and the way back for its answers."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

from webviz.engine.commands import Sender
from webviz.engine.forms import brief
from webviz.server.channel.channel import Channel
from webviz.server.channel.messages import CommandRequest, CommandResult

MAX_ERROR = 1000
"""Characters of what is answered to a page that is refused: it may quote what the page sent."""


class PageRequest:
    """A `CommandRequest` of a browser. Its answers may come from any thread.

    Args:
        channel: to the pages.
        browser: that asks.
        request: what it sent.
        note: called once with the first answer other than a refusal, from any thread.
    """

    def __init__(
        self,
        channel: Channel,
        browser: int,
        request: CommandRequest,
        note: Callable[[str], object] | None = None,
    ) -> None:
        self.browser = browser
        self.sender = Sender(browser, request.step)
        self.number = request.number
        self._channel = channel
        self._name = request.command
        self._note = note
        self._is_noted = threading.Event()

    def answer(self, text: str = "", level: str = "ok", **result: Any) -> None:
        """Answer with a sentence or "", and with what was made; a command may go on after it."""
        if level == "error":
            text = brief(text, MAX_ERROR)
        self._channel.send(
            CommandResult(self.number, self._name, level, text, result), self.browser
        )
        if level != "error" and self._note is not None and not self._is_noted.is_set():
            self._is_noted.set()  # what comes later is how it goes on
            self._note(text)

    def refuse(self, reason: str) -> None:
        """Answer with the reason of the failure, a sentence."""
        self.answer(reason, "error")

    def refused_by(self, future: Future[Any]) -> bool:
        """Refuse it with the error of a future, if that has one; False if it has a result."""
        if future.cancelled():
            return True
        if error := future.exception():  # a sentence for people
            self.refuse(str(error))
        return error is not None

"""What came of commands."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.engine.commands import Command, Refresh
from webviz.engine.parts.part import Core, Handler, Part
from webviz.engine.requests import Requests


class AnswersPart(Part):
    """Tells panels the last answer.

    Args:
        core: what all parts share.
        requests: that are answered.
    """

    name = "Answers"

    def __init__(self, core: Core, requests: Requests) -> None:
        super().__init__(core)
        self._requests = requests

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """What does each of its commands: a new state follows every one, which is all of it."""
        return {Refresh: lambda command, sender: None}

    def state(self) -> Mapping[str, Any]:
        """The last answer."""
        return {"answer": self._requests.answer}

"""The answers to commands."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.engine.commands import Command, Refresh
from webviz.engine.parts.part import Core, Handler, Part
from webviz.engine.requests import Requests


class AnswersPart(Part):
    """Shows the last answer in panels.

    Args:
        core: shared by all parts.
        requests: has the answers.
    """

    name = "Answers"

    def __init__(self, core: Core, requests: Requests) -> None:
        super().__init__(core)
        self._requests = requests

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """The handler of each command; Refresh needs none, as every command updates the state."""
        return {Refresh: lambda command, sender: None}

    def state(self) -> Mapping[str, Any]:
        """The last answer."""
        return {"answer": self._requests.answer}

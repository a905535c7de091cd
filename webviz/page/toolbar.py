"""The toolbar of every page: shows the tools, and passes gestures on to the frame loop."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from typing import Any

import msgspec
from msgspec.structs import replace

from webviz.api.status import Level, Status
from webviz.engine.commands import Command, Sender, UseTool
from webviz.engine.state import State
from webviz.page.asked import Asked
from webviz.server.channel.channel import Channel
from webviz.server.channel.messages import Published, ShownTool, Tools


class Toolbar:
    """The tools on every page. Which one is active, only the page itself knows.

    Args:
        channel: to the pages.
        enqueue: takes commands, from any thread.
    """

    def __init__(
        self,
        channel: Channel,
        enqueue: Callable[[Command, Sender], Future[str]],
    ) -> None:
        self._channel = channel
        self._enqueue = enqueue
        self._shown: Tools | None = None

    def update(self, state: State) -> None:
        """Show the tools of a viewer; sends only what is new."""
        tools = Tools(
            tuple(msgspec.convert(each, ShownTool, from_attributes=True) for each in state.tools)
        )
        if tools != self._shown:
            self._shown = tools
            self._channel.send(tools)

    def use(self, asked: Asked, gesture: UseTool) -> None:
        """Pass a gesture on to the frame loop; the tool answers, maybe more than once."""

        def tell(status: Status) -> None:
            asked.answer(status.text, Level(status.level).name.lower())

        def published(topic: str, type: str, values: Mapping[str, Any]) -> None:
            encoded = msgspec.Raw(msgspec.json.encode(values, enc_hook=_plain))
            self._channel.send(Published(asked.number, topic, type, encoded), asked.browser)

        command = replace(gesture, report=tell, published=published)
        self._enqueue(command, asked.sender).add_done_callback(asked.refused_by)


def _plain(value: Any) -> Any:
    """Numbers and arrays of numpy, and for all else its text."""
    return value.tolist() if hasattr(value, "tolist") else str(value)

"""The toolbar of every page: shows the tools, and passes gestures on to the frame loop."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import msgspec
from msgspec.structs import replace

from webviz.api.status import Level, Status
from webviz.api.tool import Tool
from webviz.page.dispatcher import Dispatcher
from webviz.page.page_request import PageRequest
from webviz.server.channel.messages import Published, ShownTool, Tools

MAX_GESTURES = 20
"""Largest number of gestures of a browser within a second; people make one or two."""


class ToolButton(msgspec.Struct, frozen=True):
    """One tool in the toolbar.

    Args:
        id: for commands.
        name: as shown.
        tooltip: one sentence.
        shortcut: the key that selects it, "" for none.
        gesture: followed by the page, see `webviz.api.tool.Tool.gesture`.
        icon: of the page, "" for that of the gesture.
        surface: whether the gesture starts on a surface.
        stays: whether it remains active after a gesture.
        asks: whether pages ask before they send a gesture.
        refusal: why it cannot be used, a sentence; "" if it can.
        several: labels of the buttons that send several poses, () if it takes one.
        sends: full names of the topics, services and actions that it sends to.
        tool: read-only.
    """

    id: str
    name: str
    tooltip: str
    shortcut: str
    gesture: str
    icon: str = ""
    surface: bool = False
    stays: bool = False
    asks: bool = False
    refusal: str = ""
    several: tuple[str, ...] = ()
    sends: tuple[str, ...] = ()
    tool: Tool = msgspec.field(default_factory=Tool)


class Toolbar:
    """The tools on every page. Which one is active, only the page itself knows.

    Args:
        dispatcher: of what pages ask for.
    """

    def __init__(self, dispatcher: Dispatcher) -> None:
        self._dispatcher = dispatcher
        self._tools: Tools | None = None
        dispatcher.take("UseTool", self.use, lambda command: MAX_GESTURES)

    def show(self, buttons: Sequence[ToolButton]) -> None:
        """Show the tools of a viewer; sends only what is new."""
        tools = Tools(
            tuple(msgspec.convert(each, ShownTool, from_attributes=True) for each in buttons)
        )
        if tools != self._tools:
            self._tools = tools
            self._dispatcher.channel.send(tools)

    def use(self, page_request: PageRequest, gesture: Any) -> None:
        """Pass a gesture on to the frame loop; the tool answers, maybe more than once.

        Args:
            page_request: by a page.
            gesture: a `UseTool`.
        """
        dispatcher = self._dispatcher

        def tell(status: Status) -> None:
            page_request.answer(status.text, Level(status.level).name.lower())

        def published(topic: str, type: str, values: Mapping[str, Any]) -> None:
            encoded = msgspec.Raw(msgspec.json.encode(values, enc_hook=_plain))
            dispatcher.channel.send(
                Published(page_request.number, topic, type, encoded), page_request.browser
            )

        command = replace(gesture, report=tell, published=published)
        dispatcher.enqueue(command, page_request.sender).add_done_callback(page_request.refused_by)


def _plain(value: Any) -> Any:
    """Numbers and arrays of numpy, and for all else its text."""
    return value.tolist() if hasattr(value, "tolist") else str(value)

"""Dispatcher of the pages' commands: their limits, their journal, and who carries them out."""

from __future__ import annotations

import functools
import time
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from typing import Any

import msgspec

from webviz.engine import feature
from webviz.engine.commands import Command, PageCommand, Sender
from webviz.engine.forms import MAX_TEXT
from webviz.engine.parts.declaring import commands_of
from webviz.engine.parts.part import Part
from webviz.files.config import MAX_DEPTH, MAX_VALUES
from webviz.page.page_request import PageRequest
from webviz.server.access.access import Access
from webviz.server.access.journal import Journal
from webviz.server.access.rules import UNKNOWN, commands
from webviz.server.channel.channel import Channel
from webviz.server.channel.messages import CommandRequest, Download

NOT_OF_PAGES = frozenset({"browser", "made", "opened", "deliver", "report", "published"})
"""Fields that the server fills in: a page acts for itself and gets what it made with the answer."""

LARGE = frozenset({"text", "picture"})
"""Fields that have checks of their own; a message is bounded as a whole."""

Handler = Callable[[PageRequest, Any], object]
"""Carries out a command that a page has asked for, on the event loop."""


class PageFeature(feature.Feature):
    """A feature that takes messages of pages which do not simply wait for the frame loop."""

    def attach(self, dispatcher: Dispatcher) -> None:
        """Take them; called once, if there are pages."""


class Dispatcher:
    """Does what pages ask for.

    Args:
        channel: to the pages.
        enqueue: takes commands, from any thread.
        parts: of the viewer; those with a `PageCommand` carry it out.
        access: knows the tokens.
        journal: of what browsers did that owners may want to know.
        clock: monotonic time in seconds.
    """

    def __init__(
        self,
        channel: Channel,
        enqueue: Callable[[Command, Sender], Future[str]],
        parts: Sequence[Part],
        access: Access,
        journal: Journal,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.channel = channel
        self.enqueue = enqueue
        self.access = access
        self.journal = journal
        self._handlers = {
            name: _handler(getattr(part, each.method))
            for part in parts
            for name, each in commands_of(type(part)).items()
            if issubclass(each.type, PageCommand)
        }
        self._most: dict[str, Callable[[Any], int]] = {}
        self._clock = clock
        self._recent: dict[tuple[int, str], deque[float]] = {}
        """Times when each browser sent its last commands that are limited."""
        channel.on(CommandRequest, self._run)

    def take(
        self,
        command: str,
        handler: Handler,
        most: Callable[[Any], int] | None = None,
    ) -> None:
        """Have a command carried out that does not simply wait for the frame loop.

        Args:
            command: its name.
            handler: carries it out.
            most: how many such commands a browser may send within a second, 0 for no limit.
        """
        self._handlers[command] = handler
        if most is not None:
            self._most[command] = most

    def note(self, browser: int, text: str) -> None:
        """Note what a browser did, from any thread."""
        self.journal.note(self.channel.visitors().get(browser), text)

    def _run(self, browser: int, request: CommandRequest) -> None:
        addresses: dict[str, str] = {}
        try:
            command = command_of(
                request.command,
                request.arguments,
                made=functools.partial(addresses.__setitem__, "display"),
                opened=functools.partial(addresses.__setitem__, "address"),
                deliver=functools.partial(self._deliver, browser, request),
            )
        except ValueError as error:
            PageRequest(self.channel, browser, request).refuse(str(error))
            return
        is_noted = feature.commands()[request.command].is_noted
        note = functools.partial(self.note, browser) if is_noted else None
        page_request = PageRequest(self.channel, browser, request, note)
        limit = self._most.get(request.command)
        if limit and (most := limit(command)) and self._is_flood(browser, request.command, most):
            page_request.refuse(
                f"Not sent: more than {most} gestures within a second. Wait a moment."
            )
        elif (handler := self._handlers.get(request.command)) is not None:
            handler(page_request, command)
        elif isinstance(command, Command):

            def tell(future: Future[str]) -> None:
                if not page_request.refused_by(future):
                    page_request.answer(future.result(), **addresses)

            self.enqueue(command, page_request.sender).add_done_callback(tell)

    def _deliver(self, browser: int, request: CommandRequest, text: str) -> None:
        self.channel.send(Download(request.arguments.get("name") or "webviz.yaml", text), browser)

    def _is_flood(self, browser: int, command: str, most: int) -> bool:
        """Return whether a browser is faster than people are; if not, counts this command."""
        now = self._clock()
        recent = {key: times for key, times in self._recent.items() if times[-1] > now - 1.0}
        times = recent.setdefault((browser, command), deque(maxlen=most))
        self._recent = recent
        is_flood = len(times) == most and times[0] > now - 1.0
        if not is_flood:
            times.append(now)
        return is_flood


def _handler(method: Callable[..., object]) -> Handler:
    """Return what calls a method with the fields of its command."""
    return lambda page_request, command: method(
        page_request=page_request, **msgspec.structs.asdict(command)
    )


def command_of(name: str, arguments: dict[str, Any], **own: Any) -> object:
    """Return the command that a page asks for.

    Args:
        name: of its class.
        arguments: fields, as JSON has them.
        own: fields that the server fills in, for commands that have them.

    Raises:
        ValueError: there is no such command for pages, or no such fields, or they are too large;
            with a sentence.
    """
    class_, form = _forms().get(name, (None, None))
    if class_ is None:
        raise ValueError(UNKNOWN)
    try:
        values = msgspec.structs.asdict(msgspec.convert(arguments, form))
    except (msgspec.ValidationError, RecursionError) as error:
        raise ValueError(f"Failed: {error}.") from error
    _refuse_endless({key: value for key, value in arguments.items() if key not in LARGE})
    return class_(**values, **{key: own[key] for key in own if key in class_.__struct_fields__})


def _refuse_endless(arguments: dict[str, Any]) -> None:
    """Refuse what no config file may have; the text of a whole one is checked when it is read."""
    level: list[Any] = [arguments]
    count = characters = depth = 0
    while level:
        if depth > MAX_DEPTH:
            raise ValueError(f"Failed: expected at most {MAX_DEPTH} nested levels.")
        below: list[Any] = []
        for value in level:
            if isinstance(value, str):
                characters += len(value)
                continue
            if isinstance(value, dict):
                value = [*value, *value.values()]
            if isinstance(value, list):
                count += len(value)
                if count > MAX_VALUES:
                    raise ValueError(f"Failed: expected at most {MAX_VALUES} values.")
                below += value
        if characters > MAX_TEXT:
            raise ValueError(f"Failed: expected at most {MAX_TEXT} characters.")
        level, depth = below, depth + 1


def form_of(name: str) -> type[msgspec.Struct]:
    """Return the struct of the fields that a page may fill in, by the name of the command."""
    return _forms()[name][1]


@functools.cache
def _forms() -> dict[str, tuple[type[Any], Any]]:
    """Return the commands of pages by name, each with a struct of what a page may fill in."""
    return {class_.__name__: (class_, _form(class_)) for class_ in commands()}


def _form(class_: type[Any]) -> Any:
    fields: list[Any] = []
    for each in msgspec.structs.fields(class_):
        if each.name in NOT_OF_PAGES:
            continue
        own = {"default": each.default, "default_factory": each.default_factory}
        fields.append((each.name, each.type, msgspec.field(**own)))
    return msgspec.defstruct(class_.__name__, fields, forbid_unknown_fields=True, kw_only=True)

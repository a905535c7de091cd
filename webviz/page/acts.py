"""Dispatcher of the pages' commands, each answered in the page that sent it."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, get_type_hints

import msgspec

from webviz.engine.commands import Command, Load, Open, Save, Sender
from webviz.files.config import MAX_DEPTH, MAX_VALUES
from webviz.page.content.forms import MAX_TEXT, brief
from webviz.server.access.rules import COMMANDS, UNKNOWN
from webviz.server.channel.channel import Channel
from webviz.server.channel.messages import Do, Done, Download

NOT_OF_PAGES = frozenset({"browser", "made", "deliver"})
"""Fields that the server fills in: a page acts for itself and gets what it made with the answer."""

NOTED = (Load, Open, Save)
"""Commands noted for the owner."""

MAX_ERROR = 1000
"""Characters of what is answered to a page that is refused: it may quote what the page sent."""


class Acts:
    """Does what pages ask for.

    Args:
        channel: to the pages.
        enqueue: takes commands, from any thread.
        note: is told what browsers did with files, from any thread.
    """

    def __init__(
        self,
        channel: Channel,
        enqueue: Callable[[Command, Sender], Future[str]],
        note: Callable[[int, str], None],
    ) -> None:
        self._channel = channel
        self._enqueue = enqueue
        self._note = note
        channel.on(Do, self._do)

    def _do(self, browser: int, do: Do) -> None:
        made: list[str] = []
        deliver = functools.partial(self._deliver, browser, do)
        try:
            command = command_of(do.command, do.arguments, made=made.append, deliver=deliver)
        except ValueError as error:
            self._channel.send(Done(do.number, "error", brief(str(error), MAX_ERROR), ""), browser)
            return

        def tell(done: Future[str]) -> None:
            if done.cancelled():
                return
            if error := done.exception():  # a sentence for people
                level, text = "error", brief(str(error), MAX_ERROR)
            else:
                level, text = "ok", done.result()
            self._channel.send(Done(do.number, level, text, "".join(made)), browser)
            if level == "ok" and isinstance(command, NOTED):
                self._note(browser, text)

        self._enqueue(command, Sender(browser, do.step)).add_done_callback(tell)

    def _deliver(self, browser: int, do: Do, text: str) -> None:
        self._channel.send(Download(do.arguments.get("name") or "webviz.yaml", text), browser)


def command_of(name: str, arguments: dict[str, Any], **own: Any) -> Command:
    """The command that a page asks for.

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
        raise ValueError(f"Not done: {error}.") from error
    _refuse_endless({key: value for key, value in arguments.items() if key != "text"})
    names = {field.name for field in dataclasses.fields(class_)}
    return class_(**values, **{key: value for key, value in own.items() if key in names})


def _refuse_endless(arguments: dict[str, Any]) -> None:
    """Refuse what no config file may have; the text of a whole one is checked when it is read."""
    level: list[Any] = [arguments]
    count = characters = depth = 0
    while level:
        if depth > MAX_DEPTH:
            raise ValueError(f"Not done: expected at most {MAX_DEPTH} nested levels.")
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
                    raise ValueError(f"Not done: expected at most {MAX_VALUES} values.")
                below += value
        if characters > MAX_TEXT:
            raise ValueError(f"Not done: expected at most {MAX_TEXT} characters.")
        level, depth = below, depth + 1


def form_of(name: str) -> type[msgspec.Struct]:
    """The struct of the fields that a page may fill in, of a command of pages by its name."""
    return _forms()[name][1]


@functools.cache
def _forms() -> dict[str, tuple[type[Any], Any]]:
    """By name the commands of pages, each with a struct of the fields that a page may fill in."""
    return {class_.__name__: (class_, _form(class_)) for class_ in COMMANDS}


def _form(class_: type[Any]) -> Any:
    hints = get_type_hints(class_, include_extras=True)
    fields: list[Any] = []
    for field in dataclasses.fields(class_):
        if field.name in NOT_OF_PAGES:
            continue
        kind = hints[field.name]
        if field.default is not dataclasses.MISSING:
            fields.append((field.name, kind, field.default))
        elif field.default_factory is not dataclasses.MISSING:
            factory = msgspec.field(default_factory=field.default_factory)
            fields.append((field.name, kind, factory))
        else:
            fields.append((field.name, kind))
    return msgspec.defstruct(class_.__name__, fields, forbid_unknown_fields=True, kw_only=True)

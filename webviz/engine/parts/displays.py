"""The displays, and the commands that change their list."""

from __future__ import annotations

import base64
import contextlib
import functools
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future
from importlib import resources
from typing import Any, ClassVar

import msgspec

from webviz.api.declared import make
from webviz.api.display import Display, inputs_of
from webviz.api.ports import ANY
from webviz.api.registry import display_types, plugin_type
from webviz.api.roles import Role
from webviz.api.status import LOADING, Level, Status
from webviz.engine.commands import ignore
from webviz.engine.parts.captions import (
    AttributionsStore,
    LegendStore,
    PanesStore,
    legend,
    panes,
)
from webviz.engine.parts.consistency import ConsistencyCheck
from webviz.engine.parts.declaring import command, store
from webviz.engine.parts.display_list import DisplayList
from webviz.engine.parts.display_properties import (
    PropertiesStore,
    RateStore,
    TopicOffersStore,
    properties,
    rate,
    topic_offers,
)
from webviz.engine.parts.display_rows import DisplaysStore, TreeRows, rows
from webviz.engine.parts.part import Batches, Part, PartContext
from webviz.engine.parts.status_lines import StatusesStore, causes, lines
from webviz.engine.parts.topics import TopicsPart
from webviz.engine.pipeline import DisplayServices, Runner
from webviz.engine.pipeline.runner import WORKING
from webviz.engine.pipeline.trace import Trace
from webviz.engine.state import Row, Traffic
from webviz.engine.store import PageStore
from webviz.files.config import ConfigError, mistakes, nearest, sentences
from webviz.sources import Advertisement, Subscription, merged


class DisplayType(msgspec.Struct, frozen=True):
    """A type of displays.

    Args:
        help: a line.
        topics: the message types that it shows.
        icon: see `webviz.Display.icon`.
        picture: an address that holds it, "" without one.
    """

    help: str
    topics: Sequence[str]
    icon: str
    picture: str


class TypesStore(PageStore, frozen=True):
    """The types of displays by name."""

    spread: ClassVar = {"types": ""}

    types: Mapping[str, DisplayType]


def types_store() -> TypesStore:
    """Return every type of displays, sorted by name."""
    return TypesStore({name: _about(name, cls) for name, cls in sorted(display_types().items())})


@functools.cache
def _about(name: str, cls: type[Display]) -> DisplayType:
    text = (cls.__doc__ or "").strip()
    type_names = [
        type_ for spec in inputs_of(cls).values() if not spec.follows for type_ in spec.types
    ]
    return DisplayType(
        help=" ".join(text.split("\n\n")[0].split()),
        topics=["any type" if type_ == ANY else type_ for type_ in dict.fromkeys(type_names)],
        icon=cls.icon,
        picture=_picture(name, cls.__module__.partition(".")[0]),
    )


def _picture(name: str, package: str) -> str:
    """Return the picture of a type in the folder `pictures` of its package."""
    with contextlib.suppress(ImportError, TypeError, ValueError, OSError):  # of a single file
        data = (resources.files(package) / "pictures" / f"{name}.webp").read_bytes()
        return f"data:image/webp;base64,{base64.b64encode(data).decode()}"
    return ""


UNSEEN = Status(
    Level.IDLE,
    "Not received: no browser shows its pane. Expand the pane, or bring the browser to the front.",
)


class DisplaysPart(Part):
    """All displays.

    Args:
        context: shared by all parts.
        services: for the runners.
    """

    name = "Displays"

    def __init__(self, context: PartContext, services: DisplayServices) -> None:
        super().__init__(context)
        self.list = DisplayList(services)
        self.services = services
        self.tracer = services.tracer
        self.points = services.points
        self.consistency = ConsistencyCheck(context, self.list)
        self.rows: tuple[Row, ...] = ()
        """The list as of the last turn; the same objects for what has not changed."""
        self.tree = TreeRows()
        """The rows of the page's tree."""

    def state(self) -> Mapping[str, Any]:
        """Return the displays, and the statuses of the viewer."""
        return {"rows": self.rows, "statuses": self.context.statuses}

    def subscriptions(self) -> Mapping[str, Subscription]:
        """Return the displays' subscriptions. The first decides on type and QoS of a topic."""
        active = self.list.active()
        return merged(each.subscriptions() for each in active if not self._is_unseen(each))

    def advertisements(self) -> set[Advertisement]:
        """Return the publishers of the displays."""
        return {
            advertisement
            for runner in self.list.active()
            for advertisement in runner.advertisements()
        }

    def take(self, batches: Batches) -> None:
        """Pass messages to the displays."""
        for runner in self.list.active():
            runner.take(batches, self.context.frames, self.context.offers)

    def reset(self) -> None:
        """Forget all messages."""
        for runner in self.list.runners():
            self.context.boundary(self.name, runner.reset)

    def update(self) -> None:
        """Make the rows of the list."""
        statuses = self._statuses_of
        if self.context.player.is_seeking:
            statuses = self._statuses_before()
        else:
            self.context.boundary("Consistency check", self.consistency.update)
        self.rows = rows(self.list.entries, statuses, self.rows)

    def _statuses_before(self) -> Callable[[Runner], Mapping[str, Status]]:
        """Return the statuses of the last turn.

        During a seek, what displays lack may be read yet, and what they show is from before.
        """
        before = {row.id: row.statuses for row in self.rows if row.enabled}
        return lambda runner: before.get(runner.id, {LOADING: WORKING})

    def _statuses_of(self, runner: Runner) -> Mapping[str, Status]:
        context = self.context
        if self._is_unseen(runner):
            return {"Display": UNSEEN}
        dropped = context.player.inbox.dropped
        return runner.statuses(context.offers, context.frames, dropped, context.is_watched())

    def _is_unseen(self, runner: Runner) -> bool:
        """Return whether a display shows only a pane, and no page shows that."""
        scene, display = self.context.scene, runner.display
        if not (display.enabled and type(display).has_pane):
            return False
        return self.context.boundary.attempt("Scene", False, scene.is_unseen, runner.id)

    # Stores

    @store(of=lambda part: (part.rows, part.context.statuses))
    def displays(self, argument: str) -> DisplaysStore:
        """Return the tree of displays."""
        tree = self.tree(self.rows, causes(self.context.statuses))
        return DisplaysStore([row.id for row in self.rows], tree)

    @store(name="properties", of=lambda part: (part.rows, part.context.offers, part.traffic))
    def properties_of(self, display: str) -> PropertiesStore | None:
        """Return the properties of the display with this id; None if it is gone."""
        row = self._row(display)
        return properties(row, self.rows, self.context.offers, self.traffic) if row else None

    @store(of=lambda part: (part.rows, part.context.statuses), name="statuses")
    def statuses_of(self, display: str) -> StatusesStore | None:
        """Return the statuses of the display with this id; None if it is gone."""
        row = self._row(display)
        return lines(row.statuses, row.id, causes(self.context.statuses)) if row else None

    @store(name="rate", of=lambda part: (part.rows, part.context.offers, part.traffic))
    def rate_of(self, display: str) -> RateStore:
        """Return the rate of messages of the display with this id."""
        return rate(self._row(display), self.context.offers, self.traffic)

    @store(of=lambda part: (part.rows, part.context.offers, part.traffic))
    def topics_of(self, types: str) -> TopicOffersStore:
        """Return the live topics of message types; see `topic_offers`."""
        return topic_offers(types, self.rows, self.context.offers, self.traffic)

    @store(of=lambda part: part.rows, name="legend")
    def legend_of_all(self, argument: str) -> LegendStore:
        """Return the colour scales of displays."""
        return legend(self.rows)

    @store(of=lambda part: part.rows, name="panes")
    def panes_of_all(self, argument: str) -> PanesStore:
        """Return the captions of panes."""
        return panes(self.rows)

    @store(of=lambda part: part.rows)
    def attributions(self, argument: str) -> AttributionsStore:
        """Return each credit once, in the order of the displays."""
        credits = filter(None, (row.attribution for row in self.rows))
        return AttributionsStore(tuple(dict.fromkeys(credits)))

    @store(of=lambda part: ())
    def types(self, argument: str) -> TypesStore:
        """Return the types of displays."""
        return types_store()

    @property
    def traffic(self) -> Mapping[str, Traffic]:
        """Return the traffic by topic."""
        return self.context.get(TopicsPart).traffic

    def _row(self, id: str) -> Row | None:
        return next((row for row in self.rows if row.id == id), None)

    # Commands

    @command(Role.OPERATOR)
    def set_property(self, display: str, path: str, value: Any) -> None:
        """Change a property of a display; nested ones have a dotted path, such as `topic.name`."""
        self.list.set(display, path, value)

    @command(Role.OPERATOR)
    def add_display(
        self,
        type: str,
        values: dict[str, Any] = {},  # noqa: B006 - never changed
        group: str = "",
        made: Callable[[str], None] = ignore,
    ) -> None:
        """Add a display at the end of the list, or of a group.

        Args:
            type: name of the display type.
            values: its properties, as in a config file.
            group: id of the group; "" is the list itself.
            made: called by the frame loop with the id of the new display; must not block.
        """
        new = _new(type, values)
        (entry,) = self.list.add([new], self.list.group(group))
        made(entry.id)

    @command(Role.OPERATOR)
    def remove_display(self, display: str) -> None:
        """Remove a display, or a group with its contents."""
        self.list.remove(display)

    @command(Role.OPERATOR)
    def duplicate_display(self, display: str, made: Callable[[str], None] = ignore) -> None:
        """Add a copy of a display, or of a group with its contents, after it.

        Args:
            display: id of the display or group.
            made: called by the frame loop with the id of the copy; must not block.
        """
        if copied := self.list.duplicate(display):
            made(copied.id)

    @command(Role.OPERATOR)
    def move_display(self, display: str, group: str = "", before: str = "") -> None:
        """Move a display or a group in the list.

        Args:
            display: id of the display or group.
            group: id of the group; "" is the list itself.
            before: id of the entry of that group that follows it; "" is the end.
        """
        self.list.move(display, group, before)

    @command(Role.OPERATOR)
    def reset_display(self, display: str) -> None:
        """Give the properties of a display their defaults, but for its name, switch and topics."""
        self.list.reset(display)

    @command(None)
    def trace_display(self, display: str, answer: Future[Trace]) -> None:
        """Trace the next sample that a display draws.

        Args:
            display: id of the display.
            answer: gets the times; cancel it to stop waiting.
        """
        self.tracer.ask(display, answer)


def _new(type_name: str, values: dict[str, Any]) -> Display:
    cls = plugin_type(Display, type_name)
    if cls is None:
        hint = nearest(type_name, display_types())
        raise ConfigError(f"Unknown display type `{type_name}`: {hint}")
    try:
        return make(cls, values)
    except msgspec.ValidationError as error:
        problems = mistakes(cls, values, error)
        raise ConfigError(f"Not added: {sentences(problems)}") from error

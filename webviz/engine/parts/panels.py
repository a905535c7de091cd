"""The panels of plug-ins: their properties, what they read, and what they send."""

from __future__ import annotations

import functools
import inspect
import math
from collections import deque
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import replace
from typing import Any

import msgspec

from webviz.api.declared import Topic, make
from webviz.api.lookback import Lookback
from webviz.api.panel import Panel
from webviz.api.registry import plugin_types, type_name
from webviz.api.roles import Role
from webviz.api.status import Status
from webviz.data.messages import MessageError, decode, encode, interfaces
from webviz.engine.commands import ignore
from webviz.engine.parts.advertisements import advertisement_of, publish
from webviz.engine.parts.declaring import command
from webviz.engine.parts.part import Batches, Part, PartContext
from webviz.engine.parts.plugin_list import PluginList
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.state import PanelTab
from webviz.files.config import MAX_PLUGINS, ConfigError, mistakes, nearest, sentences
from webviz.sources import Advertisement, Raw, Subscriber, Subscription, merged
from webviz.sources.history import NeededMessages
from webviz.sources.player import Player

READING = frozenset(
    f"rcl_interfaces/srv/{name}"
    for name in ("DescribeParameters", "GetParameters", "GetParameterTypes", "ListParameters")
)
"""Types of services that change nothing, which need no right."""
MAX_HOOKS = 2000
"""Hooks of panels whose parameters are remembered; a class that is loaded again has others."""
MAX_MESSAGES = 20_000
"""Largest number of past messages; at 400 Hz, decoding these takes a third of a second, which the
frame loop waits for."""


def past_messages(player: Player, topic: str, type_: str, lookback: Lookback) -> Iterable[Raw]:
    """Return messages of the memory or the recording until the moment that is shown, oldest first.

    At most the newest `MAX_MESSAGES`.

    Args:
        player: of what is shown; it is not seeking.
        topic: full name.
        type_: of the messages; there are none of another type.
        lookback: which of them; of live topics only its count and seconds matter.
    """
    memory, count = player.memory, min(lookback.count or MAX_MESSAGES, MAX_MESSAGES)
    if not player.is_live:
        return _recorded(player, topic, type_, replace(lookback, count=count))
    channel = memory.recorded_channels.find(topic) if memory else None
    if memory is None or channel is None or channel.type != type_:
        return ()
    raws = memory.recent.last(lookback.seconds or math.inf).whole
    return deque((raw for name, raw in raws if name == topic), maxlen=count)


def _recorded(player: Player, topic: str, type_: str, lookback: Lookback) -> Iterator[Raw]:
    history, at_ns = player.history, player.reached_ns
    subscriptions = {topic: Subscription(type_, Topic(topic), lookbacks=(lookback,))}
    channels = [each for each in history.channels(subscriptions) if each.topic == topic]
    if not channels or at_ns < history.start_ns:
        return
    clock = history.time()
    clock.seek(at_ns)
    for recorded in NeededMessages(history, channels, subscriptions, at_ns).messages():
        received_ns = clock.at(recorded.stamp_ns)
        yield Raw(recorded.cdr, received_ns, recorded_ns=recorded.stamp_ns, types=recorded.types)


class PanelsPart(Part):
    """All panels of plug-ins. What is drawn of them is known to the pages alone.

    Args:
        context: shared by all parts.
        settings: has the layouts, which name panels.
    """

    name = "Panels"

    def __init__(self, context: PartContext, settings: SettingsPart) -> None:
        super().__init__(context)
        self._settings = settings
        self.list = PluginList(Panel)
        self._open: frozenset[str] = frozenset()
        self._subscribers: dict[str, Subscriber] = {}

    def subscriptions(self) -> Mapping[str, Subscription]:
        """Return the subscriptions of the open panels."""
        former, self._subscribers = self._subscribers, {}
        subscriptions_of_tabs = []
        for tab in self._attended():
            subscriber = self._subscribers[tab.tab] = former.get(tab.tab) or Subscriber()
            topics = self._topics(tab.panel, "subscriptions").items()
            subscriptions = {
                topic: Subscription(
                    type_, Topic(topic), lookbacks=(self._lookback(tab.panel, topic),)
                )
                for topic, type_ in topics
            }
            subscriptions_of_tabs.append(subscriber.subscribe(subscriptions))
        return merged(subscriptions_of_tabs)

    def take(self, batches: Batches) -> None:
        """Pass messages on to the open panels that read them."""
        if not self.context.player.is_seeking:
            for panel in self._panels():
                if _has(panel, "begun"):
                    self.context.boundary(f"The panel {panel.name}", self._fill, panel)
        for panel in self._panels():
            for topic, type_ in self._topics(panel, "subscriptions").items():
                offer = self.context.offers.get(topic)
                if topic in batches and (offer is None or offer.type in ("", type_)):
                    for raw in batches[topic]:
                        self.context.boundary(
                            f"The panel {panel.name}", _pass, panel, topic, type_, raw
                        )

    def _fill(self, panel: Panel) -> None:
        """Let a panel begin with what is remembered."""
        if not (begun := panel.begun()):
            return
        subscriptions = panel.subscriptions()
        for topic in begun:
            if type_ := subscriptions.get(topic):
                lookback = self._lookback(panel, topic)
                for raw in past_messages(self.context.player, topic, type_, lookback):
                    _pass(panel, topic, type_, raw, is_past=True)

    def reset(self) -> None:
        """Let the open panels start over."""
        for panel in self._panels():
            self.context.boundary(f"The panel {panel.name}", panel.start_over)
        for subscriber in self._subscribers.values():
            subscriber.ask()

    def advertisements(self) -> Collection[Advertisement]:
        """Return the publishers of the open panels."""
        topics = [
            (type_, Topic(topic))
            for panel in self._panels()
            for topic, type_ in self._topics(panel, "publications").items()
        ]
        return {
            advertisement
            for each in topics
            if (advertisement := advertisement_of(self.context, *each))
        }

    def target_frames(self) -> set[str]:
        """Return the frames that the open panels follow."""
        boundary = self.context.boundary
        frames = (
            boundary.attempt(f"The panel {panel.name}", frozenset[str](), panel.target_frames)
            for panel in self._panels()
            if _has(panel, "target_frames")
        )
        return set().union(*frames)

    def tabs(self) -> tuple[PanelTab, ...]:
        """Return the panels in their order."""
        return tuple(self._tabs())

    def state(self) -> Mapping[str, Any]:
        """Return the panels in their order."""
        return {"panels": self.tabs()}

    def show(self, panel: Panel) -> None:
        """Let a panel show the viewer: it gets what the parameters of its `show` name.

        Raises:
            TypeError: there is no such thing.
        """
        named = parameters_of(type(panel).show)
        values = {name: self.context.fact(name, default) for name, default in named.items()}
        unknown = [name for name, value in values.items() if value is inspect.Parameter.empty]
        if len(named) == len(unknown) == 1:  # as before webviz 0.3
            values = dict.fromkeys(unknown, self.context.state())
        elif unknown:
            names = ", ".join(unknown)
            raise TypeError(f"`show` asks for {names}, which this viewer does not have")
        panel.show(*values.values())

    def is_attended(self) -> bool:
        """Return whether a panel is open."""
        return bool(self._attended())

    def statuses(self) -> Mapping[str, Status]:
        """Return the statuses of unusable panels."""
        return self.list.statuses()

    def _lookback(self, panel: Panel, topic: str) -> Lookback:
        lookback = self.context.boundary(f"The panel {panel.name}", panel.lookback, topic)
        return lookback if isinstance(lookback, Lookback) else Lookback(count=1)

    def _attended(self) -> list[PanelTab]:
        """Return the panels that are open in a browser, and those that always read."""
        return [
            tab for tab in self._tabs() if tab.tab in self._open or type(tab.panel).always_reads
        ]

    def _panels(self) -> list[Panel]:
        return [tab.panel for tab in self._attended()]

    def _tabs(self) -> Iterator[PanelTab]:
        count: dict[str, int] = {}
        for id, panel in self.list.usable().items():
            name = type_name(type(panel))
            count[name] = count.get(name, 0) + 1
            yield PanelTab(id, name if count[name] == 1 else f"{name} {count[name]}", panel)

    def _topics(self, panel: Panel, hook: str) -> Mapping[str, str]:
        """Return the topics a panel names; empty if its hook fails."""
        return self.context.boundary.attempt(f"The panel {panel.name}", {}, getattr(panel, hook))

    @command(Role.OPERATOR)
    def add_panel(
        self,
        type: str,
        values: dict[str, Any] = {},  # noqa: B006 - never changed
    ) -> str:
        """Add a panel of a plug-in behind the others, where its class says (`Panel.opens`).

        Args:
            type: name of the panel type.
            values: its properties, as in a config file.
        """
        types = plugin_types(Panel)
        if (cls := types.get(type)) is None:
            hint = nearest(type, types)
            raise ConfigError(f"Unknown panel type `{type[:80]}`: {hint}")
        if len(self.list.items()) >= MAX_PLUGINS:
            raise ConfigError(f"There are {MAX_PLUGINS} panels. Remove one first.")
        try:
            panel = make(cls, values)
        except msgspec.ValidationError as error:
            problems = mistakes(cls, values, error, ())
            raise ConfigError(f"Not added: {sentences(problems)}") from error
        self.list.add(panel)
        if cls.opens == "below":
            name = next(tab.tab for tab in self._tabs() if tab.panel is panel)
            self._settings.set("layout", self._settings.settings.layout.with_panel_below(name))
        return f"Added {panel.name}."

    @command(Role.OPERATOR)
    def remove_panel(self, panel: str) -> str:
        """Remove a panel of a plug-in, by its id or name."""
        before = {tab.id: tab.tab for tab in self._tabs()}
        name = self.list.remove(panel)
        after = {tab.id: tab.tab for tab in self._tabs()}
        # The second of a type is the first now.
        names = {old: after.get(id, "") for id, old in before.items()}
        settings = self._settings.settings
        layouts = {key: each.renamed(names) for key, each in settings.layouts.items()}
        self._settings.set("layout", settings.layout.renamed(names))
        self._settings.set("layouts", layouts)
        return f"Removed {name}."

    @command(Role.OPERATOR)
    def set_panel_property(self, panel: str, path: str, value: Any) -> None:
        """Change a property of a panel of a plug-in; nested ones have a dotted path.

        Args:
            panel: its id or name.
            path: of the property.
            value: as in a config file.
        """
        self.list.set(panel, path, value)

    @command(None)
    def open_panels(self, panels: frozenset[str]) -> None:
        """Say which panels of plug-ins are open in any browser; the others rest.

        Args:
            panels: names of their tabs.
        """
        self._open = panels

    @command(None)
    def refresh(self) -> None:
        """Update panels at once, such as after another tab was selected: all commands do."""

    @command(None)
    def publish(
        self,
        topic: str,
        type: str,
        values: Mapping[str, Any],
        report: Callable[[Status], None] = ignore,
        latched: bool = False,
    ) -> None:
        """Publish a message.

        Args:
            topic: its name; remapped.
            type: such as "std_msgs/msg/String".
            values: of the message by field; missing fields have their defaults.
            report: called with the result from any thread; must not block.
            latched: whether subscriptions that come later get the message, too (transient local).
        """
        try:
            payload = encode(type, values)
        except MessageError as error:
            raise ConfigError(f"Not published: {error}") from error
        durability, depth = ("transient_local", 1) if latched else ("auto", 0)
        publish(
            self.context, type, Topic(topic, durability=durability, depth=depth), payload, report
        )

    @command(None)
    def call_service(
        self,
        service: str,
        type: str,
        request: Mapping[str, Any],
        definition: str = "",
        answered: Callable[[Any], object] = ignore,
        failed: Callable[[str], object] = ignore,
        timeout_s: float = 5.0,
    ) -> None:
        """Call a service.

        Args:
            service: its name; remapped like a topic.
            type: such as "std_srvs/srv/Trigger".
            request: values by field; missing fields have their defaults.
            definition: text of the .srv file, for types unknown to webviz.
            answered: called with the response from another thread; must not block.
            failed: called with a sentence in the same way if there is none.
            timeout_s: for service and response to appear.
        """
        try:
            name = self.context.player.resolve(service)
            parts = interfaces.service(type, definition)
            payload = encode(parts.request, request)
        except ValueError as error:  # the name, the type or a value
            raise ConfigError(f"Not called: {error}") from error
        graph = self.context.graph
        call = graph.query if type in READING else graph.call
        response = call(name, type, payload, timeout_s)
        response.add_done_callback(interfaces.taker(name, parts.response, answered, failed))


@functools.lru_cache(MAX_HOOKS)
def parameters_of(hook: Callable[..., object]) -> Mapping[str, Any]:
    """Return the names of what a hook of a class of panels asks for, with their defaults."""
    _, *own = inspect.signature(hook).parameters.values()
    variable = inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD
    return {each.name: each.default for each in own if each.kind not in variable}


def _has(panel: Panel, hook: str) -> bool:
    """Return whether a panel does something in a hook, which most do not."""
    return getattr(type(panel), hook) is not getattr(Panel, hook)


def _pass(panel: Panel, topic: str, type_: str, raw: Any, *, is_past: bool = False) -> None:
    try:
        message = decode(type_, raw.cdr, raw.types)
    except MessageError as error:
        panel.refuse(topic, str(error))
        return
    if receive := getattr(panel, "receive", None):  # as before webviz 0.3
        receive(topic, message, raw.received_ns)
        return
    extras = {"received_ns": raw.received_ns, "is_past": is_past}
    parameters = parameters_of(type(panel).take)
    panel.take(topic, message, **{name: extras[name] for name in extras if name in parameters})

"""The base class of the parts of a viewer, and what they share."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence, Set
from pathlib import Path
from typing import Any, ClassVar, TypeVar

import msgspec

from webviz.api.errors import Error
from webviz.api.frames import Frames
from webviz.api.rule import Verdict
from webviz.api.status import Status
from webviz.api.tool import Tool
from webviz.data.transforms import TransformBuffer
from webviz.engine.commands import Command, Sender
from webviz.engine.driving import VelocityControllers
from webviz.engine.error_boundary import ErrorBoundary
from webviz.engine.parts.declaring import DeclaredCommand, commands_of
from webviz.engine.parts.outputs import Outputs
from webviz.engine.parts.plugin_list import PluginList
from webviz.engine.pipeline.scene import Scene
from webviz.engine.requests import Job
from webviz.engine.state import State, snapshot
from webviz.files.config import Config
from webviz.sources import Advertisement, Offer, Raw, RestrictedGraph, Subscription
from webviz.sources.player import Player
from webviz.sources.recording.moment import MomentHistory

Batches = Mapping[str, Iterable[Raw]]
"""Messages by topic, oldest first."""

Handler = Callable[[Any, Sender], str | Job[Any] | None]
"""Carries out a command and returns its answer if it has one; of a `FileCommand`, its slow part.

It raises a `webviz.Error` with one sentence to refuse the command.
"""


P = TypeVar("P", bound="Part")


class MissingPart(Error, LookupError):
    """A viewer has no such part."""


class HostProgram(msgspec.Struct, frozen=True):
    """The program around a viewer, for its features.

    Args:
        offer: lets pages download a file, by its name and content; None without pages.
        plugins: files with plug-ins that were loaded.
        bag_folders: folders whose bags pages may open.
        look_back: shows a moment of a history to one page, by the cookie of its browser, and
            returns the address; None if this viewer cannot.
        leave: ends this viewer, which shows one page its own past; None for any other.
    """

    offer: Callable[[str, bytes], object] | None = None
    plugins: Sequence[Path] = ()
    bag_folders: Sequence[Path] = ()
    look_back: Callable[[Config, MomentHistory, int, str], str] | None = None
    leave: Callable[[], object] | None = None


NO_PROGRAM = HostProgram()
"""Program of a viewer without pages."""


class PartContext:
    """State and services that all parts of a viewer share. Only the frame loop changes it.

    Args:
        player: where messages come from.
        graph: that messages, requests and goals go to, as far as the rights allow.
        controllers: of the vehicles that tools drive; they do not wait for the loop.
        scene: where to draw.
        boundary: around all calls.
        clock: monotonic time in seconds.
        waiting: the same, which goes on while a recording is paused.
        host: what the program around it gives.
    """

    def __init__(
        self,
        player: Player,
        graph: RestrictedGraph,
        controllers: VelocityControllers,
        scene: Scene,
        boundary: ErrorBoundary,
        clock: Callable[[], float],
        waiting: Callable[[], float],
        host: HostProgram,
    ) -> None:
        self.player = player
        self.graph = graph
        self.controllers = controllers
        self.scene = scene
        self.boundary = boundary
        self.clock = clock
        self.waiting = waiting
        self.host = host
        self.tools = PluginList(Tool)
        """Tools of the config."""
        self.buffer = TransformBuffer()
        self.frames = Frames(self.buffer, "", 0)
        """The transforms at the time that is shown."""
        self.now_ns = 0
        """ROS time of the turn, also while paused; 0 while it is unknown."""
        self.outputs = Outputs()
        """Files that were written for people."""
        self.offers: Mapping[str, Offer] = {}
        """Publishers and QoS by topic."""
        self.parts: Sequence[Part] = ()
        """All parts, once they are there."""
        self._by_kind: dict[type[Part], Any] = {}
        """Plug-ins by kind, of the kinds that were asked for."""
        self._by_fact: dict[str, Part] = {}
        """Plug-ins by fact, of the facts that were asked for."""
        self.statuses: Mapping[str, Status] = {}
        """Statuses of the viewer as a whole, such as "Fixed Frame", as of the last turn."""
        self.verdicts: Sequence[Verdict] = ()
        """Last verdicts on the rules of the config."""

    def get(self, kind: type[P]) -> P:
        """Return the part of a class.

        Raises:
            MissingPart: this viewer has none.
        """
        part = self.find(kind)
        if part is None:
            raise MissingPart(f"This viewer has no {kind.name or kind.__name__}. Reinstall webviz.")
        return part

    def find(self, kind: type[P]) -> P | None:
        """Return the part of a class, None if this viewer has none."""
        instance: P | None = self._by_kind.get(kind)
        if instance is None:
            instance = next((part for part in self.parts if isinstance(part, kind)), None)
            if instance is not None:
                self._by_kind[kind] = instance
        return instance

    def fact(self, name: str, otherwise: Any) -> Any:
        """Return what a part lets others read by a name, see `Part.state`.

        Args:
            name: of the value.
            otherwise: what to return if no part has it.
        """
        owner = self._by_fact.get(name)
        if owner is None:
            owner = next((part for part in self.parts if name in self._state_of(part)), None)
            if owner is None:
                return otherwise
            self._by_fact[name] = owner
        return self._state_of(owner).get(name, otherwise)

    def state(self) -> State:
        """Return all of this for programs; what a part that fails has is as without it."""
        fields: dict[str, Any] = {}
        for part in self.parts:
            fields |= self._state_of(part)
        return snapshot(fields)

    def _state_of(self, part: Part) -> Mapping[str, Any]:
        own: Mapping[str, Any] = {}
        return self.boundary.attempt(part.name, own, part.state)

    def reset(self) -> None:
        """Have all parts discard received data."""
        for part in self.parts:
            self.boundary(part.name, part.reset)

    def is_watched(self) -> bool:
        """Return whether any browser is connected."""
        return self.boundary.attempt("Scene", True, self.scene.has_watchers)


class Part:
    """One responsibility of a viewer: its commands, and its stores for pages.

    The frame loop calls all methods, so none may block. Exceptions become a status named after the
    part. Stores are made only while a page watches them.

    Args:
        context: shared by all parts.
    """

    name: ClassVar[str] = ""
    """Shown when the part fails."""

    def __init__(self, context: PartContext) -> None:
        self.context = context

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """The handler of each command, besides those of the server."""
        return {
            each.type: self._handler(each)
            for each in commands_of(type(self)).values()
            if issubclass(each.type, Command)
        }

    def _handler(self, declared: DeclaredCommand) -> Handler:
        method = getattr(self, declared.method)

        def obey(command: Command, sender: Sender) -> Any:
            fields = msgspec.structs.asdict(command)
            return method(**fields, sender=sender) if declared.has_sender else method(**fields)

        return obey

    def subscriptions(self) -> Mapping[str, Subscription]:
        """Its subscriptions by topic."""
        return {}

    def advertisements(self) -> Collection[Advertisement]:
        """Return the publishers it needs, so that its first messages arrive."""
        return ()

    def after(self, command: Command, sender: Sender) -> None:
        """Note that some part has carried out a command."""

    def take(self, batches: Batches) -> None:
        """Take the messages since the last turn."""

    def reset(self) -> None:
        """Discard received data: time starts over."""

    def keep_up(self, commanded: bool) -> None:
        """Do periodic work, before a new state.

        Args:
            commanded: whether there was a command since the last call.
        """

    def watched(self, stores: Set[str]) -> None:
        """Note that pages have begun or ceased to watch some of its stores.

        Args:
            stores: the names of those that are watched, with what stands behind the colon.
        """

    def update(self) -> None:
        """Note what there is to show, before stores are made."""

    def review(self) -> None:
        """Look at what all parts have noted, and at their statuses."""

    def state(self) -> Mapping[str, Any]:
        """Return what programs, panels and other parts may read of it, by name.

        The names are those of fields of `webviz.State`, and always the same.
        """
        return {}

    def statuses(self) -> Mapping[str, Status]:
        """Its statuses of the viewer as a whole, by key."""
        return {}

    def is_attended(self) -> bool:
        """Return whether a page shows something of it that changes all the time.

        The others are updated twice a second then, instead of five times.
        """
        return False

    def close(self) -> None:
        """Clean up when the loop has ended."""


def overrides(part: Part, hook: str) -> bool:
    """Return whether a part overrides a hook; the others do nothing."""
    return getattr(type(part), hook) is not getattr(Part, hook)

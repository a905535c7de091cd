"""The graph that a viewer may use: everything it publishes, calls and sends passes here."""

from __future__ import annotations

import fnmatch
import functools
import re
from collections.abc import Callable, Collection, Mapping
from concurrent.futures import Future

import msgspec

from webviz.sources.graph import Advertisement, Goal, Graph, ReadOnly
from webviz.sources.source import Source

ALL = "webviz_all"
"""Stands for `*` while a pattern is resolved like a name."""
REMEDY = "Let the owner allow it for this session, or"
_OF_ACTION = "/_action/"
"""Separator between the name of an action and those of its services."""

AllowList = tuple[str, ...]
"""Names of topics, services and actions, in which `*` stands for any characters."""


class Rights(msgspec.Struct, frozen=True):
    """Rights to publish, call and send, as decided where the viewer was started.

    Args:
        may_publish: whether anything may be.
        publish: the list of the config with which the viewer was started; those of other configs
            narrow it.
        own: what its tools, displays and panels use, which is the list if the config has none,
            together with `addable`.
        also: allowed besides, whatever configs say.
        addable: returns what displays use that pages may add; asked when a name is on no other
            list, as it imports all of them.
    """

    may_publish: bool = True
    publish: AllowList | None = ("/*",)
    own: AllowList = ()
    also: AllowList = ()
    addable: Callable[[], AllowList] = tuple

    @property
    def names(self) -> AllowList:
        """The list that holds, without what is allowed besides."""
        if self.publish is not None:
            return self.publish
        return tuple(sorted({*self.own, *self.addable()}))


class RestrictedGraph:
    """The graph of a source, as far as the rights allow; see `webviz.sources.Graph`.

    Args:
        source: whose graph it is.
        rights: of the viewer.
        publish: the list of the current config, None if it has none.
        pause: why nothing may be sent for the moment, a sentence; "" if it may.
    """

    def __init__(
        self,
        source: Source,
        rights: Rights,
        publish: Callable[[], AllowList | None],
        pause: Callable[[], str] = str,
    ) -> None:
        self._source = source
        self._pause = pause
        self._rights = rights
        self._publish = publish
        self._session: frozenset[str] = frozenset()
        self._pattern = functools.lru_cache(maxsize=4)(self._compiled)
        self._refusal = functools.lru_cache(maxsize=1000)(self._judged)

    @property
    def rights(self) -> Rights:
        """Rights, as decided where the viewer was started."""
        return self._rights

    @property
    def session(self) -> frozenset[str]:
        """The full names that were allowed since the start; each is one name, never a pattern."""
        return self._session

    def allow(self, name: str) -> None:
        """Allow a name until `forbid` or the end of the viewer; from one thread only.

        Args:
            name: full, as it is compared.
        """
        self._session |= {name}

    def forbid(self, name: str) -> None:
        """Take back what was allowed since the start; from the thread of `allow`."""
        self._session -= {name}

    def is_open(self, name: str) -> bool:
        """Return whether `allow` would lift a refusal: only a list stands against the name."""
        is_live = not isinstance(self._source.graph, ReadOnly)
        return is_live and self._rights.may_publish and bool(self.lasting_refusal(name))

    def refusal(self, name: str) -> str:
        """Return why nothing may be sent to a topic, service or action: a sentence; "" if it may.

        Args:
            name: its full name, after remapping.
        """
        return self.lasting_refusal(name) or self._pause()

    def lasting_refusal(self, name: str) -> str:
        """Return why nothing may ever be sent to a name, as far as is known; "" if it may."""
        graph = self._source.graph
        if isinstance(graph, ReadOnly):
            return graph.reason
        is_allowed = self._rights.may_publish and name.partition(_OF_ACTION)[0] in self._session
        return "" if is_allowed else self._refusal(name, self._publish())

    def _judged(self, name: str, narrowed: AllowList | None) -> str:
        """Return the refusal of a name with the list of the current config."""
        if not self._rights.may_publish:
            return "This viewer was started with --no-publish. Restart it without this option."
        name = name.partition(_OF_ACTION)[0]
        if self._is_on(self._rights.also, name):
            return ""
        if not self._is_from_the_start(name):
            return self._not_from_the_start(name)
        if narrowed is not None and not self._is_on(narrowed, name):
            return f"{name} is not in the list `publish` of this config. Add it to the file."
        return ""

    def _is_from_the_start(self, name: str) -> bool:
        rights = self._rights
        if rights.publish is not None:
            return self._is_on(rights.publish, name)
        return self._is_on(rights.own, name) or self._is_on(rights.addable(), name)

    def _not_from_the_start(self, name: str) -> str:
        if self._rights.publish is None:
            return (
                f"No tool or panel of the config that webviz was started with uses {name}. "
                f"{REMEDY} restart with `--allow-publish {name}`."
            )
        return (
            f"{name} is not in the list `publish` of the config that webviz was started with. "
            f"{REMEDY} restart with `--allow-publish {name}`."
        )

    def advertise(
        self, advertisements: Collection[Advertisement], stopping: Collection[Advertisement] = ()
    ) -> Future[None]:
        """Make the advertised publishers these, without those that are refused.

        Args:
            advertisements: to advertise.
            stopping: which of them stay although they are refused, see `halt`.
        """
        allowed = {
            advertisement
            for advertisement in advertisements
            if advertisement in stopping or not self.lasting_refusal(advertisement.topic)
        }
        return self._source.graph.advertise(allowed)

    def publish(self, advertisement: Advertisement, cdr: bytes) -> Future[int]:
        """Publish a message; the number of matched subscriptions."""
        return self._graph(advertisement.topic).publish(advertisement, cdr)

    def halt(self, advertisement: Advertisement, cdr: bytes) -> Future[int]:
        """Publish a zero that stops what was driven, even if that is refused by now."""
        return self._source.graph.publish(advertisement, cdr)

    def call(self, service: str, type: str, request: bytes, timeout_s: float) -> Future[bytes]:
        """Call a service; the serialised response."""
        return self._graph(service).call(service, type, request, timeout_s)

    def query(self, service: str, type: str, request: bytes, timeout_s: float) -> Future[bytes]:
        """Call a service that changes nothing, whatever the rights; the serialised response."""
        return self._source.graph.call(service, type, request, timeout_s)

    def send_goal(
        self, action: str, type: str, goal: bytes, feedback: Callable[[bytes], object]
    ) -> Goal:
        """Send a goal to an action; it can be cancelled even if the list is narrowed later."""
        return self._graph(action).send_goal(action, type, goal, feedback)

    def nodes(self) -> tuple[str, ...]:
        """Full names of the nodes of the graph, sorted; one for each node of the name."""
        return self._source.graph.nodes()

    def services(self) -> Mapping[str, str]:
        """Types of the services of the graph by name, as far as they are known."""
        return self._source.graph.services()

    def _graph(self, name: str) -> Graph:
        """Return the graph for a name; one that refuses everything if nothing may be sent to it."""
        reason = self.refusal(name)
        return ReadOnly(reason) if reason else self._source.graph

    def _is_on(self, names: AllowList, name: str) -> bool:
        return self._pattern(names).fullmatch(name) is not None

    def _compiled(self, names: tuple[str, ...]) -> re.Pattern[str]:
        """Return a pattern for the full names on a list."""
        patterns = [fnmatch.translate(full) for name in names if (full := self._resolved(name))]
        return re.compile("|".join(patterns) or r"(?!)")

    def _resolved(self, name: str) -> str:
        """Return the full name or pattern, "" for an invalid one."""
        try:
            return self._source.resolve(name.replace("*", ALL)).replace(ALL, "*")
        except ValueError:
            return ""

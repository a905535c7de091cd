"""The ROS graph, as liveliness tokens state it."""

from __future__ import annotations

import threading
from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import NamedTuple, TypeVar

from webviz.api.offer import Endpoint, Publisher
from webviz.data.words import counted, joined
from webviz.sources.bridge.session import CarriedTopic
from webviz.sources.names import is_own
from webviz.sources.zenoh.attachment import gid_of
from webviz.sources.zenoh.faults import doubled, faults
from webviz.sources.zenoh.tokens import GraphEntity, LivelinessError, read_token, topics_of

E = TypeVar("E", Publisher, Endpoint)
MAX_ENTITIES = 20_000
"""Nodes and endpoints that are known at once; a fleet of fifty robots has about 10 000."""


class GraphSnapshot(NamedTuple):
    """The graph at one moment.

    Attributes:
        topics: by name, for `Source.offers`.
        publishers, readers: endpoints by topic.
        nodes: full names, sorted.
        servers: service servers by name, the first of each.
        actions: servers of actions behind zenoh-bridge-ros2dds, by name.
        transports: names of the implementations that are used.
        remarks: sentences on what is wrong.
    """

    topics: Mapping[str, CarriedTopic] = {}
    publishers: Mapping[str, Sequence[GraphEntity]] = {}
    readers: Mapping[str, Sequence[GraphEntity]] = {}
    nodes: tuple[str, ...] = ()
    servers: Mapping[str, GraphEntity] = {}
    actions: Mapping[str, GraphEntity] = {}
    transports: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()

    @property
    def is_empty(self) -> bool:
        """Return whether it has no node but this viewer."""
        return not self.transports

    @property
    def services(self) -> Mapping[str, str]:
        """Types of the services by name, without those that actions consist of."""
        return {n: each.type for n, each in self.servers.items() if "/_action/" not in n}


class DiscoveredGraph:
    """Takes tokens that come and go, in any thread."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._entities: dict[str, GraphEntity] = {}
        self._refused = 0
        self._refusal = ""
        self._left_out = 0
        self._is_changed = True

    def add(self, token: str) -> None:
        """Add the entity of a token."""
        try:
            entity = read_token(token)
        except LivelinessError as error:
            with self._lock:
                self._refused += 1
                self._refusal = str(error)
                self._is_changed = True
            return
        with self._lock:
            if entity is None or token in self._entities:
                return
            if len(self._entities) >= MAX_ENTITIES:
                self._left_out += 1
            else:
                self._entities[token] = entity
            self._is_changed = True

    def remove(self, token: str) -> None:
        """Remove the entity of a token."""
        with self._lock:
            if self._entities.pop(token, None) is not None:
                self._is_changed = True

    def clear(self) -> None:
        """Forget everything, for a new session."""
        with self._lock:
            self._entities.clear()
            self._refused = self._left_out = 0
            self._is_changed = True

    def snapshot(self) -> GraphSnapshot | None:
        """Return the graph, None if nothing has changed since the last call."""
        with self._lock:
            if not self._is_changed:
                return None
            self._is_changed = False
            entities = dict(self._entities)
            remarks = self._faults()
        return _snapshot(entities, remarks)

    def _faults(self) -> list[str]:
        texts: list[str] = []
        if self._refused:
            ignored = f"{counted(self._refused, 'liveliness token')} ignored"
            texts.append(
                joined(
                    f"{ignored}: {self._refusal}",
                    "Check for programs on this router that are not ROS nodes.",
                )
            )
        if self._left_out:
            most = f"The graph has more than {MAX_ENTITIES} nodes and endpoints"
            texts.append(joined(most, "The others are ignored."))
        return texts


def _snapshot(entities: Mapping[str, GraphEntity], remarks: Sequence[str]) -> GraphSnapshot:
    publishers = defaultdict[str, dict[str, GraphEntity]](dict)
    readers = defaultdict[str, dict[str, GraphEntity]](dict)
    nodes: list[str] = []
    servers: dict[str, GraphEntity] = {}
    actions: dict[str, GraphEntity] = {}
    for token, entity in entities.items():
        match entity.kind:
            case "node":
                nodes.append(entity.node)
            case "publisher":
                publishers[entity.name][token] = entity
            case "subscription":
                readers[entity.name][token] = entity
            case "server":
                servers.setdefault(entity.name, entity)
            case "action":
                actions.setdefault(entity.name, entity)
                for topic in topics_of(entity):
                    publishers[topic.name][token] = topic
            case "client" | "bridge":
                pass
    by_topic = {topic: tuple(each.values()) for topic, each in publishers.items()}
    read = {topic: tuple(each.values()) for topic, each in readers.items()}
    remarks = [*remarks, *faults(entities.values(), by_topic, read)]
    both, _ = doubled(by_topic)
    for topic in both:  # the direct way alone
        direct = {t: each for t, each in publishers[topic].items() if not each.is_bridged}
        publishers[topic], by_topic[topic] = direct, tuple(direct.values())
    uses = {e.is_bridged for e in entities.values() if not is_own(e.node)}
    names = {False: "rmw_zenoh", True: "zenoh-bridge-ros2dds"}
    topics = {
        topic: _carried(publishers.get(topic, {}), readers.get(topic, {})) for topic in publishers
    }
    return GraphSnapshot(
        topics,
        by_topic,
        read,
        tuple(sorted(nodes)),
        servers,
        actions,
        tuple(names[each] for each in sorted(uses)),
        tuple(remarks),
    )


def _carried(
    publishers: Mapping[str, GraphEntity], readers: Mapping[str, GraphEntity]
) -> CarriedTopic:
    offered = tuple(_endpoint(Publisher, *each) for each in publishers.items())
    return CarriedTopic(
        offered, readers=tuple(_endpoint(Endpoint, *each) for each in readers.items())
    )


def _endpoint(kind: type[E], token: str, entity: GraphEntity) -> E:
    qos = entity.qos
    return kind(
        entity.node,
        entity.type,
        qos.reliability,
        qos.durability,
        gid_of(token),
        qos.deadline_s,
        is_qos_known=not entity.is_bridged,
    )

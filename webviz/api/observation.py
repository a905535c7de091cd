"""Observations of the doctor: what its checks see of the machine, the graph and the viewer."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from webviz.api.bounds import Box
from webviz.api.bridge import Bridge
from webviz.api.browser import BrowserSeen
from webviz.api.consistency import MapFit
from webviz.api.declared import Topic
from webviz.api.display import Display
from webviz.api.environment import Environment
from webviz.api.finding import Finding, Symptom
from webviz.api.offer import Offer
from webviz.api.rule import Verdict
from webviz.api.status import Level, Status
from webviz.api.two_ends import TwoEnds
from webviz.api.views import Camera
from webviz.data.transforms import Diagnosis, TransformBuffer, diagnose
from webviz.data.transforms.conflicts import Conflict, ConflictKind
from webviz.data.transforms.reasons import Explanation, Kind, in_words

NO_OFFER = Offer(())
DISCOVERED_S = 4.0
"""Time after which DDS has found nodes that can be found; it announces them every 3 s."""
OF_TIME = tuple(
    kind
    for kind in Kind
    if kind not in (Kind.EMPTY_FRAME, Kind.LEADING_SLASH, Kind.LOOP, Kind.REFUSED)
)
"""Reasons that time may cause."""


@dataclass(frozen=True)
class InputSeen:
    """One input of a display.

    Args:
        path: of its topic among the properties of the display.
        topic: full name, "" if it has none.
        types: message types that the display reads, the preferred first.
        qos: as chosen by the user.
        latched: whether it always asks for transient local.
        status: key of the status of its topic.
        received: messages since the start.
        size: of the newest message in bytes.
        rate_hz: of the last messages, 0 if unknown.
        silent_s: seconds since the last message, or else since webviz began to listen.
        stamps: (stamp, time of reception) of the last messages with a header, in ns, oldest first.
        frame: frame id of the newest message, as it was sent.
        type: message type of `message`.
        message: the newest one that has a pose, None without one.
    """

    path: str
    topic: str
    types: tuple[str, ...]
    qos: Topic
    latched: bool
    status: str
    received: int
    rate_hz: float
    stamps: Sequence[tuple[int, int]]
    frame: str
    type: str
    message: Any
    size: int = 0
    silent_s: float = 0.0

    @property
    def silence(self) -> str:
        """Time without a message while webviz listened, in words."""
        return in_words(round(self.silent_s * 1e9))


@dataclass(frozen=True)
class DisplaySeen:
    """One enabled display.

    Args:
        id: for remedies and symptoms.
        type: name of its type.
        display: its properties, read-only.
        statuses: by key.
        inputs: its topics.
        fit: how well its laser scan fits the map, None if unknown.
        blocked: points of a laser scan on its path.
        find_box: finds `box`.
        wanted_points: that it would draw if browsers were fast enough.
        core: share of a processor that it takes, 0 unless the viewer is behind.
        order: its place among those that lie in one plane; later ones cover earlier ones.
    """

    id: str
    type: str
    display: Display
    statuses: Mapping[str, Status]
    inputs: Sequence[InputSeen] = ()
    fit: MapFit | None = None
    blocked: int = 0
    find_box: Callable[[], Box | None] = lambda: None
    wanted_points: int = 0
    core: float = 0.0
    order: int = 0

    @functools.cached_property
    def box(self) -> Box | None:
        """The box around all that it draws, in the fixed frame; None if it draws nothing."""
        return self.find_box()

    def problem(self, key: str) -> Status | None:
        """Return the status of a key if it is a warning or an error."""
        status = self.statuses.get(key)
        return status if status and status.level >= Level.WARN else None

    def symptom(self, key: str) -> tuple[Symptom, ...]:
        """Return the status of a key as a symptom, none if it is neither a warning nor an error."""
        return (Symptom(self.id, key),) if self.problem(key) else ()


@dataclass(frozen=True)
class ClockSeen:
    """Simulated time, as /clock has it.

    Args:
        time_ns: of the newest message, None without one.
        still_s: seconds since it changed, or else since webviz subscribed.
    """

    time_ns: int | None
    still_s: float


@dataclass(frozen=True, kw_only=True)
class Observation:
    """A robot and a viewer at one moment, as the checks of the doctor see them.

    Args:
        now_ns: ROS time, 0 while it is unknown.
        fixed_frame: id of the frame that everything is drawn in.
        buffer: all transforms.
        displays: that are enabled.
        statuses: of the viewer as a whole.
        offers: publishers and QoS by topic.
        nodes: full names, with duplicates.
        is_simulated: whether ROS time comes from /clock or a bag.
        clock_hz: messages per second on /clock.
        clock: newest time on /clock, None while nothing depends on it.
        joint_states: newest message of each topic of joint states, while transforms are missing.
        sim_time: whether nodes have use_sim_time, by name: those that publish topics or transforms
            that do not arrive, as far as they have answered.
        is_paused: whether a person has paused time.
        is_recorded: whether messages come from a bag.
        environment: of this machine, None with a bag or bridge, or until it is known.
        bridges: to bridges.
        findings: of the round before, without violated rules.
        numbers: in messages, by the message paths of rules: those since the round before.
        verdicts: of the rules of the config.
        ends: this machine and its peer, None unless they are compared.
        browsers: that are connected.
        cameras: of the browsers whose camera is known, in the fixed frame, by id.
        load: share of a processor that the frame loop takes while browsers are connected.
        listened_s: time for which the graph was looked at, in seconds.
    """

    now_ns: int
    fixed_frame: str
    buffer: TransformBuffer
    displays: Sequence[DisplaySeen]
    statuses: Mapping[str, Status] = field(default_factory=dict)
    offers: Mapping[str, Offer] = field(default_factory=dict)
    nodes: Sequence[str] = ()
    is_simulated: bool = False
    clock_hz: float = 0.0
    clock: ClockSeen | None = None
    joint_states: Mapping[str, Any] = field(default_factory=dict)
    sim_time: Mapping[str, bool] = field(default_factory=dict)
    is_paused: bool = False
    is_recorded: bool = False
    environment: Environment | None = None
    bridges: Sequence[Bridge] = ()
    findings: Sequence[Finding] = ()
    numbers: Mapping[str, Sequence[float]] = field(default_factory=dict)
    verdicts: Sequence[Verdict] = ()
    ends: TwoEnds | None = None
    browsers: Sequence[BrowserSeen] = ()
    cameras: Mapping[int, Camera] = field(default_factory=dict)
    load: float = 0.0
    listened_s: float = math.inf

    def inputs(self) -> Iterator[tuple[DisplaySeen, InputSeen]]:
        """All inputs that have a topic, each with its display."""
        for display in self.displays:
            for each in display.inputs:
                if each.topic:
                    yield display, each

    def starved(self) -> Iterator[tuple[DisplaySeen, InputSeen, Offer]]:
        """Yield the inputs whose topic has a warning or an error, each with its publishers."""
        for display, each in self.inputs():
            if display.problem(each.status):
                yield display, each, self.offers.get(each.topic, NO_OFFER)

    @property
    def zenoh_links(self) -> Sequence[Bridge]:
        """Return the links over Zenoh that are up."""
        return [each for each in self.bridges if each.is_up and each.protocol == "Zenoh"]

    def is_alone(self) -> bool:
        """Return whether webviz is the only node in sight, apart from hidden ones as of `ros2`.

        Not before the others had time to be found, nor with a connection to publishers whose nodes
        are unknown, as behind zenoh-bridge-ros2dds.
        """
        if self.listened_s < DISCOVERED_S:
            return False
        publishers = [p for offer in self.offers.values() for p in offer.publishers]
        if self.bridges and not all(publisher.node for publisher in publishers):
            return False
        visible = [node for node in self.nodes if not node.rpartition("/")[2].startswith("_")]
        return len(visible) == 1 and not self.is_recorded

    def stalled_nodes(self) -> Iterator[str]:
        """Yield the nodes of `stalled` topics and, if transforms are missing, those of /tf."""
        for _, _, offer in self.starved():
            yield from (publisher.node for publisher in offer.publishers if publisher.node)
        if any(self.unplaced(*OF_TIME)):
            for topic in ("/tf", "/tf_static"):
                yield from (p.node for p in self.offers.get(topic, NO_OFFER).publishers if p.node)

    def undiscovered(self) -> tuple[Symptom, ...]:
        """Return the statuses of topics that have no publisher, those of transforms included."""
        inputs = [(d, each) for d, each, offer in self.starved() if not offer.publishers]
        starved = [symptom for display, each in inputs for symptom in display.symptom(each.status)]
        if not any(self.offers.get(topic, NO_OFFER).publishers for topic in ("/tf", "/tf_static")):
            starved += [symptom for symptom, _ in self.unplaced(Kind.NO_TRANSFORMS)]
        return tuple(starved)

    def unreceived(self) -> tuple[Symptom, ...]:
        """Return the statuses of topics that have a publisher and no message."""
        inputs = [(d, each) for d, each, o in self.starved() if o.publishers and not each.received]
        return tuple(
            symptom for display, each in inputs for symptom in display.symptom(each.status)
        )

    def stalled(self) -> tuple[Symptom, ...]:
        """Return the statuses of a robot whose time does not run as it should.

        These are topics that have publishers and no messages, and frames that lack transforms for
        another reason than their names.
        """
        topics = [
            symptom
            for display, each, offer in self.starved()
            if offer.publishers
            and not offer.problem
            and display.statuses[each.status].remedy is None
            for symptom in display.symptom(each.status)
        ]
        frames = [symptom for symptom, reason in self.unplaced(*OF_TIME) if not reason.near]
        return (*self.symptom("Time"), *topics, *frames)

    def samples(self, *types: str) -> Iterator[tuple[DisplaySeen, InputSeen]]:
        """Yield the inputs with a message of one of these types."""
        for display, each in self.inputs():
            if each.type in types and each.message is not None:
                yield display, each

    def misfits(self) -> Iterator[tuple[DisplaySeen, MapFit]]:
        """Yield the laser scans that do not fit the map."""
        for display in self.displays:
            if display.fit is not None and not display.fit.fit.is_good:
                yield display, display.fit

    def off_map(self) -> tuple[Symptom, ...]:
        """Return the statuses of laser scans that do not fit the map."""
        return tuple(s for display, _ in self.misfits() for s in display.symptom("Map"))

    @functools.cached_property
    def _unplaced_by_kind(self) -> Mapping[Kind, Sequence[tuple[Symptom, Explanation]]]:
        owners = [(display.id, display.statuses) for display in self.displays]
        by_kind: dict[Kind, list[tuple[Symptom, Explanation]]] = {}
        for id, statuses in [("", self.statuses), *owners]:
            for key, status in statuses.items():
                if status.reason is not None and status.level >= Level.WARN:
                    symptom = Symptom(id, key)
                    by_kind.setdefault(status.reason.kind, []).append((symptom, status.reason))
        return by_kind

    def unplaced(self, *kinds: Kind) -> Iterator[tuple[Symptom, Explanation]]:
        """Yield the statuses of frames that have no pose for one of these reasons."""
        for kind in kinds:
            yield from self._unplaced_by_kind.get(kind, ())

    def outlived(self, display: DisplaySeen) -> tuple[Symptom, ...]:
        """Return the statuses of a display whose last data is older than the transforms by now."""
        return tuple(s for s, _ in self.unplaced(Kind.BEHIND) if s.display == display.id)

    def symptom(self, key: str) -> tuple[Symptom, ...]:
        """Return a warning or error of the viewer as a symptom, None for other statuses."""
        status = self.statuses.get(key)
        return (Symptom("", key),) if status and status.level >= Level.WARN else ()

    @functools.cached_property
    def tree(self) -> Diagnosis:
        """The tree of frames, with rates, ages and loops."""
        return diagnose(self.buffer, self.now_ns)

    def conflicts(self, kind: ConflictKind) -> Iterator[tuple[str, Conflict]]:
        """Yield the frames with this sign of two publishers."""
        for frame, conflict in self.buffer.conflicts.all():
            if conflict.kind is kind:
                yield frame, conflict

    def nodes_of(self, topic: str) -> str:
        """Return the nodes that publish a topic, for sentences; "" if none does."""
        publishers = self.offers.get(topic, NO_OFFER).publishers
        return ", ".join(dict.fromkeys(publisher.label for publisher in publishers))

"""Examinations of the ROS graph and of bags."""

from __future__ import annotations

import contextlib
import math
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Future
from dataclasses import replace
from typing import Any

import msgspec

from webviz.api.check_registry import known_checks
from webviz.api.declared import to_values
from webviz.api.display import Display
from webviz.api.environment import Environment
from webviz.api.finding import CauseLevel, Finding, ordered
from webviz.api.observation import Observation
from webviz.api.registry import type_name
from webviz.api.two_ends import TwoEnds
from webviz.checks.graph.stopped_publisher import StoppedPublisher
from webviz.commands import AddDisplay, SetFixedFrame
from webviz.data.transforms import TransformBuffer
from webviz.engine.loop import FrameLoop
from webviz.engine.parts.displays import DisplaysPart
from webviz.files.config import Config
from webviz.shell.app.bag_config import displays_of, fixed_frame_of
from webviz.shell.doctor.report import DoctorReport, report_of
from webviz.shell.doctor.rule_results import RuleResults
from webviz.shell.doctor.scene import NoScene
from webviz.sources import Offer, Source
from webviz.sources.names import is_own
from webviz.sources.player import Player
from webviz.sources.steps import steps_of

DISCOVERY_S = 4.3
"""Time for the graph, which is read every two seconds: the first reading may be half of it."""
DISCOVERY_SHARE = 0.5
"""Share of the time that is left, if there is less."""
REST_S = 0.05
SLICE_S = 0.1
"""Time for checks in one turn of a live examination, so that it ends in time."""
MORE_S = 6.0
"""Time beyond that for displays that load a robot or meshes, and for what is still to be confirmed,
as when it began lately or the machine is busy."""
GRACE_S = 0.2
"""Time for the last turn of a live examination."""
ROUNDS = 2
"""Rounds of all checks that a finding takes."""
MAP = "/map"
"""A robot that publishes it is to be seen in its frame, so that a missing localisation is found."""
FRAME_S = 1.5
"""Time in seconds after which the fixed frame is chosen by the transforms that have arrived."""
FIRST_S = 2.0
"""Time that a display needs for its first messages, so that none is added later than that."""
STEP_NS = 100_000_000
"""Recording time between two turns in a bag: as quick as the processor, and the same on any."""
LASTING_S = 3.0
"""Findings in a bag that are gone after less, before its end, are left out."""
OF_SILENCE = {StoppedPublisher.id}
"""Findings of what has not come yet, which the end of a bag does not show, such as that of a
slice."""

OF_MACHINE = {CauseLevel.MACHINE, CauseLevel.NETWORK, CauseLevel.MIDDLEWARE}
"""Levels of causes that can be told without a source of messages."""

Progress = Callable[[str, float], object]
"""Called with what is done and the share of it that is."""


class Examination:
    """Findings of a frame loop without a page.

    Args:
        config: the displays to examine.
        source: of messages.
        progress: called now and then.
        results: of rules, which take the place of those of the config; None for no rules.
        environment: this machine, as far as it was looked at.
        since_s: monotonic time since which the graph is looked at, None for now.
    """

    def __init__(
        self,
        config: Config,
        source: Source,
        progress: Progress,
        results: RuleResults | None = None,
        environment: Environment | None = None,
        since_s: float | None = None,
    ) -> None:
        # Its rules would save a recording in the working folder, its tools appear as publishers.
        settings = msgspec.structs.replace(config.settings, watch=())
        config = msgspec.structs.replace(config, settings=settings, tools=[])
        self._results = results
        self._rounds = 0
        self._began_s = time.monotonic()
        self._source = source
        self._progress = progress
        self._loop = FrameLoop(config, source, NoScene())
        self._loop.doctor.rules = results.rules if results else ()
        self._loop.doctor.environment = environment
        if since_s is not None:
            self._loop.doctor.listening_since_s = since_s
        self._findings: dict[tuple[str, str], Finding] = {}
        self._is_open = True
        self._offers: Mapping[str, Offer] = {}
        self._subjects = [subject for subject, _ in _added(config)]

    def watch(self, until_s: float, is_given: bool) -> DoctorReport:
        """Examine live topics, and end the threads.

        On a busy machine a turn may take seconds, for which nothing waits then.

        Args:
            until_s: monotonic time in seconds at which it ends.
            is_given: whether the config is given, so that neither displays nor a fixed frame are
                chosen by what arrives.
        """
        self._loop.doctor.slice_s = SLICE_S
        ended = Future[None]()

        def run() -> None:
            try:
                with contextlib.closing(self):
                    self._watch(until_s, is_given)
                ended.set_result(None)
            except BaseException as error:
                ended.set_exception(error)

        threading.Thread(target=run, name="webviz-examination", daemon=True).start()
        for extra_s in (GRACE_S, MORE_S + GRACE_S):
            with contextlib.suppress(TimeoutError):
                ended.result(max(0.0, until_s + extra_s - time.monotonic()))
            if not self._is_open:
                break
        doctor = self._loop.doctor
        report = self._report("live", doctor.findings)
        report.unfinished = (
            doctor.rounds < ROUNDS
            or not doctor.is_graph_found
            or (self._is_open and not report.findings)
        )
        return report

    def _watch(self, until_s: float, is_given: bool) -> None:
        began = time.monotonic()
        is_frame_given = is_given
        while (now := time.monotonic()) < until_s or (self._is_open and now < until_s + MORE_S):
            self._turn()
            self._is_open = self._loop.is_busy() or not self._loop.doctor.is_settled()
            passed = now - began
            self._progress("examining", min(1.0, passed / (until_s - began)))
            if not is_frame_given and passed > FRAME_S:
                is_frame_given = True
                self._choose_frame()
            if not is_given and now < until_s - FIRST_S:
                self._add_displays()
            self._source.inbox.arrived.wait(REST_S)
            self._source.inbox.arrived.clear()

    def play(self, bag: Player, name: str) -> DoctorReport:
        """Examine a bag from its beginning to its end."""
        self._loop.doctor.slice_s = math.inf
        length_ns = bag.history.end_ns - bag.history.start_ns
        self._turn()
        for at_ns in steps_of(bag, bag.history.start_ns, bag.history.end_ns, STEP_NS):
            while bag.reached_ns < at_ns:
                if not self._loop.is_busy():  # displays catch up first
                    bag.play_until(at_ns)
                self._turn()
            self._progress("playing", (at_ns - bag.history.start_ns) / max(1, length_ns))
        for _ in range(ROUNDS):  # a bag may be shorter than the time between two
            self._loop.doctor.hasten()
            self._turn()
        ending = {(each.id, each.subject) for each in self._loop.doctor.findings}
        lasting = [
            each
            for key, each in self._findings.items()
            if (key in ending and each.id not in OF_SILENCE)
            or each.last_ns - each.first_ns >= LASTING_S * 1e9
        ]
        return self._report(name, ordered(lasting))

    def close(self) -> None:
        """End all threads."""
        self._loop.close()

    def _report(self, source: str, findings: Sequence[Finding]) -> DoctorReport:
        loop = self._loop
        rows = loop.get(DisplaysPart).rows
        return report_of(source, rows, loop.statuses, findings, len(known_checks()))

    def _turn(self) -> None:
        self._loop.turn()
        self._loop.update()
        doctor = self._loop.doctor
        for each in doctor.findings:
            key = each.id, each.subject
            former = self._findings.get(key, each)
            self._findings[key] = replace(each, first_ns=former.first_ns or each.first_ns)
        if self._results and doctor.rounds != self._rounds:
            self._rounds = doctor.rounds
            playback = self._loop.fact("playback")
            at_s = time.monotonic() - self._began_s
            if playback is not None and playback.is_live is None:
                at_s = playback.position_s
            self._results.note(doctor.verdicts, at_s)

    def _add_displays(self) -> None:
        """Add displays of topics that are found later than most, as on a busy machine."""
        offers = self._source.offers()
        if offers is self._offers:
            return
        self._offers = offers
        for subject, command in _added(live_config(offers)):
            if subject not in self._subjects:
                self._subjects.append(subject)
                self._loop.enqueue(command)

    def _choose_frame(self) -> None:
        if MAP in self._source.offers():
            return
        buffer = self._loop.buffer
        links = {child: buffer.link(child) for child in buffer.publishers}
        if frame := fixed_frame_of([(link.parent, c) for c, link in links.items() if link]):
            self._loop.enqueue(SetFixedFrame(frame))


def examine_live(
    source: Source,
    config: Config | None,
    until_s: float,
    progress: Progress,
    results: RuleResults | None = None,
    environment: Environment | None = None,
) -> DoctorReport:
    """Examine the ROS graph.

    Args:
        source: of messages.
        config: the displays to examine; None for those that fit the published topics.
        until_s: monotonic time in seconds at which it ends.
        progress: called now and then.
        results: of rules, which take the verdicts.
        environment: this machine, as far as it was looked at.
    """
    began_s = time.monotonic()
    discovery_s = max(0.0, min(DISCOVERY_S, DISCOVERY_SHARE * (until_s - began_s)))
    while (passed_s := time.monotonic() - began_s) < discovery_s:
        progress("discovering", passed_s / discovery_s)
        time.sleep(REST_S)
    chosen_config = live_config(source.offers()) if config is None else config
    examination = Examination(chosen_config, source, progress, results, environment, began_s)
    return examination.watch(until_s, config is not None)


def examine_bag(
    bag: Player,
    config: Config,
    name: str,
    progress: Progress,
    results: RuleResults | None = None,
) -> DoctorReport:
    """Examine a bag from its beginning to its end.

    Args:
        bag: the bag.
        config: the displays to examine.
        name: of the bag, for the report.
        progress: called now and then.
        results: of rules, which take the verdicts.
    """
    examination = Examination(config, bag, progress, results)
    try:
        return examination.play(bag, name)
    finally:
        examination.close()


def examine_machine(environment: Environment, ends: TwoEnds | None = None) -> DoctorReport:
    """Examine this machine alone, such as when ROS does not start, or with its peer."""
    observation = Observation(
        now_ns=time.time_ns(),
        fixed_frame="",
        buffer=TransformBuffer(),
        displays=(),
        environment=environment,
        ends=ends,
    )
    levels = OF_MACHINE | {CauseLevel.TIME} if ends else OF_MACHINE
    checks = [check for check in known_checks() if CauseLevel.of(check.id) in levels]
    findings = [finding for check in checks for finding in check().find(observation)]
    source = f"live, with {ends.there.host}" if ends else "live"
    return report_of(source, (), {}, ordered(findings), len(checks))


def live_config(offers: Mapping[str, Offer]) -> Config:
    """Return displays for published topics, without those of panes, whose messages are large.

    What only tools of webviz publish is sent when a person uses them.
    """
    published = {
        topic: offer
        for topic, offer in offers.items()
        if not all(is_own(each.node) for each in offer.publishers)
    }
    config, _ = displays_of(published)
    config.displays = [each for each in config.displays if not getattr(each, "has_pane", False)]
    return config


def _added(config: Config) -> Iterator[tuple[Mapping[str, Any], AddDisplay]]:
    """Yield what each display shows, whatever others there are, and the command that adds it."""
    for each in config.displays:
        if isinstance(each, Display):
            command = AddDisplay(type_name(type(each)), values := to_values(each))
            subject = {"type": command.type} | values
            for key in ("name", "enabled"):
                subject.pop(key, None)
            yield subject, command

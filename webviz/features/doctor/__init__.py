"""The doctor: runs the checks in slices, once a second while a page shows it, and its panel."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Iterator, Mapping, Sequence, Set
from concurrent.futures import Future
from dataclasses import replace
from pathlib import Path
from typing import Any

from webviz.api.check import Check
from webviz.api.check_registry import known_checks
from webviz.api.environment import Environment
from webviz.api.finding import Finding, Severity, Symptom, ordered
from webviz.api.observation import DISCOVERED_S
from webviz.api.rule import Rule
from webviz.api.status import Level
from webviz.data.disk import DiskThreads
from webviz.engine.examiner import Examiner
from webviz.engine.feature import Feature, store
from webviz.engine.machine.environment import look_around, lost_so_far
from webviz.engine.parts.display_rows import problems
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.part import Batches, PartContext
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.parts.time import TimePart
from webviz.engine.pipeline.trace import Tracer
from webviz.features.doctor.clock import ClockWatch, SimTime
from webviz.features.doctor.findings import FindingsStore, findings_store
from webviz.features.doctor.observing import observe
from webviz.features.doctor.rules import RuleEvaluator, RuleNumbers
from webviz.sources import Subscription, merged
from webviz.sources.names import is_own
from webviz.sources.past_state import Event

SCHEDULER = Path("/proc/thread-self/schedstat")
BUSY = 0.5
"""Share of the time above which the displays are timed, too."""


class LoadMeter:
    """Measures between two calls in the thread of the frame loop.

    Args:
        tracer: times displays on request.
    """

    def __init__(self, tracer: Tracer) -> None:
        self._tracer = tracer
        self._before: tuple[float, float] | None = None
        self._busy: dict[str, float] = {}

    def measure(self) -> tuple[float, Mapping[str, float]]:
        """Return the shares since the last call: of the loop, and of each display if it is busy.

        Waiting for a processor that other programs have counts as well: it delays as much.
        """
        now, used = time.monotonic(), _wanted_s()
        before, self._before = self._before, (now, used)
        if before is None or now <= before[0]:
            return 0.0, {}
        passed = now - before[0]
        load = max(0.0, used - before[1]) / passed
        busy = dict(self._tracer.busy_s)
        cores = {
            display: (seconds - self._busy.get(display, 0.0)) / passed
            for display, seconds in busy.items()
            if seconds > self._busy.get(display, 0.0)
        }
        self._busy = busy
        self._tracer.time("load", load > BUSY)
        return load, cores


def _wanted_s() -> float:
    """Seconds for which this thread ran, or waited for a processor, since its start."""
    try:
        ran_ns, waited_ns, *_ = SCHEDULER.read_text().split()
        return (int(ran_ns) + int(waited_ns)) / 1e9
    except (OSError, ValueError):  # not on Linux
        return time.thread_time()


EVERY_S = 1.0
"""Interval between the beginnings of two rounds."""
ASKED_S = 10.0
LOOK_S = 10.0
"""Interval between two looks at this machine."""
SECOND_LOOK_S = 3.0
"""The same for the second one, which tells first what has changed since."""

MAX_EVENTS = 1000
"""Findings whose beginning is kept; after these, that of others is not noted."""

OF_RULES = "DATA012"
"""Id of the findings about rules, which rules about findings do not count."""

Key = tuple[str, str]
"""Id and subject, by which a finding is known again."""

_looks = DiskThreads(8)
"""Threads for looks at the machine, which may wait for its network: files have threads of their
own."""


class DoctorFeature(Examiner, Feature):
    """Examines the viewer in rounds, each of all checks on one observation.

    A finding counts once two rounds in a row have made it: what lasts shorter repairs itself.

    Args:
        context: shared by all parts.
    """

    module = "doctor.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._displays = displays = context.get(DisplaysPart)
        self._numbers = RuleNumbers(context)
        self._clock = ClockWatch(context)
        self._checks: Sequence[Check] = ()
        self._began = -EVERY_S, -EVERY_S
        self._round: Iterator[None] | None = None
        self._since: Mapping[Key, tuple[int, float | None]] = {}
        """ROS time when each was first seen, and the position in the recording."""
        self._asked_until_s = 0.0
        self._looking: Future[Environment] | None = None
        self._next_look_s = 0.0
        self._lost_before = lost_so_far()
        self._evaluator = RuleEvaluator()
        self._sim_time = SimTime(context.graph)
        self._load = LoadMeter(displays.tracer)
        self._is_confirmed = True
        """False if the last round found something above a note for the first time."""
        self._examined_problems: Sequence[Set[Symptom]] = ()
        """Warnings and errors when each of the last two rounds began."""
        self._noted: dict[Key, Event] = {}
        self.examined_ns = 0
        """ROS time of the last round, 0 before the first."""

    def subscriptions(self) -> Mapping[str, Subscription]:
        """Return those of rules, and of /clock and joint states when they are needed."""
        rules = [*self.rules, *self._rules_of_config()]
        return merged((self._numbers.subscriptions(rules), self._clock.subscriptions()))

    def take(self, batches: Batches) -> None:
        """Take the numbers of rules, the newest time, and the newest joint states."""
        self._numbers.take(batches)
        self._clock.take(batches)

    def reset(self) -> None:
        """Forget all numbers."""
        self._numbers.reset()

    def state(self) -> Mapping[str, Any]:
        """Return the findings, and when they began."""
        return {
            "findings": self.findings,
            "examined_ns": self.examined_ns,
            "found": self.events,
        }

    @store(name="findings", of=lambda part: part.made_of)
    def findings_store(self, argument: str) -> FindingsStore:
        """Return the findings of the last round."""
        findings, names, start_ns, examined_ns = self.made_of
        return findings_store(findings, dict(names), (start_ns or 0) / 1e9, examined_ns)

    @property
    def made_of(self) -> tuple[Sequence[Finding], Sequence[tuple[str, str]], int | None, int]:
        """The findings, ids and names of displays, the start of the recording, and when it was."""
        names = [(row.id, row.name) for row in self._displays.rows]
        return self.findings, names, self._start_ns, self.examined_ns

    @property
    def _start_ns(self) -> int | None:
        playback = self.context.get(TimePart).playback
        return playback.start_ns if playback else None

    @property
    def is_graph_found(self) -> bool:
        """Return whether other nodes were found, or had the time to be."""
        is_early = time.monotonic() - self.listening_since_s < DISCOVERED_S
        return not is_early or len(self.context.graph.nodes()) > 1

    def is_settled(self) -> bool:
        """Return whether two rounds have examined all that is wrong, and agree on it."""
        if len(self._examined_problems) < 2 or not self._is_confirmed:
            return False
        return all(self._problems() <= each for each in self._examined_problems)

    def ask(self) -> None:
        """Examine for some seconds even if no browser is connected; thread-safe."""
        self._asked_until_s = time.monotonic() + ASKED_S

    def hasten(self) -> None:
        """Let the next round begin at once."""
        self._began = -EVERY_S, -EVERY_S

    def review(self) -> None:
        """Continue the round, or begin another when it is time."""
        is_asked = time.monotonic() < self._asked_until_s or any(self._rules())
        if not (self.context.is_watched() or is_asked):
            self._round = None
            self._clock.is_wanted = False
        elif self._round is not None or self._is_due():
            self._round = self._round or self._examined()
            self._continue(self._round)

    def _problems(self) -> Set[Symptom]:
        return problems(self.context.statuses, self._displays.rows).keys()

    def _environment(self) -> Environment | None:
        """Return this machine as it was some seconds ago; a thread looks at it.

        None with a bag or bridge, for which neither DDS nor ROS of this machine matters.
        """
        if self.context.get(TimePart).is_recording or self.context.player.bridges:
            return None
        looking = self._looking
        if looking is not None and looking.done():
            self._looking = None
            if looking.exception() is None:
                self.environment = looking.result()
        if self._looking is None and time.monotonic() >= self._next_look_s:
            before, losses = self.environment, self._lost_before
            self._next_look_s = time.monotonic() + (LOOK_S if before else SECOND_LOOK_S)
            with contextlib.suppress(OSError):  # no thread is free; another time
                self._looking = _looks.start(lambda: look_around("", losses, before))
        return self.environment

    def _is_due(self) -> bool:
        """Return whether a second has passed, of a recording or, while it is paused, of waiting."""
        now = self.context.clock(), self.context.waiting()
        if all(0.0 <= at - before < EVERY_S for at, before in zip(now, self._began, strict=True)):
            return False
        self._began = now
        return True

    def _continue(self, checks: Iterator[None]) -> None:
        until_s = time.monotonic() + self.slice_s
        for _ in checks:
            if time.monotonic() > until_s:
                return
        self._round = None

    def _examined(self) -> Iterator[None]:
        """Run all checks on what is seen now, with a pause after each."""
        context = self.context
        wrong = self._problems()
        load, cores = self._load.measure()
        observation = observe(context, self._displays, self._environment(), load, cores)
        others = [each for each in self.findings if each.id != OF_RULES]
        observation = replace(
            observation,
            findings=others,
            numbers=self._numbers.numbers(),
            clock=self._clock.observation(),
        )
        listened_s = time.monotonic() - self.listening_since_s
        joint_states = dict(self._clock.joint_states)
        observation = replace(observation, joint_states=joint_states, listened_s=listened_s)
        is_playing = observation.is_recorded or not observation.is_paused  # bags are played by hand
        self._clock.is_wanted = is_playing and bool(observation.stalled())
        if self._clock.is_wanted and not (observation.is_recorded or observation.bridges):
            nodes = (node for node in observation.stalled_nodes() if not is_own(node))
            observation = replace(observation, sim_time=self._sim_time.ask(nodes))
        context.verdicts = self.verdicts = self._evaluator.evaluate(self._rules(), observation)
        observation = replace(observation, verdicts=self.verdicts)
        findings: list[Finding] = []
        playback = context.get(TimePart).playback
        for check in self._current():
            findings += context.boundary.attempt(
                f"Check {check.id}", [], lambda c=check: list(c.find(observation))
            )
            yield
        before, now_ns = self._since, observation.now_ns
        now = now_ns, playback.position_s if playback else None
        self._since = {key: before.get(key, now) for key in map(_key, findings)}
        steady = [each for each in findings if _key(each) in before]
        self._is_confirmed = all(
            _key(each) in before for each in findings if each.severity > Severity.NOTE
        )
        self._examined_problems = *self._examined_problems[-1:], wrong
        self.findings = tuple(
            replace(
                each,
                command="" if observation.is_recorded else each.command,  # no node would answer
                first_ns=self._since[_key(each)][0],
                last_ns=now_ns,
                began_s=self._since[_key(each)][1],
            )
            for each in ordered(steady)
        )
        self.rounds += 1
        self.examined_ns = now_ns
        if playback is not None:
            at_ns = playback.start_ns + round(playback.position_s * 1e9)
            self._note(at_ns)

    def _rules(self) -> Iterator[Rule]:
        yield from self.rules
        yield from self._rules_of_config()

    def _rules_of_config(self) -> Iterator[Rule]:
        watched = self.context.get(SettingsPart).settings.watch
        yield from (rule.condition for rule in watched if rule.condition)

    def _current(self) -> Sequence[Check]:
        """Return the checks, those of files as they are now."""
        classes = known_checks()
        if tuple(map(type, self._checks)) != classes:
            self._checks = [check() for check in classes]
        return self._checks

    def _note(self, at_ns: int) -> None:
        """Note the findings that are new at a position of the recording."""
        new = [each for each in self.findings if each.severity > Severity.NOTE]
        for each in new[: max(0, MAX_EVENTS - len(self._noted))]:
            level = Level.ERROR if each.severity is Severity.ERROR else Level.WARN
            self._noted.setdefault(_key(each), Event(at_ns, level, each.id, each.cause))
        if len(self._noted) != len(self.events):
            self.events = tuple(sorted(self._noted.values(), key=lambda event: event.at_ns))


def _key(finding: Finding) -> Key:
    return finding.id, finding.subject

"""Runs all attacks on one viewer for some seconds."""

from __future__ import annotations

import gzip
import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, closing
from pathlib import Path
from random import Random

from tests.attack import (
    bombs,
    bridges,
    clocks,
    definitions,
    exported,
    files,
    media,
    reports,
    spreadsheets,
    terminals,
    tile_addresses,
    tiles,
    yaml_texts,
    zenoh_networks,
)
from tests.attack.agents import Agents
from tests.attack.attack import Attack, Case, Violation, random_of
from tests.attack.crowds import Crowds
from tests.attack.dds import Dds
from tests.attack.disks import Disks
from tests.attack.files import FileAttack
from tests.attack.graphs import Graphs
from tests.attack.http_requests import Requests
from tests.attack.queues import Queues
from tests.attack.report import Breach, Report
from tests.attack.saving import Saving
from tests.attack.simulator import Simulator
from tests.attack.sockets import Sockets, kind_of
from tests.attack.target import Target
from tests.attack.uploads import Uploads
from tests.attack.weights import Weights
from webviz.api.roles import Role
from webviz.shell.testing.domain import isolated_domain

CORPUS = Path(__file__).parent / "corpus"
"""Cases that once broke a promise, in a folder per kind: LABEL__NAME, packed if it ends with .gz.
Its README says what each of them broke."""
TURN_S = 2.0
"""Duration of one kind of attack before the next begins."""
MAX_BREACHES = 20
ROLES = (None, *Role)
FILES: Mapping[str, Callable[[Random], Case]] = {
    "files": files.draw,
    "bombs": bombs.draw,
    "media": media.draw,
    "tiles": tiles.draw,
    "tile addresses": tile_addresses.draw,
    "reports": reports.draw,
    "bridges": bridges.draw,
    "zenoh": zenoh_networks.draw,
    "exported": exported.draw,
    "definitions": definitions.draw,
    "yaml texts": yaml_texts.draw,
    "clocks": clocks.draw,
    "terminals": terminals.draw,
    "spreadsheets": spreadsheets.draw,
}
"""Makers of the cases of each attack by files: all that it is, besides its reader."""
READERS = {
    "exported": "exported",
    "definitions": "definition_reader",
    "spreadsheets": "spreadsheets",
}
"""Modules that read the files of an attack, if it is not `reader`."""
LOCAL = (Saving, Disks, Agents)
"""Other attacks on no viewer, but on how it saves and what it starts; each has a folder."""
KINDS = (
    *FILES,
    *(class_.kind for class_ in LOCAL),
    *(class_.kind for class_ in (Dds, Requests, Uploads, Simulator)),
    *(class_.kind for class_ in (Graphs, Crowds, Queues, Weights)),
    *map(kind_of, ROLES),
)
"""Kinds of attacks."""


def run(
    seed: int, seconds: float, folder: Path, only: Sequence[str] = (), first: int = 0
) -> Report:
    """Attack a viewer.

    Args:
        seed: of all cases; the same seed gives each kind the same cases in the same order.
        seconds: for attacks, besides those of the corpus and the start of the viewer.
        folder: for the files of the viewer and of the attacks.
        only: of KINDS; all if it is empty.
        first: number of the first case of each kind.
    """
    report = Report(seed)
    with ExitStack() as stack:
        domain = stack.enter_context(isolated_domain())
        # Their processes start while the viewer does.
        attacks = _started(local_attacks(folder), only, stack)
        target = stack.enter_context(closing(Target(folder / "viewer", dict(os.environ))))
        attacks += _started(remote_attacks(target, domain), only, stack)
        for attack in attacks:
            _replay(attack, target, report)
        _attack(attacks, target, report, seconds, first)
        try:
            target.restore()
            target.wait_until_answered()
            target.kill_while_saving(random_of(seed, "end", 0).uniform(0.0, 0.3))
        except Violation as violation:
            report.breaches.append(Breach("end", "", str(violation)))
        report.slowest_s, report.memory_mb = target.slowest_s, target.memory_mb
    return report


def _started(attacks: Iterator[Attack], only: Sequence[str], stack: ExitStack) -> list[Attack]:
    chosen = [attack for attack in attacks if not only or attack.kind in only]
    for attack in chosen:
        stack.enter_context(closing(attack)).start()
    return chosen


def local_attacks(folder: Path) -> Iterator[Attack]:
    """Return the attacks on files, and on how they are saved."""
    for kind in (*FILES, *(class_.kind for class_ in LOCAL)):
        (folder / kind).mkdir()
    for kind, draw in FILES.items():
        yield FileAttack(kind, draw, folder / kind, READERS.get(kind, "reader"))
    for class_ in LOCAL:
        yield class_(folder / class_.kind)


def remote_attacks(target: Target, domain: int) -> Iterator[Attack]:
    """Return the attacks on a running viewer."""
    yield Dds(domain)
    yield Graphs(target, domain)
    yield Weights(target, domain)
    for role in ROLES:
        yield Sockets(target, role)
    yield Requests(target)
    yield Uploads(target)
    yield Simulator(target)
    yield Crowds(target)
    yield Queues(target)


def _replay(attack: Attack, target: Target, report: Report) -> None:
    for path in sorted((CORPUS / attack.kind.replace(" ", "_")).glob("*__*")):
        _strike(attack, kept_case(path), path.name, target, report)


def kept_case(path: Path) -> Case:
    """A case of the corpus."""
    name, data = path.name.partition("__")[2], path.read_bytes()
    if name.endswith(".gz"):
        name, data = name.removesuffix(".gz"), gzip.decompress(data)
    return Case(name, data)


def _attack(
    attacks: Sequence[Attack], target: Target, report: Report, seconds: float, first: int
) -> None:
    numbers = dict.fromkeys((attack.kind for attack in attacks), first)
    end = time.monotonic() + seconds
    turn_s = min(TURN_S, seconds / len(attacks))
    while time.monotonic() < end and len(report.breaches) < MAX_BREACHES and target.is_alive:
        for attack in attacks:
            turn_end = time.monotonic() + turn_s
            enough = numbers[attack.kind] + attack.least
            while True:
                number = numbers[attack.kind]
                numbers[attack.kind] += 1
                case = attack.draw(random_of(report.seed, attack.kind, number))
                _strike(attack, case, number, target, report)
                is_over = numbers[attack.kind] >= enough and time.monotonic() > turn_end
                if is_over or not target.is_alive:
                    break


def _strike(attack: Attack, case: Case, number: int | str, target: Target, report: Report) -> None:
    try:
        outcome = attack.strike(case)
        target.check()
    except Violation as violation:
        report.breaches.append(Breach(attack.kind, number, str(violation), case))
    else:
        report.add(attack.kind, outcome)

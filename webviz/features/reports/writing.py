"""The content of a bug report of the moment that is shown, and its file."""

from __future__ import annotations

import base64
import binascii
import importlib.metadata
import io
import os
import platform
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import msgspec
import PIL.Image

from webviz.api.errors import Error
from webviz.api.offer import Offer
from webviz.api.status import Status
from webviz.data.words import counted
from webviz.data.working_folder import working_folder
from webviz.engine.commands import NodePicks
from webviz.engine.examiner import Examiner
from webviz.engine.state import Row
from webviz.files import config as config_file
from webviz.files.config import Config
from webviz.files.report import (
    BugReport,
    FindingEntry,
    PrivateNames,
    ReportedMoment,
    ReportedPick,
    StatusEntry,
    write_report,
)
from webviz.files.report.archive import CONFIG, PICTURES, REPORT, SLICE
from webviz.sources.past_state import Event
from webviz.sources.slices import Slice, WrittenSlice, write_slice

MAX_BYTES = 500_000_000
"""Limit in bytes of the slice."""
MAX_MOMENTS = 500
MAX_PICTURE = 16 << 20
MAX_PIXELS = 50_000_000
FRAMES, GRAPH, LOG = "frames.txt", "graph.json", "log.txt"
PACKAGES = ("ros-webviz", "viser", "numpy", "mcap", "msgspec", "rosbags")
VARIABLES = ("ROS_DISTRO", "RMW_IMPLEMENTATION")


class ReportMoment(msgspec.Struct, frozen=True):
    """All that a report is made of, as it was when it was asked for.

    Args:
        part, source: the messages, and whether they are live.
        rows, statuses, offers, logged, warned: see `webviz.State`.
        config: what is shown.
        frames, frame_count: the tree as text, and the number of its frames.
        selection: of the page that asked for it.
        names, with_names: what is private, and whether it is kept.
    """

    part: Slice
    source: str
    rows: Sequence[Row]
    statuses: Mapping[str, Status]
    offers: Mapping[str, Offer]
    logged: Sequence[Event]
    warned: Sequence[Event]
    config: Config
    frames: str
    frame_count: int
    selection: tuple[ReportedPick, ...]
    names: PrivateNames
    with_names: bool


def listing(moment: ReportMoment) -> list[str]:
    """Return the content of a report, a line per member."""
    part, names = moment.part, moment.names
    topics = counted(part.topics, "topic")
    whose = "the bag" if moment.source != "live" else "memory"
    statuses = sum(len(row.statuses) for row in moment.rows) + len(moment.statuses)
    lines = [
        f"{SLICE}: {part.seconds:.1f} s of {topics} from {whose}, latched messages first",
        f"{CONFIG}: {counted(len(moment.config.displays), 'display')} and settings as they are now",
        "picture: the scene as it is shown",
        f"{REPORT}: {statuses} statuses, findings of the "
        "doctor with their times, selection, versions of programs",
        f"{FRAMES}: the tree of {counted(moment.frame_count, 'frame')}",
        f"{GRAPH}: nodes, {counted(len(moment.offers), 'topic')}, types and QoS",
        f"{LOG}: the last lines of /rosout",
    ]
    if moment.with_names:
        return [*lines, "Names of hosts, users and home folders are included."]
    remaining = ", ".join(names.remaining_names)
    exceptions = f" except {remaining}, of topics or frames" if remaining else ""
    return [*lines, f"Names of hosts, users and home folders are left out{exceptions}."]


def write(
    path: Path, moment: ReportMoment, doctor: Examiner | None, picture: tuple[str, bytes] | None
) -> int:
    """Write a report with the newest findings of the doctor; its size in bytes.

    Raises:
        Error: it cannot be written.
    """
    names = moment.names
    keep = moment.with_names
    try:
        with working_folder(".webviz_report_", path.parent) as folder:
            file = folder / SLICE
            change = (lambda data: data) if keep else names.message
            written = write_slice(moment.part, file, MAX_BYTES, change)
            report = _report(moment, written, doctor)
            members: dict[str, bytes | Path] = {
                REPORT: _encoded(report),
                CONFIG: config_file.dump(moment.config).encode(),
                FRAMES: moment.frames.encode(),
                GRAPH: _encoded(_graph(moment.offers)),
                LOG: "".join(f"{line}\n" for line in written.log).encode(),
            }
            if not keep:
                texts = {name: data for name, data in members.items() if isinstance(data, bytes)}
                members |= {name: _private(names, data) for name, data in texts.items()}
            if picture is not None:
                members[picture[0]] = picture[1]
            members[SLICE] = file
            return write_report(path, members)
    except OSError as error:
        reason = os.strerror(error.errno) if error.errno else str(error)
        raise Error(f"Cannot write {path}: {reason}. Choose another place.") from error


def _private(names: PrivateNames, data: bytes) -> bytes:
    return names.text(data.decode("utf-8", "surrogateescape")).encode("utf-8", "surrogateescape")


def _report(moment: ReportMoment, written: WrittenSlice, doctor: Examiner | None) -> BugReport:
    began = {(event.name, event.text): event.at_ns / 1e9 for event in reversed(moment.warned)}
    rows = [row for row in moment.rows if row.type != "Group"]
    places = [("", moment.statuses), *((row.name, row.statuses) for row in rows)]
    events = [*moment.logged, *moment.warned, *(doctor.events if doctor else ())]
    return BugReport(
        source=moment.source,
        made=time.time(),
        at_ns=written.at_ns,
        first_ns=written.first_ns,
        last_ns=written.last_ns,
        has_names=moment.with_names,
        statuses=tuple(
            StatusEntry(
                name,
                key,
                status.level.name.lower(),
                status.text,
                began.get((name, status.text), 0.0),
            )
            for name, statuses in places
            for key, status in statuses.items()
        ),
        findings=tuple(
            FindingEntry(
                each.id,
                each.severity.name.lower(),
                each.subject,
                each.cause,
                each.remedy,
                each.first_ns / 1e9,
                each.last_ns / 1e9,
            )
            for each in (doctor.findings if doctor else ())
        ),
        moments=tuple(_moment(each) for each in sorted(events, key=_time)[-MAX_MOMENTS:]),
        selection=moment.selection,
        versions=_versions(),
    )


def _moment(event: Event) -> ReportedMoment:
    return ReportedMoment(event.at_ns / 1e9, event.level.name.lower(), event.name, event.text)


def _time(event: Event) -> int:
    return event.at_ns


def picked(picks: Sequence[NodePicks], rows: Sequence[Row]) -> tuple[ReportedPick, ...]:
    """Return a selection, with the numbers of displays instead of their ids, which differ later."""
    places = {row.id: number for number, row in enumerate(rows)}
    reported: list[ReportedPick] = []
    for each in picks:
        id, _, rest = each.group.partition("/")
        if (display := places.get(id)) is None:
            continue
        for _, number, at, color in each.items:
            reported.append(ReportedPick(display, rest, each.key, number, at, color))
    return tuple(reported)


def _graph(offers: Mapping[str, Offer]) -> dict[str, Any]:
    nodes = sorted({p.node for offer in offers.values() for p in offer.publishers if p.node})
    topics = [
        {
            "topic": topic,
            "types": sorted({p.type for p in offer.publishers}),
            "publishers": [
                {
                    "node": p.node,
                    "type": p.type,
                    "reliability": p.reliability,
                    "durability": p.durability,
                }
                for p in offer.publishers
            ],
            "subscribers": offer.subscribers,
            "requested": offer.requested,
            "problem": offer.problem,
        }
        for topic, offer in sorted(offers.items())
    ]
    return {"nodes": nodes, "topics": topics}


def _versions() -> dict[str, str]:
    versions = {"python": platform.python_version(), "system": platform.platform()}
    for name in PACKAGES:
        try:
            versions[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            continue
    return versions | {name: os.environ[name] for name in VARIABLES if name in os.environ}


def namespaces(offers: Mapping[str, Offer]) -> set[str]:
    """Full names of nodes, of which namespaces may be a part of topics."""
    return {p.node.rpartition("/")[0] for offer in offers.values() for p in offer.publishers}


def _encoded(value: Any) -> bytes:
    return msgspec.json.format(msgspec.json.encode(value), indent=1)


def read_picture(text: str) -> tuple[str, bytes] | None:
    """Return the name and content of the member with a picture that was sent, None without one.

    Raises:
        Error: it is not a picture.
    """
    if not text:
        return None
    try:
        data = base64.b64decode(text, validate=True)
        with PIL.Image.open(io.BytesIO(data), formats=("PNG", "JPEG")) as image:
            if len(data) > MAX_PICTURE or image.width * image.height > MAX_PIXELS:
                raise Error("The picture is too large for a report. Make the window smaller.")
            kind = image.format
    except (binascii.Error, OSError, ValueError, SyntaxError) as error:
        raise Error("The picture of the report is not a PNG or JPEG image.") from error
    return PICTURES[0 if kind == "PNG" else 1], data

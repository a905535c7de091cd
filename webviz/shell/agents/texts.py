"""The state of a viewer as short texts, which cost an agent little to read."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

from webviz.api.finding import Finding
from webviz.api.offer import Offer
from webviz.api.status import Level
from webviz.data.messages.tree import Tree
from webviz.data.words import joined
from webviz.engine.state import Inspected, Row, Traffic
from webviz.shell.app.viewer import Viewer

MAX_LINES = 200
MAX_LINE = 400
"""Characters, of which a name on a topic may have more."""
MAX_NODES = 4
"""Publishers of a topic that are named."""


def bounded(lines: Iterable[str]) -> str:
    """Lines as one text, without what would be too long."""
    bounded_lines: list[str] = []
    for number, line in enumerate(lines):
        if number == MAX_LINES:
            bounded_lines.append("… and more.")
            break
        bounded_lines.append(line if len(line) <= MAX_LINE else f"{line[:MAX_LINE]}…")
    return "\n".join(bounded_lines)


def explanation(viewer: Viewer, display: str = "") -> Iterator[str]:
    """Yield findings, the one to repair first at the beginning, and the statuses of displays.

    Args:
        viewer: that is examined.
        display: name or id of the only one to tell about, "" for all.
    """
    rows = [row for row in viewer.rows if display in ("", row.name, row.id)]
    names = {row.id: row.name for row in viewer.rows}
    findings, playback = viewer.fact("findings"), viewer.fact("playback")
    if display:
        ids = {row.id for row in rows}
        findings = [f for f in findings if not f.explains or ids & {s.display for s in f.explains}]
    yield from _findings(findings, names)
    yield f"Fixed frame: {viewer.fixed_frame}."
    if playback is not None and playback.is_live is not True:
        yield f"A recording is shown, at {playback.position_s:.2f} s."
    for key, status in viewer.statuses.items():
        if status.level is not Level.OK:
            yield f"{status.level.name} {key}: {status.text}"
    for row in rows:
        yield from _row(row)


def _findings(findings: Sequence[Finding], names: dict[str, str]) -> Iterator[str]:
    yield "Findings, in the order of repair:" if findings else "The doctor found no problems."
    for each in findings:
        line = f"{each.severity.name} {each.id}: {joined(each.cause, each.proof, each.remedy)}"
        command = f" Command: `{each.command}`." if each.command else ""
        explained = [f"{names.get(s.display, 'viewer')}/{s.status}" for s in each.explains]
        yield line + command + (f" Explains {', '.join(explained)}." if explained else "")


def _row(row: Row) -> Iterator[str]:
    suffix = "" if row.enabled else ", switched off"
    yield f"{row.level.name} {row.name} ({row.type}, id {row.id}{suffix})"
    for key, status in row.statuses.items():
        yield f"  {status.level.name} {key}: {status.text}"


def topics(offers: Mapping[str, Offer], traffic: Mapping[str, Traffic]) -> Iterator[str]:
    """All topics with their types and publishers, and rates of those that are subscribed."""
    for name, offer in sorted(offers.items()):
        types = ", ".join(sorted({each.type for each in offer.publishers})) or "no publisher"
        nodes = ", ".join(sorted({each.node for each in offer.publishers})[:MAX_NODES])
        measured = traffic.get(name)
        rate = f", {measured.rate_hz:.1f} Hz" if measured else ""
        yield f"{name}: {types}{f' from {nodes}' if nodes else ''}{rate}"


def message(topic: str, inspected: Inspected) -> Iterator[str]:
    """Yield the newest message of a topic, a field a line."""
    if inspected.message is None:
        yield inspected.problem or f"No message on {topic} has arrived yet."
        return
    yield f"{topic}: {inspected.type}, {inspected.size} bytes"
    yield from _fields(inspected.message, "")


def selection(things: Mapping[str, Any]) -> Iterator[str]:
    """Yield a selection, see `webviz.shell.app.running.Running.select`."""
    for number, each in things.items():
        if number != "/info":
            yield f"{each['title']} of {each['name']}. {each['note']}".rstrip()
            yield from _fields(each["tree"], "")


def _fields(tree: Tree, path: str) -> Iterator[str]:
    """Yield the values of a message with their paths; see `webviz.data.messages.to_tree`."""
    match tree:
        case {"fields": fields}:
            for name, value in fields.items():
                yield from _fields(value, f"{path}.{name}" if path else name)
        case {"length": length, "items": items} if all(isinstance(each, str) for each in items):
            rest = ", …" if length > len(items) else ""
            yield f"{path}: {length} values [{', '.join(items)}{rest}]"
        case {"length": length, "items": items}:
            yield f"{path}: {length} items"
            for number, each in enumerate(items):
                yield from _fields(each, f"{path}[{number}]")
        case _:
            yield f"{path}: {tree}"

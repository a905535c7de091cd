"""Statuses of markers; all lists are bounded."""

from __future__ import annotations

import heapq
from collections.abc import Set

from webviz import Context, Level
from webviz.data.words import counted, listed
from webviz_displays.markers.actions import Key
from webviz_displays.markers.blocks import Blocks
from webviz_displays.markers.store import MAX_MARKERS, Store

NAMED = 10
"""Markers and namespaces that get a status of their own; the rest is counted."""
SECOND = 1_000_000_000


def report_markers(store: Store, blocks: Blocks, off: Set[str], loading: int, ctx: Context) -> None:
    """Report how many markers are drawn, and why others are not.

    Args:
        store: all markers.
        blocks: what is drawn of them.
        off: namespaces whose markers are not drawn.
        loading: how many files are being loaded.
        ctx: receives the statuses.
    """
    table = store.table
    faults: dict[Key, tuple[Level, str]] = {
        key: fault
        for block in blocks
        for row, fault in block.faults.items()
        if (key := table.keys[row]) is not None
    }
    refused = {
        key: (Level.ERROR, f"{why} Fix the publisher.") for key, why in store.refused.items()
    }
    faults = {**refused, **faults}
    shown = sum(block.shown for block in blocks)
    _report_total(store, shown, off, ctx)
    worst = sorted(faults.items(), key=lambda item: -item[1][0])
    for key, (level, text) in worst[:NAMED]:
        (ctx.error if level is Level.ERROR else ctx.warn)(f"Marker {_name(key)}", text)
    if len(worst) > NAMED:
        ctx.warn("Other markers", f"{len(worst) - NAMED} more are invalid or invisible.")
    if loading:
        (ctx.ok if shown else ctx.warn)("Loading", f"Loading {counted(loading, 'file')}.")
    if store.duplicates:
        names = listed([_name(key) for key in dict.fromkeys(store.duplicates)], NAMED)
        ctx.warn(
            "Duplicates",
            f"The last array has several markers with one namespace and id: {names}. Only the last "
            "of each is shown. Use different ids.",
        )
    if store.tilted:
        names = listed([_name(key) for key in sorted(store.tilted)[:NAMED]], NAMED)
        ctx.warn(
            "Orientation",
            f"The orientation of {counted(len(store.tilted), 'marker')} is not a unit quaternion "
            f"({names}). It is normalised, all zeros mean no rotation. Fix the publisher.",
        )
    if store.unknown_actions:
        actions = listed([str(each) for each in dict.fromkeys(store.unknown_actions)], NAMED)
        ctx.warn("Action", f"Unknown action {actions}: use ADD 0, DELETE 2 or DELETEALL 3.")
    if store.overflow:
        ctx.error(
            "Limit",
            f"{store.overflow} markers refused: the limit is {MAX_MARKERS}. Delete old ones, or "
            "give them a lifetime.",
        )


def _report_total(store: Store, shown: int, off: Set[str], ctx: Context) -> None:
    table = store.table
    total = len(table)
    namespaces = table.namespaces
    named_off = sorted(off & namespaces.keys())
    hidden = sum(namespaces[name] for name in named_off)
    waiting = sum(len(rows) for rows in store.waiting.values())
    if not total:
        ctx.warn("Markers", f"No markers.{_last_expired(store, ctx)}")
        return
    text = (
        f"{shown} of {counted(total, 'marker')} shown"
        if shown < total
        else counted(total, "marker")
    )
    parts = [f"{text} in {counted(len(namespaces), 'namespace')}"]
    if named_off:
        parts.append(f"{hidden} in namespaces that are switched off ({listed(named_off, NAMED)})")
    if waiting:
        parts.append(f"{waiting} waiting for a transform")
    (ctx.ok if shown else ctx.warn)("Markers", "; ".join(parts) + ".")


def _last_expired(store: Store, ctx: Context) -> str:
    if not store.expired:
        return " All were deleted, or none has arrived. Check what the publisher sends."
    key, at_ns = next(reversed(store.expired.items()))
    ago = (ctx.frames.now_ns - at_ns) / SECOND
    return (
        f" The last one, {_name(key)}, expired {ago:.1f} s ago. Publish markers more often than "
        "their lifetime ends."
    )


def report_waiting(store: Store, ctx: Context) -> None:
    """Report which markers have no transform, and why."""
    if not store.waiting:
        return
    count = sum(len(rows) for rows in store.waiting.values())
    (frame, stamp_ns), rows = max(store.waiting.items(), key=lambda item: len(item[1]))
    key = store.table.keys[rows[0]]
    first = "" if key is None else f" ({_name(key)}{', ...' if count > 1 else ''})"
    reason = ctx.frames.why_not(frame, stamp_ns)
    verb = "waits" if count == 1 else "wait"
    ctx.error("Transform", f"{counted(count, 'marker')}{first} {verb} for a transform. {reason}")


def report_namespaces(store: Store, off: Set[str], ctx: Context) -> None:
    """Report how many markers each namespace has, and when the newest arrived."""
    table = store.table
    counts = table.namespaces
    received = table.wanted["received_ns"]
    for namespace in heapq.nsmallest(NAMED, counts):
        newest = int(received[table.in_namespaces([namespace])].max())
        age = (ctx.frames.now_ns - newest) / SECOND
        how = ", switched off" if namespace in off else ""
        text = f"{counted(counts[namespace], 'marker')}{how}, the newest {age:.1f} s ago."
        ctx.ok(f"Namespace '{namespace}'", text)
    if len(counts) > NAMED:
        ctx.ok("Other namespaces", f"{len(counts) - NAMED} more.")


def _name(key: Key) -> str:
    return f"{key[0]}/{key[1]}"

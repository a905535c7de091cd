"""Statuses of markers; all lists are bounded."""

from __future__ import annotations

import heapq
from collections.abc import Set

import numpy as np

from webviz import Context, Level, OtherFixedFrame, Remedy
from webviz.data.messages.markers import Marker
from webviz.data.words import counted, joined, listed
from webviz_displays.markers.actions import Key, name_of
from webviz_displays.markers.blocks import MAX_PLACES, Blocks
from webviz_displays.markers.store import MAX_MARKERS, Store
from webviz_displays.markers.table import Place

NAMED = 10
"""Markers and namespaces that get a status of their own; the rest is counted."""
MAX_TEXTS = 4096
"""Largest number of texts that a page of viser shows, those of other displays included."""
SECOND = 1_000_000_000
PATIENCE_NS = SECOND
"""A marker that waits longer for its transform is reported; TF is often late."""


def report_markers(store: Store, blocks: Blocks, off: Set[str], loading: int, ctx: Context) -> None:
    """Report how many markers are drawn, and why others are not.

    Args:
        store: all markers.
        blocks: what is drawn of them.
        off: namespaces whose markers are not drawn.
        loading: how many files are being loaded.
        ctx: receives the statuses.
    """
    table, remarks = store.table, store.remarks
    faults: dict[Key, tuple[Level, str]] = {
        key: fault
        for block in blocks
        for row, fault in block.faults.items()
        if (key := table.keys[row]) is not None
    }
    refused = {
        key: (Level.ERROR, joined(why, "Fix the publisher."))
        for key, why in remarks.refused.items()
    }
    faults = {**refused, **faults}
    count = sum(block.count for block in blocks)
    _report_total(store, count, off, ctx)
    worst = sorted(faults.items(), key=lambda item: -item[1][0])
    for key, (level, text) in worst[:NAMED]:
        (ctx.error if level is Level.ERROR else ctx.warn)(f"Marker {name_of(key)}", text)
    if len(worst) > NAMED:
        ctx.warn("Other markers", f"{len(worst) - NAMED} more are invalid or invisible.")
    texts = int(np.count_nonzero(table.is_shown & (table.shown["type"] == Marker.TEXT_VIEW_FACING)))
    if texts > MAX_TEXTS:
        text = f"Browsers show {MAX_TEXTS} of all texts; these are {texts}. Delete some."
        ctx.warn("Texts", text)
    if left_out := sum(block.left_out for block in blocks):
        ctx.warn(
            "Places",
            f"{counted(left_out, 'marker')} left out: at most {MAX_PLACES} frames that markers are "
            "locked to, and areas of 4 km, are drawn. Use fewer.",
        )
    if loading:
        text = f"Loading {counted(loading, 'file')}."
        ctx.ok("Loading", text) if count else ctx.loading(text)
    if remarks.duplicates:
        names = listed([name_of(key) for key in dict.fromkeys(remarks.duplicates)], NAMED)
        ctx.warn(
            "Duplicates",
            f"The last array has several markers with one namespace and id: {names}. Only the last "
            "of each is shown. Use different ids.",
        )
    if remarks.tilted:
        names = listed([name_of(key) for key in sorted(remarks.tilted)[:NAMED]], NAMED)
        ctx.warn(
            "Orientation",
            f"The orientation of {counted(len(remarks.tilted), 'marker')} is not a unit quaternion "
            f"({names}). It is normalised, all zeros mean no rotation. Fix the publisher.",
        )
    if remarks.unknown_actions:
        actions = listed([str(each) for each in dict.fromkeys(remarks.unknown_actions)], NAMED)
        ctx.warn("Action", f"Unknown action {actions}: use ADD 0, DELETE 2 or DELETEALL 3.")
    if remarks.overflow:
        ctx.error(
            "Limit",
            f"{remarks.overflow} markers refused: the limit is {MAX_MARKERS}. Delete old ones, or "
            "give them a lifetime.",
        )


def _report_total(store: Store, count: int, off: Set[str], ctx: Context) -> None:
    table = store.table
    total = len(table)
    namespaces = table.namespaces
    named_off = sorted(off & namespaces.keys())
    hidden = sum(namespaces[name] for name in named_off)
    waiting = store.waiting_count
    if not total:
        return  # see report_nothing
    text = (
        f"{count} of {counted(total, 'marker')} shown"
        if count < total
        else counted(total, "marker")
    )
    parts = [f"{text} in {counted(len(namespaces), 'namespace')}"]
    if named_off:
        parts.append(f"{hidden} in namespaces that are switched off ({listed(named_off, NAMED)})")
    if waiting:
        parts.append(f"{waiting} waiting for a transform")
    text = f"{'; '.join(parts)}."
    if count:
        ctx.ok("Markers", text)
    else:
        ctx.warn("Markers", text, Remedy("namespaces", {}, "Show all namespaces") if off else None)


def report_nothing(store: Store, ctx: Context) -> None:
    """Report why there are no markers."""
    if len(store.table) or store.is_unfinished:
        return
    last = next(reversed(store.remarks.deletions.values()), None)
    if last is None:
        ctx.warn("Markers", "No markers. None has arrived. Check what the publisher sends.")
        return
    did, remedy = {
        "Expired": ("expired", "Publish markers more often than their lifetime ends."),
        "Deleted": ("was deleted", "Check what the publisher sends."),
    }[last.how]
    ago = last.age(ctx.frames.now_ns)
    ctx.warn("Markers", f"No markers. The last one, {name_of(last.key)}, {did} {ago}. {remedy}")


def report_waiting(store: Store, ctx: Context) -> None:
    """Report which markers have no transform, and why.

    Those that wait for less than `PATIENCE_NS`, as transforms often come late, are reported only in
    a bag, in which nothing comes while its time stands still, and only if none of their versions is
    drawn.
    """
    if not store.waiting:
        return
    table, now_ns, since_ns = store.table, ctx.frames.now_ns, store.waiting_since_ns()
    is_recorded = bool(ctx.frames.buffer.recorded)
    late: dict[Place, list[int]] = {}
    level = Level.WARN
    for place, rows in store.waiting.items():
        numbers = np.array(rows)
        is_late = now_ns - since_ns[numbers] > PATIENCE_NS
        if is_late.any():
            level = Level.ERROR
        if is_recorded:
            is_late |= ~table.is_shown[numbers]
        if is_late.any():
            late[place] = numbers[is_late].tolist()
    if not late:
        return
    count = sum(map(len, late.values()))
    (frame, stamp_ns), rows = max(late.items(), key=lambda item: (len(item[1]), item[0]))
    key = min(filter(None, (table.keys[row] for row in rows)), default=None)
    first = "" if key is None else f" ({name_of(key)}{', ...' if count > 1 else ''})"
    reason = ctx.frames.explain(frame, stamp_ns)
    verb = "waits" if count == 1 else "wait"
    text = f"{counted(count, 'marker')}{first} {verb} for a transform. {reason.sentence}"
    say = ctx.error if level is Level.ERROR else ctx.warn
    say("Transform", text, OtherFixedFrame.of(reason), reason)


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

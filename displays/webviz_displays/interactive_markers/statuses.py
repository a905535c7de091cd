"""Statuses about interactive markers."""

from __future__ import annotations

from webviz import Context
from webviz.data.words import counted, shortened
from webviz_displays.interactive_markers.completion import MAX_LABEL
from webviz_displays.interactive_markers.reading import MAX_MARKERS
from webviz_displays.interactive_markers.server import InteractiveMarkerServer

MAX_ROWS = 20
"""Markers with a status of their own."""


def report(server: InteractiveMarkerServer, refusal: str, ctx: Context) -> None:
    """Report how the connection is, and each marker."""
    status = server.client.status(len(server.markers))
    ctx.statuses["Server"] = status
    if refusal:
        ctx.warn("Feedback", f"Markers cannot be moved from here. {refusal}")
    if server.left_out:
        ignored = counted(server.left_out, "marker")
        ctx.warn("Markers", f"Ignored {ignored} beyond the limit of {MAX_MARKERS}.")
    if loading := server.assets.loading:
        ctx.loading(f"Loading {counted(loading, 'file')} of controls.")
    if server.undrawn:
        ctx.warn("Drawing", f"Drawing {counted(server.undrawn, 'more marker')}.")
    troubles = _troubles(server, ctx)
    if len(troubles) > MAX_ROWS:
        ctx.warn("Others", f"{len(troubles) - MAX_ROWS} more markers have problems.")
    for name, (is_error, text) in list(troubles.items())[:MAX_ROWS]:
        (ctx.error if is_error else ctx.warn)(_key(name, ctx), text)
    for name in list(server.markers.keys() - troubles.keys())[: MAX_ROWS - len(troubles)]:
        marker = server.markers[name]
        place = marker.place(ctx.frames)
        if place is None:
            continue
        if marker.is_locked:
            ctx.ok(_key(name, ctx), f"Locked to frame {place.frame}.")
        else:
            ctx.ok(_key(name, ctx), "Position is fixed.")


def _key(name: str, ctx: Context) -> str:
    """Return the key of the status of a marker, which may be called like another one."""
    label = shortened(name, MAX_LABEL) or "(no name)"
    return f"{label} (marker)" if label in ctx.statuses else label


def _troubles(server: InteractiveMarkerServer, ctx: Context) -> dict[str, tuple[bool, str]]:
    """Return the problems of markers by name: an error or not, and a sentence."""
    found = {name: (True, text) for name, text in server.ignored.items()}
    frames = ctx.frames
    for name, marker in server.markers.items():
        if name in found:
            continue
        place, source = marker.place(frames), marker.source
        if not source.frame:
            found[name] = True, "Its header has no frame id. Correct the server."
        elif place is None:
            found[name] = True, frames.why_not(source.frame, source.stamp_ns)
        elif lost := server.shown[name].lost:
            found[name] = True, lost
        elif fault := server.shown[name].fault:
            found[name] = True, fault
        elif marker.made.problems:
            found[name] = False, marker.made.problems[0]
        elif not marker.made.parts:
            found[name] = False, "It has no controls, so only its title is shown."
        elif frames.latest(place.frame) is None:
            found[name] = True, frames.why_not(place.frame)
    return found

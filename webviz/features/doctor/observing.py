"""Observation of a viewer, for the checks."""

from __future__ import annotations

from collections.abc import Mapping
from functools import partial
from types import MappingProxyType

from webviz.api.browser import BrowserSeen
from webviz.api.display import Display
from webviz.api.environment import Environment
from webviz.api.frames import Frames
from webviz.api.nodes import Pose
from webviz.api.observation import DisplaySeen, Observation
from webviz.api.views import FIXED_FRAME, Camera, camera_of, rig_of
from webviz.engine.parts.display_rows import is_group
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.part import PartContext
from webviz.engine.parts.time import TimePart

POINTS = 10_000
"""Number of points of a cloud that are looked at for its extent."""


def observe(
    context: PartContext,
    displays: DisplaysPart,
    environment: Environment | None = None,
    load: float = 0.0,
    cores: Mapping[str, float] = MappingProxyType({}),
) -> Observation:
    """Observe the viewer at this turn.

    Args:
        context: has transforms, topics and time.
        displays: have the messages.
        environment: of this machine, None if unknown.
        load: share of a processor that the frame loop takes.
        cores: that of each display, by id.
    """
    runners = {runner.id: runner for runner in displays.list.active()}
    consistency = displays.consistency
    displays_seen = [
        DisplaySeen(
            id=row.id,
            type=row.type,
            display=row.display,
            statuses=row.statuses,
            inputs=runners[row.id].observed(),
            fit=consistency.fits.get(row.id),
            blocked=consistency.blocked.get(row.id, 0),
            find_box=partial(context.scene.bounds, f"{row.id}/", POINTS),
            wanted_points=displays.points.demand(row.id),
            core=cores.get(row.id, 0.0),
            order=order,
        )
        for order, row in enumerate(displays.rows)
        if row.id in runners and isinstance(row.display, Display) and not is_group(row)
    ]
    times = context.get(TimePart).times
    browsers = context.boundary.attempt("Scene", (), context.scene.browsers.reports)
    cameras = {each.id: camera for each in browsers if (camera := _camera(each, context.frames))}
    return Observation(
        now_ns=context.frames.now_ns,
        fixed_frame=context.frames.fixed_frame,
        buffer=context.buffer,
        displays=displays_seen,
        statuses=context.statuses,
        offers=context.offers,
        nodes=context.graph.nodes(),
        is_simulated=times.is_simulated,
        clock_hz=times.clock_hz,
        is_paused=times.is_paused,
        is_recorded=context.get(TimePart).is_recording,
        environment=environment,
        bridges=context.player.bridges,
        browsers=browsers,
        cameras=cameras,
        load=load if browsers else 0.0,
    )


def _camera(browser: BrowserSeen, frames: Frames) -> Camera | None:
    """Return the camera of a browser in the fixed frame, None if it is unknown."""
    view = browser.view
    if view is None or browser.size[1] <= 0.0:
        return None
    is_fixed = view.target_frame == FIXED_FRAME
    target = Pose() if is_fixed else frames.latest(view.target_frame)
    return target and rig_of(view, target).outward(camera_of(view, browser.size[1]))

"""Observation of a viewer, for the checks."""

from __future__ import annotations

from webviz.api.display import Display
from webviz.api.environment import Environment
from webviz.api.group import DisplayGroup
from webviz.api.observation import DisplaySeen, Observation
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.part import Core
from webviz.engine.state import Row, State


def observe(
    core: Core, displays: DisplaysPart, state: State, environment: Environment | None = None
) -> Observation:
    """Observe the viewer at this turn.

    Args:
        core: has transforms, topics and time.
        displays: have the messages.
        state: of this turn, with all statuses.
        environment: of this machine, None if unknown.
    """
    runners = {runner.id: runner for runner in displays.list.active()}
    consistency = displays.consistency
    seen = [
        DisplaySeen(
            id=row.id,
            type=row.type,
            display=row.display,
            statuses=row.statuses,
            inputs=runners[row.id].observed(),
            fit=consistency.fits.get(row.id),
            blocked=consistency.blocked.get(row.id, 0),
        )
        for row in state.rows
        if row.id in runners and isinstance(row.display, Display) and not _is_group(row)
    ]
    return Observation(
        now_ns=core.frames.now_ns,
        fixed_frame=core.frames.fixed_frame,
        buffer=core.buffer,
        displays=seen,
        statuses=state.statuses,
        offers=core.offers,
        nodes=core.gate.nodes(),
        is_simulated=state.clock.is_simulated,
        clock_hz=state.clock.clock_hz,
        is_paused=state.clock.is_paused,
        is_recorded=state.playback is not None and state.playback.is_live is None,
        environment=environment,
        bridges=state.bridges,
    )


def _is_group(row: Row) -> bool:
    return isinstance(row.display, DisplayGroup)

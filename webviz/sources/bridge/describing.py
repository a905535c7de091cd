"""The state of a link to a bridge, as everybody sees it."""

from __future__ import annotations

import time
from collections.abc import Iterable
from dataclasses import replace

from webviz.api.bridge import Bridge
from webviz.data.words import Problem, listed
from webviz.sources.bridge.connection import STALLED_S
from webviz.sources.bridge.pacing import Pacer
from webviz.sources.bridge.session import BridgeSession

MOST = 5
"""Thinned topics that are named."""


def thinning(pacer: Pacer) -> list[str]:
    """Return a sentence on the topics that are thinned; none if the link takes all."""
    rates = pacer.thinned(time.monotonic())
    if not rates:
        return []
    parts = listed([f"{topic} to {hz:.2g} Hz" for topic, hz in sorted(rates.items())], MOST)
    mbit = pacer.carried() * 8e-6
    return [f"The link carries {mbit:.2g} Mbit/s, so webviz thins {parts}."]


def described(
    before: Bridge,
    session: BridgeSession | None,
    problem: Problem | None,
    remarks: Iterable[str],
    silent_s: float,
    round_trip_s: float | None,
) -> Bridge:
    """Return a bridge as it is now.

    Args:
        before: as it was.
        session: that is open, None while the link is broken.
        problem: why it is broken, None if it is not.
        remarks: sentences about the open link.
        silent_s: seconds without any byte.
        round_trip_s: see `Bridge`.
    """
    is_up = session is not None and problem is None
    stall = f"Nothing came from the bridge for {silent_s:.0f} s. Check the network."
    stalls = [stall] if silent_s > STALLED_S else []
    return replace(
        before,
        protocol=session.protocol if session else before.protocol,
        is_up=is_up,
        was_up=before.was_up or is_up,
        problem="" if problem is None else problem.cause,
        remedy="" if problem is None else problem.remedy,
        remarks=(*stalls, *remarks, *session.remarks) if session and is_up else (),
        limits=tuple(session.limits) if session else before.limits,
        round_trip_s=round_trip_s,
        parameters=session.parameters if session else before.parameters,
    )

"""Loading a robot description beside the frame loop."""

from __future__ import annotations

from pathlib import Path

from webviz import Context
from webviz_urdf import Loading, Request, Robot

Loadings = dict[Request, Loading]
"""The robots that are being loaded."""


def request_file(path: str, package_paths: tuple[str, ...]) -> Request:
    """The description in a file as it is now."""
    try:
        changed_ns = Path(path).expanduser().stat().st_mtime_ns
    except OSError:
        changed_ns = 0  # loading will say what is wrong
    return Request(path=path, changed_ns=changed_ns, package_paths=package_paths)


def load(request: Request, before: Loadings, ctx: Context) -> Robot | None:
    """The robot, None while it is being loaded; `before` is what was being loaded so far.

    Raises:
        RobotDescriptionError: it cannot be drawn; one sentence says why.
    """
    loading = before.get(request) or Loading(request)
    robot = ctx.background(request, loading.run, stop=loading.stop)
    if robot is None:
        ctx.state["loading"][request] = loading
        ctx.warn("Loading", progress(loading))
    return robot


def progress(loading: Loading) -> str:
    """How far it is, for a status."""
    done, total, link = loading.at
    return f"Loading: {done} of {total} shapes, at link '{link}'." if total else "Loading."

"""Loading a robot description outside the frame loop."""

from __future__ import annotations

from pathlib import Path

from webviz import Context
from webviz_urdf import Loading, LoadRequest, Robot

Loadings = dict[LoadRequest, Loading]
"""The robots being loaded."""


def request_file(path: str, package_paths: tuple[str, ...]) -> LoadRequest:
    """The current description in a file."""
    try:
        changed_ns = Path(path).expanduser().stat().st_mtime_ns
    except OSError:
        changed_ns = 0  # loading reports the cause
    return LoadRequest(path=path, changed_ns=changed_ns, package_paths=package_paths)


def load(request: LoadRequest, before: Loadings, ctx: Context) -> Robot | None:
    """The robot, None while it is being loaded; `before` is the previous request.

    Raises:
        RobotDescriptionError: it cannot be drawn; the text is one sentence.
    """
    loading = before.get(request) or Loading(request)
    robot = ctx.background(request, loading.run, stop=loading.stop)
    if robot is None:
        ctx.state.loading[request] = loading
        ctx.warn("Loading", progress(loading))
    return robot


def progress(loading: Loading) -> str:
    """Loading progress for a status."""
    done, total, link = loading.at
    return f"Loading: {done} of {total} shapes, at link '{link}'." if total else "Loading."

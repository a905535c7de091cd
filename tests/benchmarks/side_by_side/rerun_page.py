"""Rerun's web viewer, which rerun-sdk brings, in a page."""

from __future__ import annotations

from typing import TYPE_CHECKING
from urllib.parse import quote

from side_by_side.systems.ports import free_port

if TYPE_CHECKING:
    from playwright.sync_api import Page

LOAD_MS = 15_000
"""For its program, its shaders and the first data, which a script cannot see."""


def show(page: Page, port: int) -> None:
    """Open it on what the gRPC server at a port has."""
    import rerun as rr  # pyright: ignore[reportMissingImports]  # only with the extra "bench"

    web_port = free_port()
    rr.serve_web_viewer(web_port=web_port, open_browser=False)
    data = quote(f"rerun+http://127.0.0.1:{port}/proxy", safe="")
    page.goto(f"http://127.0.0.1:{web_port}/?url={data}&renderer=webgl")
    page.wait_for_selector("canvas")
    page.evaluate("() => window.countFrames()")
    page.wait_for_timeout(LOAD_MS)

"""The page of viser, which is one file."""

from __future__ import annotations

from importlib import resources

_OWN = b"(async()=>{  const d=document.currentScript.dataset;"
"""Beginning of viser's script, which unpacks the rest of it."""


def with_head(page: bytes, head: bytes) -> bytes:
    """viser's page with something in its head, whose modules run before viser's own script.

    Raises:
        ValueError: it is not an HTML page with a head and the script of viser.
    """
    start, tag, rest = page.partition(b"<head>")
    before, own, after = rest.partition(_OWN)
    if not (tag and own):
        raise ValueError("The page of viser has no <head>, or another script than expected.")
    return start + tag + head + before + own + b"await window.webvizModules;" + after


def client_page() -> bytes:
    """viser's page as it is installed."""
    return (resources.files("viser") / "client" / "build" / "index.html").read_bytes()

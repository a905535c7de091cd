"""Viewers in notebooks: embedded by pages that may, in a real browser, and by no others."""

from __future__ import annotations

import contextlib
import sys
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from types import ModuleType

import playwright.sync_api as playwright
import pytest
from refusals import refusal_of
from serving import served_folder

import webviz
from webviz.api.roles import Role
from webviz.server.access import token_file
from webviz.server.access.access import Access
from webviz.server.access.tokens import make
from webviz.shell.app.notebook import OF_NOTEBOOKS, embedders, html
from webviz.shell.testing.source import HandFedSource

SIZE: playwright.ViewportSize = {"width": 400, "height": 300}
REACH = """() => {
  const inside = document.querySelector("iframe").contentWindow;
  for (const type of ["CommandRequest", "connect", "message"])
    for (let i = 0; i < 100; i++) inside.postMessage({ type, command: "Load", data: "x" }, "*");
  return ["webviz", "document", "localStorage", "eval"].filter((name) => {
    try {
      return inside[name];
    } catch {
      return false;
    }
  });
}"""
"""Sends messages to an embedded page, and returns the parts of its window that can be reached."""


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[tuple[Path, int]]:
    """A folder of pages that are served, and the port."""
    with served_folder(tmp_path) as port:
        yield tmp_path, port


def test_a_page_that_may_embeds_the_viewer_and_others_do_not(
    folder: tuple[Path, int], browser: playwright.Browser
) -> None:
    path, port = folder
    origin = f"http://localhost:{port}"
    with (
        webviz.Viewer(port=0, source=HandFedSource(), embed_in=(origin,), token=True) as viewer,
        webviz.Viewer(port=0, source=HandFedSource(), embed_in=()) as closed,
        contextlib.closing(browser.new_page(viewport=SIZE)) as page,
    ):
        (path / "open.html").write_text(viewer._repr_html_())
        (path / "closed.html").write_text(f"<iframe src={closed.url!r}></iframe>")
        page.goto(f"{origin}/open.html")
        frame = page.wait_for_selector("iframe")
        assert frame is not None
        inside = frame.content_frame()
        assert inside is not None
        inside.wait_for_function("window.webviz?.hasView()", timeout=60_000)
        assert page.evaluate(REACH) == []
        inside.wait_for_function("window.webviz.hasView()")
        page.goto(f"{origin}/closed.html")
        page.wait_for_function("window.length === 1")
        assert all("chrome-error" in each.url for each in page.frames[1:])
        assert "<iframe" not in closed._repr_html_()
        assert closed.url in closed._repr_html_()
    assert "?watch=" in viewer._repr_html_(), "what is saved with a notebook lets nobody act"


@pytest.mark.parametrize("role", [Role.OPERATOR, Role.OWNER])
def test_a_saved_notebook_grants_at_most_watching(role: Role, tmp_path: Path) -> None:
    token = make("me", role, datetime.now(UTC), days=1.0)
    token_file.modify(tmp_path / "tokens.json", lambda _: [token])
    access = Access(True, tmp_path / "tokens.json")
    page = html("http://127.0.0.1:8080/", access, True)
    assert 'src="http://localhost:8080/"' in page
    watcher = make("you", Role.WATCHER, datetime.now(UTC), days=1.0)
    token_file.modify(tmp_path / "tokens.json", lambda tokens: [*tokens, watcher])
    access.refresh()
    assert "?watch=" in html("http://127.0.0.1:8080/", access, True)


def test_a_viewer_in_a_notebook_may_be_embedded_by_it(monkeypatch: pytest.MonkeyPatch) -> None:
    assert embedders(None) == ()
    monkeypatch.setitem(sys.modules, "ipykernel", ModuleType("ipykernel"))
    assert embedders(None) == OF_NOTEBOOKS
    assert embedders(()) == ()
    for wrong in ("http://a b", "http://a; script-src *", "a.org", "'self'"):
        assert "is not the origin of a page" in refusal_of(lambda w=wrong: embedders((w,)))

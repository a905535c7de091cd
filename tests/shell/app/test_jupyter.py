"""A viewer in a cell of a real JupyterLab, in a real browser."""

from __future__ import annotations

import importlib.util
import json
import os
import secrets
import sys
from collections.abc import Iterator
from pathlib import Path

import playwright.sync_api as playwright
import pytest
from program import Program

PARTS = ("jupyterlab", "ipykernel")
MISSING = [name for name in PARTS if importlib.util.find_spec(name) is None]
CELL = """\
import webviz
from webviz.shell.testing.source import HandFedSource

viewer = webviz.Viewer(port=0, source=HandFedSource())
viewer"""

pytestmark = pytest.mark.skipif(
    bool(MISSING), reason=f"{' and '.join(MISSING)} missing: pip install {' '.join(PARTS)}"
)


@pytest.fixture
def notebook(tmp_path: Path) -> Iterator[str]:
    """The address of a notebook with one cell, served by JupyterLab."""
    cell = {"cell_type": "code", "id": "viewer", "metadata": {}, "outputs": []}
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    content = {
        "cells": [{**cell, "execution_count": None, "source": CELL}],
        "metadata": {"kernelspec": kernel},
        "nbformat": 4,
        "nbformat_minor": 5,
    }
    root = tmp_path / "notebooks"
    root.mkdir()
    (root / "viewer.ipynb").write_text(json.dumps(content))
    token = secrets.token_urlsafe()
    places = {f"JUPYTER_{name}_DIR": str(tmp_path / name) for name in ("CONFIG", "DATA", "RUNTIME")}
    options = [
        *("--no-browser", "--port=0", "--ip=127.0.0.1", "--allow-root"),
        *(f"--ServerApp.root_dir={root}", f"--IdentityProvider.token={token}"),
        "--LabApp.news_url=",
        "--LabApp.check_for_updates_class=jupyterlab.NeverCheckForUpdate",
    ]
    server = Program(
        [sys.executable, "-m", "jupyterlab", *options],
        {**os.environ, **places, "IPYTHONDIR": str(tmp_path / "ipython")},
        tmp_path / "log",
    )
    try:
        port = server.wait_for(r"http://127\.0\.0\.1:(\d+)/lab").group(1)
        yield f"http://127.0.0.1:{port}/lab/tree/viewer.ipynb?token={token}"
    finally:
        server.end(15)


def test_the_last_line_of_a_cell_shows_the_scene(
    notebook: str, browser: playwright.Browser, said_on_consoles: list[str]
) -> None:
    context = browser.new_context(viewport={"width": 1000, "height": 900})
    page = context.new_page()
    page.goto(notebook)
    page.locator(".jp-Notebook .jp-CodeCell .cm-content").first.click()
    page.keyboard.press("Shift+Enter")
    frame = page.wait_for_selector(".jp-OutputArea iframe")
    assert frame is not None
    inside = frame.content_frame()
    assert inside is not None
    inside.wait_for_function("window.webviz?.hasView()")
    assert inside.locator("#webviz").count() == 1
    if path := os.environ.get("WEBVIZ_JUPYTER_PICTURE"):
        page.screenshot(path=path)
    context.close()
    said_on_consoles.clear()  # of JupyterLab's own pages

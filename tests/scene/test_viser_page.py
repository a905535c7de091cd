"""viser_page.js is written for the viser that is installed, and nothing else touches its page."""

from __future__ import annotations

import re
from importlib import resources
from pathlib import Path

import playwright.sync_api as playwright
import pytest
import viser

from webviz.edges.scene import ViserScene
from webviz.shell.pictures.browser import Page

FOLDER = Path(str(resources.files("webviz.edges.page"))) / "web"
MODULES = sorted(str(file.relative_to(FOLDER)) for file in FOLDER.rglob("*.js"))


@pytest.fixture
def page(browser: playwright.Browser, server: viser.ViserServer, scene: ViserScene):
    page = Page(browser, f"http://127.0.0.1:{server.get_port()}", 320, 240)
    yield page
    page.close()


MISSING = """async () => {
  const { VISER, missing } = await import("/webviz/viser_page.js");
  return [VISER, missing()];
}"""


def test_visers_page_has_all_that_is_accessed(page: Page) -> None:
    version, lacks = page.evaluate(MISSING)
    assert version == viser.__version__
    assert lacks == []


WITHOUT = """async (names) => {
  const { missing } = await import("/webviz/viser_page.js");
  const whole = window.__viserMutable;
  try {
    window.__viserMutable = { ...whole };
    for (const name of names) delete window.__viserMutable[name];
    return missing();
  } finally {
    window.__viserMutable = whole;
  }
}"""


def test_what_another_viser_lacks_is_reported_with_what_needs_it(page: Page) -> None:
    assert page.evaluate(WITHOUT, ["sendCamera", "messageQueue"]) == [
        "viser's page has no messageQueue.push(), which is needed for controls that go, and "
        "noticing that the server is silent.",
        "viser's page has no sendCamera(), which is needed for telling the server where a camera "
        "is.",
    ]


@pytest.mark.parametrize("name", [name for name in MODULES if name != "viser_page.js"])
def test_only_one_module_touches_visers_page(name: str) -> None:
    assert not re.search(r"__viser|__r3f", (FOLDER / name).read_text())


@pytest.mark.parametrize("name", MODULES)
def test_a_module_is_valid_and_used(name: str, page_of_modules: playwright.Page) -> None:
    """Chromium compiles it, with every name that it imports; and the page has loaded it."""
    assert (
        page_of_modules.evaluate("(name) => import(`/webviz/${name}`).then(() => '', String)", name)
        == ""
    )
    others = "".join((FOLDER / other).read_text() for other in (*MODULES, "head.html"))
    assert re.search(rf"[/\"]{re.escape(Path(name).name)}\"", others)


@pytest.fixture(scope="module")
def page_of_modules(browser: playwright.Browser):
    from webviz.edges.scene import open_server

    server = open_server(port=0)
    context = browser.new_context()
    page = context.new_page()
    page.goto(f"http://127.0.0.1:{server.get_port()}")
    yield page
    context.close()
    server.stop()

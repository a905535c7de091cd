"""viser_page.js is written for the viser that is installed, and nothing else touches its page."""

from __future__ import annotations

import re
from importlib import resources
from pathlib import Path

import viser

from tests.scene.conftest import View

FOLDER = Path(str(resources.files("webviz.page"))) / "web"
FEATURES = FOLDER.parents[1] / "features"
MODULES = sorted(str(file.relative_to(FOLDER)) for file in FOLDER.rglob("*.js"))


MISSING = """async () => {
  const { VISER, missing } = await import("webviz/viser_page.js");
  return [VISER, missing()];
}"""


def test_visers_page_has_all_that_is_accessed(view: View) -> None:
    version, lacks = view.evaluate(MISSING)
    assert version == viser.__version__
    assert lacks == []


WITHOUT = """async (names) => {
  const { missing } = await import("webviz/viser_page.js");
  const whole = window.__viserMutable;
  try {
    window.__viserMutable = { ...whole };
    for (const name of names) delete window.__viserMutable[name];
    return missing();
  } finally {
    window.__viserMutable = whole;
  }
}"""


def test_parts_missing_in_another_viser_are_reported_with_their_purpose(view: View) -> None:
    assert view.evaluate(WITHOUT, ["sendCamera", "messageQueue"]) == [
        "viser's page has no messageQueue.push(), which is needed for controls that go, and "
        "noticing that the server is silent.",
        "viser's page has no sendCamera(), which is needed for telling the server where a camera "
        "is.",
    ]


def test_only_one_module_touches_visers_page() -> None:
    texts = {name: (FOLDER / name).read_text() for name in MODULES}
    touching = {name for name, text in texts.items() if re.search(r"__viser|__r3f", text)}
    assert touching == {"viser_page.js"}


IMPORT = """async (names) => {
  const failures = {};
  for (const name of names) {
    await import(`webviz/${name}`).catch((error) => { failures[name] = String(error); });
  }
  return failures;
}"""


THROW = """async () => {
  const { keyText } = await import("webviz/keys.js");
  try {
    keyText(null);
  } catch (error) {
    return error.stack;
  }
}"""


def test_stack_traces_have_the_names_and_lines_of_modules(view: View) -> None:
    """A release has them by its source map."""
    match = re.search(r"keyText \(.*/webviz/keys\.js:(\d+):\d+\)", view.evaluate(THROW))
    assert match
    line = (FOLDER / "keys.js").read_text("utf-8").splitlines()[int(match[1]) - 1]
    assert "key.length" in line


def test_all_modules_are_valid_and_used(view: View) -> None:
    """Chromium compiles them, with every name that they import; and the page has loaded them."""
    assert view.evaluate(IMPORT, MODULES) == {}
    texts = {name: (FOLDER / name).read_text() for name in (*MODULES, "head.html")}
    texts |= {str(path): path.read_text() for path in FEATURES.rglob("*.js")}
    unused = {
        name
        for name in MODULES
        if not re.search(rf"[/\"]{re.escape(Path(name).name)}\"", "".join(texts.values()))
    }
    assert unused == set()

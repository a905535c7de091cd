"""Controls by themselves, as anything on the page may use them."""

from __future__ import annotations

from typing import Any

import playwright.sync_api as playwright
import pytest

from tests.page.tabs import ViewerTab

MOUNT = """async ([path, name, options]) => {
  const module = await import(`webviz/controls/${path}.js`);
  const { signal } = await import("webviz/signals.js");
  document.querySelector("#bench")?.remove();
  window.entered = [];
  window.refused = [];
  window.answer = undefined;
  const change = (value) => { entered.push(value); return window.answer };
  const refuse = (text) => refused.push(text);
  window.given = { value: signal(options.value), options: signal(options.options) };
  const read = { value: () => given.value.value, options: () => given.options.value };
  const control = module[name]({ ...options, ...read, change, refused: refuse });
  const bench = document.createElement("div");
  bench.id = "bench";
  bench.style = "position: absolute; left: 420px; top: 80px; width: 240px";
  bench.append(control.element);
  document.querySelector("#webviz").append(bench);
}"""


UPDATE = """(changes) => {
  for (const [name, value] of Object.entries(changes)) given[name].value = value;
}"""


class MountedControl:
    """A control on the page, and what was entered there."""

    def __init__(self, tab: ViewerTab) -> None:
        self.page = tab.page
        self.keyboard = tab.page.keyboard
        self._tab = tab

    def mount(self, path: str, name: str, **options: Any) -> None:
        self.page.evaluate(MOUNT, [path, name, options])

    def update(self, **changes: Any) -> None:
        self.page.evaluate(UPDATE, changes)

    def refuse(self, text: str) -> None:
        """Refuse what is entered from now on; "" takes it."""
        answer = {"level": "error" if text else "ok", "text": text}
        self.page.evaluate("(answer) => { window.answer = Promise.resolve(answer) }", answer)

    def field(self, role: Any = "combobox") -> playwright.Locator:
        return self.page.locator("#bench").get_by_role(role)

    def options(self) -> list[str]:
        return self.page.locator("#bench").get_by_role("option").all_inner_texts()

    def entered(self) -> list[Any]:
        return self.page.evaluate("entered")

    def wait_for_text(self, text: str) -> None:
        playwright.expect(self.field()).to_have_value(text)


@pytest.fixture
def bench(viewer_tab: ViewerTab) -> MountedControl:
    return MountedControl(viewer_tab)


FRAMES = [{"value": "base_link"}, {"value": "map", "note": "static"}, {"value": "odom"}]


@pytest.fixture
def frames(bench: MountedControl) -> MountedControl:
    bench.mount("combobox", "combobox", label="Frame", value="map", options=FRAMES)
    return bench


def test_a_click_opens_the_list_and_another_chooses(frames: MountedControl) -> None:
    frames.field().click()
    assert frames.options() == ["base_link", "map\nstatic", "odom"]
    frames.page.get_by_role("option", name="odom").click()
    assert frames.options() == []
    assert frames.entered() == ["odom"]
    frames.update(value="odom")
    frames.wait_for_text("odom")


def test_the_list_is_searched_by_typing_and_walked_by_arrow_keys(frames: MountedControl) -> None:
    frames.field().focus()
    frames.keyboard.type("B")
    assert frames.options() == ["base_link", "“B”\nas typed"]
    frames.keyboard.press("Enter")  # what is marked
    assert frames.entered() == ["base_link"]
    frames.keyboard.press("ArrowDown")
    frames.keyboard.press("ArrowDown")
    frames.keyboard.press("Enter")
    assert frames.entered() == ["base_link", "map"]


def test_the_text_itself_is_below_the_option_that_begins_with_it(frames: MountedControl) -> None:
    frames.field().focus()
    frames.keyboard.type("base_l")
    frames.keyboard.press("ArrowDown")
    frames.keyboard.press("Enter")
    assert frames.entered() == ["base_l"]


def test_any_text_may_be_typed(frames: MountedControl) -> None:
    frames.field().fill("camera")
    assert frames.options() == []
    frames.keyboard.press("Enter")
    assert frames.entered() == ["camera"]
    frames.field().fill("tool0")
    frames.keyboard.press("Tab")
    assert frames.entered() == ["camera", "tool0"]


def test_where_only_options_count_the_first_that_fits_is_taken(bench: MountedControl) -> None:
    bench.mount("combobox", "combobox", label="Frame", value="map", options=FRAMES, free=False)
    bench.field().fill("od")
    bench.keyboard.press("Enter")
    assert bench.entered() == ["odom"]
    bench.update(value="odom")
    bench.field().fill("nothing")
    bench.keyboard.press("Enter")
    bench.wait_for_text("odom")
    assert bench.entered() == ["odom"]


def test_escape_goes_back(frames: MountedControl) -> None:
    frames.field().fill("came")
    frames.keyboard.press("Escape")
    frames.wait_for_text("map")
    frames.keyboard.press("Tab")
    assert frames.entered() == []


def test_what_is_refused_stays_for_correction(frames: MountedControl) -> None:
    frames.refuse("Not changed: no such frame.")
    frames.field().fill("came")
    frames.keyboard.press("Enter")
    frames.page.wait_for_function("refused.at(-1) === 'Not changed: no such frame.'")
    frames.update(value="map")
    frames.wait_for_text("came")
    assert frames.field().get_attribute("aria-invalid") == "true"
    frames.keyboard.press("Escape")
    frames.wait_for_text("map")
    assert frames.page.evaluate("refused.at(-1)") == ""


def test_what_somebody_else_changes_waits_while_one_types(frames: MountedControl) -> None:
    frames.field().focus()
    frames.keyboard.type("x")
    frames.update(value="odom", options=[*FRAMES, {"value": "x1"}])
    assert frames.field().input_value() == "x"
    assert frames.options() == ["x1", "“x”\nas typed"]
    frames.keyboard.press("Escape")
    frames.wait_for_text("odom")


def test_very_many_options_are_not_all_made(bench: MountedControl) -> None:
    options = [{"value": f"frame_{number}"} for number in range(5000)]
    bench.mount("combobox", "combobox", label="Frame", value="", options=options)
    bench.field().click()
    assert len(bench.options()) == 100
    assert "4900 more" in bench.page.locator("#bench").inner_text()
    bench.field().fill("4999")
    assert bench.options() == ["frame_4999"]


def test_untrusted_names_are_text(bench: MountedControl) -> None:
    name = "<img src=x onerror=alert(1)>"
    bench.mount("combobox", "combobox", label=name, value=name, options=[{"value": name}])
    bench.field().click()
    assert bench.options() == [name]

"""The properties of one display, beside the panel."""

from __future__ import annotations

from operator import attrgetter
from typing import Any

import msgspec
import playwright.sync_api as playwright

from tests.page.tabs import ViewerTab
from webviz.commands import SetProperty

MOUNT = """async (id) => {
  const { globalOptions, propertiesOf } = await import("webviz/panels/displays/properties.js");
  const { root } = await import("webviz/signals.js");
  const bench = document.createElement("div");
  bench.id = "bench";
  bench.style = "position: absolute; left: 420px; top: 40px; width: 340px";
  document.querySelector("#webviz").append(bench);
  window.ended = root((end) => {
    bench.append(...(id ? propertiesOf(id) : globalOptions()));
    return () => {
      end();
      bench.replaceChildren();
    };
  });
}"""
"""Show the properties of a display, or of the whole viewer for \"\"."""


class PropertiesPane:
    """The properties of the display "a"."""

    def __init__(self, tab: ViewerTab) -> None:
        self.tab = tab
        self.viewer = tab.viewer
        self.page = tab.page
        self.keyboard = tab.page.keyboard
        self.element = tab.page.locator("#bench")

    def mount(self) -> PropertiesPane:
        self.page.evaluate(MOUNT, self.viewer.id("a"))
        self.tab.wait_for(lambda: self.element.locator(".wv-property").count() > 0)
        return self

    def row(self, path: str) -> playwright.Locator:
        return self.element.locator(f"[data-path='{path}']")

    def field(self, path: str) -> playwright.Locator:
        return self.row(path).locator("input, select, textarea").first

    def enter(self, path: str, text: str, key: str = "Enter") -> None:
        self.field(path).fill(text)
        self.keyboard.press(key)

    def wait_for_set(self, path: str, value: Any) -> None:
        """Wait until this was the last that a page has set, and the display has it."""
        self.tab.wait_for_command(SetProperty(self.viewer.id("a"), path, value))
        display = self.viewer.display_named("a")
        assert msgspec.json.decode(msgspec.json.encode(attrgetter(path)(display))) == value

    def change(self, **values: Any) -> None:
        """Have a program set properties."""
        for path, value in values.items():
            self.viewer.do(SetProperty(self.viewer.id("a"), path, value))

    def wait_for_value(self, path: str, text: str) -> None:
        self.tab.wait_for(lambda: self.field(path).input_value() == text)

    def labels(self) -> list[str]:
        return self.element.locator(".wv-property-label:visible").all_inner_texts()

    def text(self) -> str:
        return self.element.inner_text()

"""Cards over the scene: they share one stack, and cover neither each other nor the legend."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.page.page_bench import SCAN, PageBench
from tests.page.tabs import ViewerTab
from webviz.shell.testing.messages import header
from webviz_displays.laser_scan import LaserScan

STACK = ".wv-stack"
SHOW = """async () => {
  const { overlay } = await import("webviz/overlay/overlay.js");
  const { toast } = await import("webviz/toasts.js");
  for (const name of ["request", "file", "upload"]) {
    const card = document.createElement("section");
    card.className = "wv-card";
    card.textContent = `${name} `.repeat(30);
    overlay("cards", `test ${name}`, card);
  }
  toast("Something was saved.");
}"""
HIDE = """async () => {
  const { overlay } = await import("webviz/overlay/overlay.js");
  for (const name of ["request", "file", "upload"]) {
    const none = document.createElement("section");
    none.hidden = true;
    overlay("cards", `test ${name}`, none);
  }
}"""
COVERED = """() => {
  const all = [...document.querySelectorAll(
    ".wv-stack > :not([hidden]), .wv-legend, .wv-scale, .wv-gizmo, .wv-toast, .wv-toolbar",
  )].filter((one) => one.checkVisibility());
  const stack = document.querySelector(".wv-stack").getBoundingClientRect();
  const boxOf = (one) => {
    const { left, right, top, bottom } = one.getBoundingClientRect();
    if (!one.matches(".wv-stack > *")) return { left, right, top, bottom };
    return { left, right, top: Math.max(top, stack.top), bottom: Math.min(bottom, stack.bottom) };
  };
  const meet = (a, b) =>
    a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
  return all.flatMap((one, i) =>
    all.slice(i + 1).filter((other) => meet(boxOf(one), boxOf(other)))
      .map((other) => `${one.className.baseVal ?? one.className} ${other.className}`));
}"""


@pytest.fixture
def scene(viewer: PageBench, viewer_tab: ViewerTab) -> Iterator[ViewerTab]:
    """The tab with a scan, whose intensities have a legend."""
    tab, size = viewer_tab, viewer_tab.page.viewport_size
    viewer.show(LaserScan(name="Scan"))
    measured = {"range_max": 10.0, "ranges": [1.0, 2.0], "intensities": [0.0, 1.0]}
    viewer.publish("/scan", SCAN, {"header": header("map", viewer.source.now), **measured})
    tab.wait_for(lambda: tab.page.locator(".wv-legend").count() == 1)
    yield tab
    tab.page.evaluate(HIDE)
    assert size is not None
    tab.page.set_viewport_size(size)


@pytest.mark.parametrize("size", [(1600, 900), (1280, 720), (900, 800)])
def test_cards_cover_neither_each_other_nor_the_legend(
    scene: ViewerTab, size: tuple[int, int]
) -> None:
    scene.page.set_viewport_size({"width": size[0], "height": size[1]})
    scene.page.evaluate(SHOW)
    scene.wait_for(lambda: scene.page.locator(f"{STACK} > .wv-card").count() >= 3)
    assert scene.page.evaluate(COVERED) == []

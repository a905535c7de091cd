"""Consistency of movement by pose and by data, however slow the page."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from tests.scene.conftest import View, floats
from webviz.api.nodes import Arrows, Axes, Instances, Labels, Lines, Mesh, Node, Points, Pose

CORNERS = np.array([(-0.3, -0.2, 0), (0.3, -0.2, 0), (0, 0.3, 0)], np.float32)
YELLOW = (255, 255, 0)
STEP_M = 0.2
PICTURES = 12


def nodes_at(x: float) -> dict[str, Node]:
    """Return a node of each kind that is sent in coordinates of the fixed frame, a row each."""
    return {
        "points": Points(floats((x, 2, 0), (x + 0.3, 2, 0)), YELLOW, 0.4),
        "lines": Lines(floats(((x, 1, 0), (x + 0.5, 1, 0))), YELLOW, 8.0),
        "arrows": Arrows(floats(((x, 0, 0), (x + 0.5, 0, 0))), YELLOW, 0.1, 0.2, 0.3),
        "axes": Axes(floats((x, -1, 0)), floats((1, 0, 0, 0)), 0.4, 0.1),
        "instances": Instances(floats((x, -2, 0)), floats((0.4, 0.4, 0.4)), YELLOW),
        "labels": Labels(floats((x, -3, 0)), ("M",), 0.6),
    }


WATCH = """() => {
  const {canvas, requestRender} = window.__viserMutable;
  const copy = document.createElement("canvas");
  copy.width = canvas.width; copy.height = canvas.height;
  const image = copy.getContext("2d", {willReadFrequently: true});
  window.pictures = [];
  window.watching = true;
  (function watch() {
    if (!window.watching) return;
    image.drawImage(canvas, 0, 0);
    const {data} = image.getImageData(0, 0, canvas.width, canvas.height);
    const rows = [];
    for (let row = 0; row < BANDS; row++) {
      const [top, bottom] = [row, row + 1].map((n) => Math.floor((n * canvas.height) / BANDS));
      let [count, sum] = [0, 0];
      for (let y = top; y < bottom; y++) for (let x = 0; x < canvas.width; x++) {
        const i = 4 * (y * canvas.width + x);
        if (data[i] !== data[0] || data[i + 1] !== data[1] || data[i + 2] !== data[2]) {
          count += 1; sum += x;
        }
      }
      rows.push(count ? sum / count : -1);
    }
    window.pictures.push(rows);
    requestRender();
    requestAnimationFrame(watch);
  })();
}"""


@pytest.mark.parametrize("slower", [1, 8])
def test_poses_and_data_are_seen_in_the_same_picture(view: View, slower: int) -> None:
    def show(x: float) -> None:
        view.scene.set_pose("robot", Pose((x, 3.0, 0.0)))
        for key, node in nodes_at(x).items():
            view.scene.upsert("data", key, node)
        view.scene.flush()

    view.scene.upsert("robot", "link", Mesh(CORNERS, np.array([[0, 1, 2]], np.uint32), YELLOW))
    view.look((0.0, -0.001, 8.6), (0.0, 0.0, 0.0))
    show(0.0)
    view.show()
    chrome = view.tab.context.new_cdp_session(view.tab)
    chrome.send("Emulation.setCPUThrottlingRate", {"rate": slower})
    view.evaluate(WATCH.replace("BANDS", str(len(nodes_at(0.0)) + 1)))
    is_visible = "() => window.pictures.at(-1)?.every((middle) => middle >= 0)"
    view.wait_for(lambda: view.evaluate(is_visible), "everything", 60)
    view.evaluate("() => { window.pictures.length = 0; }")
    steps = itertools.count(1)

    def goes_on() -> bool:
        show(STEP_M * (next(steps) % 12 - 6))
        return view.evaluate("() => window.pictures.length") > PICTURES

    view.wait_for(goes_on, "pictures on the way", 60)
    pictures = view.evaluate("() => { window.watching = false; return window.pictures; }")
    chrome.send("Emulation.setCPUThrottlingRate", {"rate": 1})
    chrome.detach()
    middles = np.array(pictures)
    assert (middles >= 0).all(), "something was not to be seen"
    assert np.ptp(middles[:, 0]) > 20, "the robot drove"
    apart = middles - middles[:, :1]
    assert np.ptp(apart, axis=0) == pytest.approx(0.0, abs=2.0)

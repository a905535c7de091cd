"""Contents of a real browser: no more than what is shown."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from pages import let_keys_in

from tests.scene.conftest import View, floats
from webviz.api.nodes import Arrows, Axes, Image, Labels, Lines, Mesh, Node, Points

TRIANGLE = np.eye(3, dtype=np.float32)


EVERYTHING: dict[str, Callable[[int], Node]] = {
    "points": lambda n: Points(floats((0, 0, n)), np.full((1, 3), n, np.uint8), 0.1),
    "lines": lambda n: Lines(floats(((0, 0, 0), (1, 0, n))), (n, 0, 0)),
    "arrows": lambda n: Arrows(floats(((0, 0, 0), (1, 0, n))), (n, 0, 0), 0.1, 0.2, 0.3),
    "axes": lambda n: Axes(floats((0, 0, n)), floats((1, 0, 0, 0)), 1.0, 0.1),
    "labels": lambda n: Labels(floats((0, 0, n)), (f"{n % 10}",), 0.1),
    "mesh": lambda n: Mesh(TRIANGLE * (1 + n), np.array([[0, 1, 2]], np.uint32), (n, 0, 0)),
    "image": lambda n: Image(np.full((4, 4, 4), n, np.uint8), 1.0, 1.0),
}


def resources(view: View) -> dict[str, int]:
    return view.evaluate(
        """() => {
          const info = window.__viserTestpoints.rendererInfo;
          return {...info.memory, programs: info.programs.length};
        }"""
    )


def test_forty_updates_take_no_more_of_the_graphics_card_than_ten(view: View) -> None:
    counts = []
    for n in range(40):
        for key, make in EVERYTHING.items():
            view.scene.upsert("base_link", key, make(n))
        view.scene.flush()
        view.draw(1)
        if n in (9, 39):
            view.show()
            view.draw(5)
            counts.append(resources(view))
    assert counts[1] == counts[0]


def test_removed_nodes_leave_nothing_in_the_page(view: View) -> None:
    view.show()
    nodes, before = view.nodes(), resources(view)
    for n in range(3):
        for key, make in EVERYTHING.items():
            view.scene.upsert("base/link", key, make(n))
        view.show()
        assert len(view.nodes()) > len(nodes)
        view.scene.remove_group("base/link")
        view.show()
        assert view.nodes() == nodes
    assert resources(view)["geometries"] <= before["geometries"] + 2  # viser's shared shapes


def test_the_camera_does_not_walk_by_keys_with_ctrl(view: View) -> None:
    let_keys_in(view)
    before = view.evaluate("() => window.__viserMutable.camera.position.toArray()")
    view.tab.keyboard.press("Control+e", delay=300)
    view.draw()
    assert view.evaluate("() => window.__viserMutable.camera.position.toArray()") == before
    view.tab.keyboard.press("e", delay=300)
    view.draw()
    assert view.evaluate("() => window.__viserMutable.camera.position.toArray()") != before

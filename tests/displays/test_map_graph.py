"""The display of RTAB-Map's graph."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from inspecting import Benches
from mapping_scenes import GRAPH
from plain_scenes import in_moving_frame

from webviz.shell.testing import check_details
from webviz_displays.map_graph import MapGraph


def test_links_have_the_colours_of_their_types(display_bench: Callable) -> None:
    at = display_bench(MapGraph(), GRAPH)
    np.testing.assert_allclose(at.xyz("links")[0], [(10, 0, 0), (11, 0, 0)], atol=1e-6)
    display = MapGraph()
    expected = [
        *(display.neighbor, display.merged_neighbor, display.global_loop_closure),
        *(display.local_loop_closure, display.user, display.virtual, display.landmark),
    ]
    assert at.nodes()["links"].colors[:, 0].tolist() == list(map(list, expected))
    assert at.statuses()["Graph"] == ("OK", "4 poses, 7 links.")


@pytest.mark.parametrize(
    ("change", "level", "sentence"),
    [
        ({"poses_id": [1, 2, 3]}, "ERROR", "4 poses for 3 ids. Fix the publisher."),
        (
            {"poses_id": [1, 2, 3, 9]},
            "WARN",
            "4 poses, 6 links; 1 left out: their poses are missing or invalid.",
        ),
        (
            {"links": []},
            "WARN",
            "4 poses, 0 links: nothing to draw. Wait until the robot has moved.",
        ),
    ],
)
def test_skipped_nodes_and_links_are_reported(
    change: dict[str, Any], level: str, sentence: str, display_bench: Callable
) -> None:
    at = display_bench(MapGraph(), GRAPH | change)
    assert at.statuses()["Graph"] == (level, sentence)


def test_alpha_0_hides_and_types_of_later_versions_are_drawn(display_bench: Callable) -> None:
    at = display_bench(MapGraph(), {**GRAPH, "links": [{"from_id": 1, "to_id": 2, "type": 99}]})
    assert at.nodes()["links"].colors[0, 0].tolist() == [255, 0, 0]
    at.set("alpha", 0.0)
    assert at.nodes() == {}
    assert "alpha is 0" in at.statuses()["Graph"][1]


class TestMapGraph(BuiltInChecks):
    display = MapGraph
    scene = in_moving_frame("rtabmap_msgs/msg/MapGraph", GRAPH)


def test_selecting_link_of_a_graph(turned: Benches) -> None:
    check_details(
        turned(MapGraph(), GRAPH).pick("links", 3),
        "Link 1 to 3",
        {"Type": "2, local loop closure"},
    )

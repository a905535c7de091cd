"""Statistics and loops of RTAB-Map as statuses."""

from __future__ import annotations

from built_in_checks import BuiltInChecks
from inspecting import Benches
from plain_scenes import in_moving_frame
from rtabmap_scenes import CLOSED, INFO

from webviz_displays.map_info import MapInfo


def test_loops_are_counted_and_statistics_are_statuses(bench: Benches) -> None:
    at = bench(MapInfo())
    near = CLOSED | {"loop_closure_id": 0, "proximity_detection_id": 5}
    for values in (CLOSED, near, CLOSED):
        at.send(INFO, values, frame="map")
    at.turn()
    statuses = at.statuses()
    assert statuses["Info"] == ("OK", "12 closes a loop with 3.")
    assert statuses["Loop closures"] == ("OK", "2 loop closures so far.")
    assert statuses["Proximity detections"] == ("OK", "1 detection so far.")
    assert statuses["Position"] == ("OK", "x 0.500, y 0.000, z 0.000 m.")
    assert statuses["Timing/Total/ms"] == ("OK", "41.25")
    assert statuses["Loop/Accepted_hypothesis_id"] == ("OK", "3")
    assert {level for level, _ in statuses.values()} == {"OK"}


def test_statistics_without_values_are_an_error(bench: Benches) -> None:
    at = bench(MapInfo())
    at.send(INFO, {"ref_id": 4, "stats_keys": ["a", "b"], "stats_values": [1.0]}, frame="map")
    at.turn()
    statuses = at.statuses()
    assert statuses["Info"] == ("OK", "Node 4, no loop.")
    assert statuses["Statistics"] == ("ERROR", "1 values for 2 names. Fix the publisher.")
    assert "Position" not in statuses


class TestMapInfo(BuiltInChecks):
    display = MapInfo
    scene = in_moving_frame(INFO, CLOSED)

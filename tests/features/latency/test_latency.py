"""Latencies of displays, measured while a page shows them."""

from __future__ import annotations

import numpy as np
import pytest
from bench import Bench, Benches

from webviz.commands import InspectLatency
from webviz.features import latency
from webviz.features.latency import percentiles, slowest_link
from webviz.features.latency.stages import Latency
from webviz_displays.poses import Pose

S = 1_000_000_000


def measured(b: Bench) -> tuple[Latency, ...]:
    return b.viewer.state().latencies


def test_samples_are_traced_only_on_request(
    bench: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(latency, "EVERY_S", 0.0)
    b = bench(Pose())
    b.transform("map", "base", S, static=True)

    def draw(number: int) -> None:
        b.pose("/goal_pose", "base", number * S)
        b.turn()

    draw(1)
    assert measured(b) == ()
    b.do(InspectLatency())
    for number in range(2, 6):
        measured(b)
        draw(number)
    (display_latency,) = measured(b)
    assert display_latency.samples == 4
    names = [stage.name for stage in display_latency.stages]
    assert names[-4:] == ["ready", "decoded", "drawn", "sent"]
    assert all(0.0 <= stage.p50 <= stage.p99 for stage in display_latency.stages[-4:])
    ends = [stage.begin + stage.p50 for stage in display_latency.stages]
    assert [stage.begin for stage in display_latency.stages[1:]] == pytest.approx(ends[:-1])
    assert display_latency.waits_for == ""
    assert display_latency.core > 0.0, "it was drawn since"
    b.do(InspectLatency(is_wanted=False))
    draw(6)
    assert measured(b) == ()
    b.do(InspectLatency())
    draw(7)
    assert measured(b)[0].samples == 1, "it began anew"


def test_a_sample_that_waits_names_the_transform(
    bench: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(latency, "EVERY_S", 0.0)
    monkeypatch.setattr(latency, "LONG_S", 0.0)
    b = bench(Pose())
    for number in range(11):
        b.transform("map", "odom", S + number * S // 5)
        b.transform("odom", "base", S + number * S // 10)
    b.do(InspectLatency())
    measured(b)
    b.pose("/goal_pose", "base", 2 * S + S // 20)
    b.turn()
    assert measured(b) == (), "it has no transform yet"
    b.transform("odom", "base", 2 * S + S // 10)
    b.turn()
    (display_latency,) = measured(b)
    assert display_latency.waits_for.startswith("Waits ")
    assert display_latency.waits_for.endswith(" ms for odom to base at 10 Hz.")


def test_the_link_whose_newest_transform_is_oldest_is_the_slowest(bench: Benches) -> None:
    b = bench(Pose())
    b.transform("map", "odom", 4 * S)
    b.transform("odom", "base", 5 * S)
    b.transform("base", "laser", S, static=True)
    b.turn()
    assert slowest_link(b.viewer.buffer, "map", "laser") == "map to odom"
    assert slowest_link(b.viewer.buffer, "odom", "laser") == "odom to base"
    assert slowest_link(b.viewer.buffer, "base", "laser") == ""
    assert slowest_link(b.viewer.buffer, "nowhere", "laser") == "map to odom"


def test_percentiles_are_values_that_occurred() -> None:
    values = np.arange(100.0, 0.0, -1.0)[:, None]
    assert percentiles(values) == ([50.0], [99.0])
    assert percentiles(np.array([[3.0, 4.0]])) == ([3.0, 4.0], [3.0, 4.0])

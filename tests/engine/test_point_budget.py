"""Clouds share the points that browsers hold."""

from __future__ import annotations

import pytest

from webviz.engine.pipeline.point_budget import PointBudget


@pytest.mark.parametrize(
    ("requests", "limits"),
    [
        ({"a": 10}, {"a": 1000}),
        ({"a": 5000}, {"a": 1000}),
        ({"a": 5000, "b": 7000}, {"a": 500, "b": 500}),
        ({"a": 100, "b": 7000, "c": 8000}, {"a": 450, "b": 450, "c": 450}),
        ({"a": 100, "b": 500}, {"a": 500, "b": 900}),
        ({str(i): 10**6 for i in range(3000)}, {"7": 1}),
    ],
)
def test_small_displays_get_their_points_and_the_others_share_the_rest(
    requests: dict[str, int], limits: dict[str, int]
) -> None:
    budget = PointBudget(lambda: 1000)
    for display, count in requests.items():
        budget.share(display, count)
    assert {each: budget.share(each, requests[each]) for each in limits} == limits


def test_a_limit_stays_while_the_sizes_of_other_clouds_vary_a_little() -> None:
    budget = PointBudget(lambda: 400_000)
    limits = set()
    for other in range(20_100, 20_200):
        budget.share("scan", other)
        limits.add(budget.share("lidar", 10**6))
    assert limits == {370_000}


def test_the_points_of_a_removed_display_are_shared() -> None:
    budget = PointBudget(lambda: 1000)
    budget.share("a", 5000)
    budget.share("b", 5000)
    budget.leave("a")
    assert budget.share("b", 5000) == 1000

"""Checks that displays of other packages inherit: a sound display passes, faults are found."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import pytest

from webviz import Context, Display, Input, Prop, Sample, Topic
from webviz.shell.testing.display_checks import changes
from webviz.testing import DisplayChecks

FAR = 1e6
POINT = "geometry_msgs/msg/PointStamped"


class Spot(Display):
    """A point of a message."""

    topic: Annotated[Topic, Input(POINT)] = Topic("/spot")
    size: Annotated[float, Prop(ge=0.01, help="Diameter in metres.")] = 0.5
    is_ignored: Annotated[bool, Prop(help="Nothing.")] = False

    def draw(self, sample: Sample, ctx: Context) -> None:
        point = sample.message.point
        xyz = (point.x, point.y, point.z)
        if all(abs(each) < FAR for each in xyz):
            ctx.points("spot", [xyz], (0, 0, 255), self.size)
        else:
            self.refuse(ctx)

    def refuse(self, ctx: Context) -> None:
        ctx.error("Point", "The point is not a measurement. Check its publisher.")


class TestSpot(DisplayChecks):
    display = Spot
    messages = {POINT: {"point": {"x": 1.0}}}  # noqa: RUF012
    elsewhere = ("is_ignored",)


def test_a_property_without_effect_is_found(
    webviz_bench: Callable[..., Any], tmp_path: Path
) -> None:
    ignored = next(each for each in changes(Spot) if each.path == "is_ignored")
    with pytest.raises(AssertionError, match="True shows as False does"):
        TestSpot().test_every_property_changes_what_is_drawn_or_reported(
            webviz_bench, ignored, tmp_path
        )


class SilentSpot(Spot):
    """Ignores what is far away, and says nothing."""

    def refuse(self, ctx: Context) -> None:
        pass


def test_a_value_that_is_ignored_in_silence_is_found(
    webviz_bench: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(AssertionError, match="nothing is drawn"):
        TestSpot().test_an_extreme_value_is_neither_drawn_as_nonsense_nor_ignored_in_silence(
            webviz_bench, SilentSpot, "topic", monkeypatch
        )

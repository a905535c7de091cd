"""Features without a viewer, which show what a test gives them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from types import SimpleNamespace
from typing import Any, TypeVar

from webviz import commands
from webviz.engine.commands import Command
from webviz.engine.feature import Feature
from webviz.engine.parts.part import Part
from webviz.features.bridges import BridgesFeature
from webviz.features.driving import DrivingFeature
from webviz.features.goals import GoalsFeature
from webviz.features.handles import HandlesFeature
from webviz.features.selection import SelectionFeature
from webviz.features.tools import ToolsFeature
from webviz.features.topics import TopicsFeature
from webviz.features.transforms import TransformsFeature

P = TypeVar("P", bound=Part)


def stand_in(kind: type[P], **given: Any) -> P:
    """Return a part some of whose attributes and methods are these."""
    made = object.__new__(kind)
    vars(made).update(given)
    return made


def stand_ins(
    given: Callable[[str, Any], Any], steer: Callable[..., Any], do: Callable[[Command], object]
) -> Sequence[Feature]:
    """Return features that show the public fields which a test gives.

    Args:
        given: returns one by its name, or another value without it.
        steer: takes set-points of vehicles.
        do: takes commands that follow from the stores which pages watch.
    """
    tools = SimpleNamespace(usable=lambda: {each.id: each.tool for each in given("tools", ())})
    return [
        stand_in(BridgesFeature, links=lambda: tuple(given("bridges", ()))),
        stand_in(
            TopicsFeature,
            inspection=lambda topic: given("inspected", {}).get(topic),
            _last={},
            _inspected=set,
            inspect_topics=lambda topics: do(commands.InspectTopics(topics)),
        ),
        stand_in(
            TransformsFeature,
            tree=lambda: given("transforms", None),
            transform_between=lambda pair: given("between", {}).get(pair),
            _requested=tuple,
            inspect_transforms=lambda *looked_at: do(commands.InspectTransforms(*looked_at)),
        ),
        stand_in(HandlesFeature, found=lambda: given("handles", {}), _shown=None),
        stand_in(GoalsFeature, progress=lambda: given("goals", ())),
        stand_in(DrivingFeature, vehicles=lambda: given("driving", {}), steer=steer),
        stand_in(
            SelectionFeature,
            core=SimpleNamespace(get=lambda kind: SimpleNamespace(rows=())),
            _selections={},
            inspect_selections=lambda *looked_at: do(commands.InspectSelections(*looked_at)),
        ),
        stand_in(ToolsFeature, list=tools, buttons=lambda: given("tools", ())),
    ]

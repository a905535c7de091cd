"""Views of .rviz files: the current one and the saved ones, there and back."""

from __future__ import annotations

import textwrap
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ruamel.yaml import YAML

from webviz.api.views import (
    FPS,
    FrameAligned,
    Orbit,
    ThirdPersonFollower,
    TopDownOrtho,
    View,
    XYOrbit,
)
from webviz.files import rviz
from webviz.files.config import Config, Settings

NUMBERS = st.floats(-1000, 1000, width=32).map(lambda number: float(f"{number:.4g}"))
POINTS = st.tuples(NUMBERS, NUMBERS, NUMBERS)
FRAMES = st.sampled_from(["<Fixed Frame>", "base_link", "a/b c"])
DISTANCES = st.floats(0.125, 1000, width=32).map(lambda number: float(f"{number:.4g}"))
PITCHES = st.floats(-1.5, 1.5, width=32).map(lambda number: float(f"{number:.4g}"))


def around(cls: Any) -> st.SearchStrategy[View]:
    return st.builds(
        cls,
        target_frame=FRAMES,
        distance=DISTANCES,
        yaw=NUMBERS,
        pitch=PITCHES,
        focal_point=POINTS,
        invert_z_axis=st.booleans(),
    )


VIEWS = st.one_of(
    around(Orbit),
    around(XYOrbit),
    around(ThirdPersonFollower),
    st.builds(FPS, target_frame=FRAMES, yaw=NUMBERS, pitch=PITCHES, position=POINTS),
    st.builds(
        FrameAligned,
        target_frame=FRAMES,
        yaw=NUMBERS,
        pitch=PITCHES,
        position=POINTS,
        point_towards=st.sampled_from(["arbitrary", "-z axis", "+y axis"]),
        lock_camera=st.booleans(),
        invert_z_axis=st.booleans(),
    ),
    st.builds(
        TopDownOrtho, target_frame=FRAMES, scale=DISTANCES, angle=NUMBERS, x=NUMBERS, y=NUMBERS
    ),
)


def read_views(views: str) -> tuple[Config, rviz.Report]:
    """A file with these keys of "Views"."""
    head = "Visualization Manager:\n  Views:\n"
    return rviz.read(head + textwrap.indent(textwrap.dedent(views), "    "), "x.rviz")


def current(view: str) -> tuple[View, str]:
    """The current view of a file, and what is told of it."""
    config, report = read_views(f"Current: {view}\n")
    return config.settings.view, "\n".join(report.sentences())


def exported(config: Config) -> dict[str, Any]:
    """Return the exported "Views" section."""
    text = rviz.write(config)[0]
    return YAML(typ="safe").load(text)["Visualization Manager"]["Views"]


@pytest.mark.parametrize(
    ("text", "view"),
    [
        (
            "{Class: rviz_default_plugins/Orbit, Distance: 3.5, Yaw: 1.5, "
            "Pitch: 1.5697963237762451, Focal Point: {X: 1, Y: 2, Z: 3}}",
            Orbit(distance=3.5, yaw=1.5, pitch=1.5697963, focal_point=(1.0, 2.0, 3.0)),
        ),
        ("{Distance: 3.5}", Orbit(distance=3.5)),
        ("{Class: rviz/XYOrbit, Yaw: -1}", XYOrbit(yaw=-1.0)),
        (
            "{Class: rviz_default_plugins/ThirdPersonFollower, Target Frame: base_link}",
            ThirdPersonFollower(target_frame="base_link"),
        ),
        (
            "{Class: rviz_default_plugins/FPS, Position: {X: 1, Y: 2, Z: 3}, Pitch: 0.5}",
            FPS(position=(1.0, 2.0, 3.0), pitch=0.5),
        ),
        (
            "{Class: rviz_default_plugins/TopDownOrtho, Scale: -40, X: 5, Y: -1, Angle: 0.5}",
            TopDownOrtho(scale=40.0, x=5.0, y=-1.0, angle=0.5),
        ),
        ("{Distance: 3.5, Invert Z Axis: true}", Orbit(distance=3.5, invert_z_axis=True)),
        (
            "{Class: rviz_default_plugins/FrameAligned, Target Frame: camera, Yaw: 1.5, Pitch: -1, "
            "Position: {X: 1, Y: 2, Z: 3}, Point towards: -z axis, Lock Camera: true, "
            "Invert Z Axis: true}",
            FrameAligned(
                target_frame="camera",
                yaw=1.5,
                pitch=-1.0,
                position=(1.0, 2.0, 3.0),
                point_towards="-z axis",
                lock_camera=True,
                invert_z_axis=True,
            ),
        ),
        # RViz hides the switch in these views, which ignore it.
        ("{Class: rviz_default_plugins/FPS, Invert Z Axis: true}", FPS()),
        ("{Class: rviz_default_plugins/TopDownOrtho, Invert Z Axis: true}", TopDownOrtho()),
    ],
)
def test_each_view_of_rviz_is_the_same_here(text: str, view: View) -> None:
    assert current(text) == (view, "")


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (
            "{Class: some_plugins/Spiral, Target Frame: base_link}",
            "some_plugins/Spiral: unsupported view type",
        ),
        (
            "{Distance: far}",
            "current view: Distance: expected a number, got `far`; using the default",
        ),
        ("{Focal Point: 1}", "Focal Point: it needs X, Y, Z; using the default"),
        (
            "{Invert Z Axis: perhaps}",
            "Invert Z Axis: expected true or false, got `perhaps`; using the default",
        ),
    ],
)
def test_unsupported_values_of_a_view_are_reported(text: str, sentence: str) -> None:
    view, sentences = current(text)
    assert view == Orbit()
    assert sentence in sentences


VIEWS_FILE = """\
Current: {Class: rviz_default_plugins/Orbit, Focal Shape Size: 0.1}
Saved:
  - {Class: rviz_default_plugins/Orbit, Name: Corner, Distance: 2.5, Near Clip Distance: 0.1}
  - {Class: some_plugins/Spiral, Name: Odd, Yaw: 1}
  - {Class: rviz_default_plugins/TopDownOrtho, Name: Corner, Scale: 30}
"""


def test_saved_views_are_carried_over_by_name() -> None:
    config, report = read_views(VIEWS_FILE)
    assert config.settings.views == {
        "Corner": Orbit(distance=2.5),
        "Corner 2": TopDownOrtho(scale=30.0),
    }
    assert (report.carried["views"], report.total["views"]) == (3, 4)
    assert "saved view Odd: some_plugins/Spiral" in "\n".join(report.sentences())


def test_unchanged_saved_views_are_written_as_they_were() -> None:
    view_table = exported(read_views(VIEWS_FILE)[0])["Saved"]
    assert view_table == YAML(typ="safe").load(VIEWS_FILE)["Saved"]


def test_a_changed_view_keeps_foreign_values() -> None:
    config, _ = read_views(VIEWS_FILE)
    config.settings.views |= {"Corner": Orbit(distance=7.0), "New": FPS(yaw=1.0)}
    del config.settings.views["Corner 2"]
    first, odd, new = exported(config)["Saved"]
    assert (first["Distance"], first["Near Clip Distance"], first["Name"]) == (7, 0.1, "Corner")
    assert odd["Name"] == "Odd"
    assert (new["Class"], new["Name"], new["Yaw"]) == ("rviz_default_plugins/FPS", "New", 1)
    config.settings.views["Corner"] = TopDownOrtho()
    assert "Distance" not in exported(config)["Saved"][0]


def test_a_view_of_another_type_keeps_nothing_of_the_one_before() -> None:
    config, _ = read_views(VIEWS_FILE)
    assert exported(config)["Current"]["Focal Shape Size"] == 0.1
    config.settings.view = TopDownOrtho(scale=20.0)
    tree = exported(config)["Current"]
    assert (tree["Class"], tree["Scale"]) == ("rviz_default_plugins/TopDownOrtho", 20)
    assert "Focal Shape Size" not in tree


def test_a_view_without_counterpart_is_kept_until_another_is_chosen() -> None:
    text = "Current: {Class: some_plugins/Spiral, Name: Current View, Yaw: 1}\n"
    config, _ = read_views(text)
    assert exported(config)["Current"] == YAML(typ="safe").load(text)["Current"]
    config.settings.view = Orbit(distance=3.0)
    assert exported(config)["Current"]["Class"] == "rviz_default_plugins/Orbit"


@settings(deadline=None)
@given(VIEWS, st.dictionaries(st.sampled_from(["A", "View", "b c"]), VIEWS, max_size=3))
def test_views_that_were_exported_are_imported_as_they_were(
    view: View, view_table: dict[str, View]
) -> None:
    config = Config(Settings(view=view, views=view_table))
    again = rviz.read(rviz.write(config)[0], "x.rviz")[0].settings
    assert (again.view, again.views) == (view, view_table)


@pytest.mark.parametrize(
    ("text", "reason", "counted"),
    [
        ("Near Clip Distance: 0.5", "the near plane follows from the distance", 1),
        ("Enable Stereo Rendering: {Value: true}", "stereo is unsupported", 1),
        ("Focal Shape Size: 1", "nothing marks the focal point", 0),
        ("Focal Shape Fixed Size: false", "nothing marks the focal point", 0),
    ],
)
def test_unused_values_of_a_view_are_reported(text: str, reason: str, counted: int) -> None:
    _, report = read_views(f"Current: {{Class: rviz_default_plugins/Orbit, {text}}}\n")
    key = text.partition(":")[0]
    assert report.sentences() == [f"current view: {key}: {reason}; kept for export."]
    assert report.total["properties"] == counted
    assert report.is_complete is (counted == 0)


def test_defaults_of_a_view_are_not_reported() -> None:
    text = "Near Clip Distance: 0.009999999776482582, Focal Shape Size: 0.05000000074505806"
    assert current(f"{{Class: rviz_default_plugins/Orbit, {text}}}")[1] == ""

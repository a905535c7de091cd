"""Commands for views, and views that follow frames."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import pytest
from bench import Bench, Benches
from msgspec.structs import replace

from webviz.api.status import Level
from webviz.api.views import (
    FPS,
    Orbit,
    ThirdPersonFollower,
    TopDownOrtho,
    View,
    XYOrbit,
    target_group,
)
from webviz.commands import (
    ChangeView,
    FocusDisplay,
    FocusFrame,
    Load,
    RemoveView,
    RenameView,
    ResetView,
    SaveImage,
    SaveView,
    ShowView,
    StartWithView,
)
from webviz.engine.commands import PROGRAM, Command, Sender
from webviz.engine.state import State
from webviz.files.config import dump
from webviz.files.opening import parse
from webviz_displays.axes import Axes

ALICE, BOB = 3, 7


class TwoBrowsers:
    """Cameras that stay where they are put."""

    def __init__(self) -> None:
        self.start: View = Orbit()
        self.by_browser: dict[int, View] = {ALICE: Orbit(), BOB: FPS()}
        self.images: list[tuple[str, int | None]] = []

    def start_with(self, view: View) -> None:
        self.start = view

    def show(self, view: View, browser: int | None = None) -> None:
        for id_ in self.by_browser:
            if browser in (None, id_):
                self.by_browser[id_] = view

    def views(self) -> Mapping[int, View]:
        return dict(self.by_browser)

    def target_frames(self) -> set[str]:
        frames = {view.target_frame for view in (self.start, *self.by_browser.values())}
        return frames - {"<Fixed Frame>"}

    def size(self, browser: int) -> tuple[float, float]:
        return 800.0, 600.0

    def save_image(self, name: str, browser: int | None = None) -> None:
        self.images.append((name, browser))


class TwoBrowserViewer:
    """A viewer with two browsers."""

    def __init__(self, b: Bench, cameras: TwoBrowsers) -> None:
        self.bench, self.cameras = b, cameras

    def do(self, command: Command, sender: Sender = PROGRAM) -> State:
        """Run a command and return the state that panels show."""
        answer = self.bench.viewer.enqueue(command, sender)
        self.bench.until_done(answer)
        assert answer.exception(0) is None
        return self.bench.states[-1]

    def refusal(self, command: Command) -> str:
        """Return why a command is refused."""
        before = dict(self.cameras.by_browser)
        refusal = self.bench.refusal(command)
        assert self.cameras.by_browser == before
        return refusal


@pytest.fixture
def looking(bench: Benches) -> TwoBrowserViewer:
    cameras = TwoBrowsers()
    b = bench(Axes(name="A", length=2.0, reference_frame="map"), cameras=cameras)
    b.transform("map", "base", 0, x=4.0, static=True)
    b.turn()
    return TwoBrowserViewer(b, cameras)


def test_a_view_is_shown_in_one_browser_or_in_all(looking: TwoBrowserViewer) -> None:
    looking.do(ShowView(TopDownOrtho(scale=50.0), BOB))
    assert looking.cameras.by_browser == {ALICE: Orbit(), BOB: TopDownOrtho(scale=50.0)}
    state = looking.do(ShowView(XYOrbit()))
    assert looking.cameras.by_browser == state.views == {ALICE: XYOrbit(), BOB: XYOrbit()}


ELSEWHERE = FPS(pitch=0.5)


@pytest.mark.parametrize(
    "command",
    [
        ShowView(ELSEWHERE),
        ChangeView("pitch", 0.2),
        ResetView(),
        FocusDisplay("display1"),
        FocusFrame("base"),
        SaveImage(name="a.png"),
        SaveView("Mine"),
        StartWithView(),
    ],
    ids=lambda command: type(command).__name__,
)
def test_a_view_command_acts_in_the_browser_that_sends_it_unless_it_names_another(
    looking: TwoBrowserViewer, command: Any
) -> None:
    cameras = looking.cameras

    def acted(command: Command, sender: Sender) -> tuple[list[Any], ...]:
        """Return the changes after a command, for each browser."""
        cameras.by_browser = {ALICE: Orbit(pitch=0.1), BOB: Orbit(pitch=0.3)}
        before = dict(cameras.by_browser)
        views = looking.do(command, sender).settings.views
        images = [browser for _, browser in cameras.images]
        remaining = [
            id for id, view in before.items() if view in (cameras.start, views.get("Mine"))
        ]
        changed_ids = [id for id in before if cameras.by_browser[id] != before[id]]
        cameras.images.clear()
        return changed_ids, images, remaining

    alone = acted(command, Sender(ALICE))
    assert [ALICE] in alone
    assert not any(BOB in browsers for browsers in alone)
    named = replace(command, browser=ALICE)
    assert acted(named, Sender(BOB)) == acted(named, PROGRAM) == alone


def test_a_property_of_a_view_is_changed_and_checked(looking: TwoBrowserViewer) -> None:
    looking.do(ChangeView("distance", 3.0, ALICE))
    assert looking.cameras.by_browser[ALICE] == Orbit(distance=3.0)
    assert "distance: expected > 0" in looking.refusal(ChangeView("distance", -3.0, ALICE))
    assert "did you mean `distance`?" in looking.refusal(ChangeView("distanc", 3.0, ALICE))
    assert "`TopDownOrtho`" in looking.refusal(ChangeView("type", "TopDownOrto", ALICE))


def test_a_view_keeps_its_focal_point_when_its_type_changes(looking: TwoBrowserViewer) -> None:
    looking.do(ShowView(Orbit(focal_point=(3.0, 2.0, 0.0)), ALICE))
    looking.do(ChangeView("type", "TopDownOrtho", ALICE))
    view = looking.cameras.by_browser[ALICE]
    assert isinstance(view, TopDownOrtho)
    assert (view.x, view.y) == pytest.approx((3.0, 2.0), abs=1e-5)


def test_a_view_that_begins_to_follow_a_frame_stays_where_it_is(looking: TwoBrowserViewer) -> None:
    looking.do(ChangeView("target_frame", "base", ALICE))
    view = looking.cameras.by_browser[ALICE]
    assert isinstance(view, Orbit)
    assert view.focal_point == pytest.approx((-4.0, 0.0, 0.0), abs=1e-5)  # base is at x = 4
    looking.do(ChangeView("target_frame", "<Fixed Frame>", ALICE))
    assert looking.cameras.by_browser[ALICE] == Orbit()


def test_the_frames_that_views_follow_are_in_the_scene_while_they_do(
    looking: TwoBrowserViewer,
) -> None:
    scene = looking.bench.scene
    looking.do(ShowView(Orbit(target_frame="base"), ALICE))
    assert scene.poses[target_group("base")].position == (4.0, 0.0, 0.0)
    looking.do(ShowView(Orbit(), ALICE))
    assert target_group("base") not in scene.poses


def test_a_missing_target_frame_is_reported_until_it_arrives(looking: TwoBrowserViewer) -> None:
    state = looking.do(ShowView(Orbit(target_frame="arm"), ALICE))
    status = state.statuses["Target Frame"]
    assert status.level is Level.WARN
    assert status.text.startswith("The view cannot follow arm.")
    looking.bench.transform("map", "arm", 0, static=True)
    state = looking.do(ShowView(Orbit(target_frame="arm"), ALICE))
    assert "Target Frame" not in state.statuses


def test_reset_goes_back_to_where_a_view_of_the_type_begins(looking: TwoBrowserViewer) -> None:
    looking.do(ShowView(ThirdPersonFollower(distance=3.0, target_frame="base"), ALICE))
    looking.do(ResetView(ALICE))
    assert looking.cameras.by_browser[ALICE] == ThirdPersonFollower(target_frame="base")


def test_a_display_comes_into_the_middle(looking: TwoBrowserViewer) -> None:
    looking.do(FocusDisplay("display1", ALICE))
    view = looking.cameras.by_browser[ALICE]
    assert isinstance(view, Orbit)
    assert view.focal_point == pytest.approx((0.0, 0.0, 0.0), abs=1e-5)
    radius = 2.0 * 3**0.5  # of the cube around axes of 2 m
    assert radius < view.distance < 4 * radius
    assert "nothing to focus on" in looking.refusal(FocusDisplay("display9", ALICE))
    looking.do(ShowView(Orbit(focal_point=(9.0, 9.0, 9.0)), ALICE))
    looking.do(FocusDisplay("", ALICE))  # everything is this display
    view = looking.cameras.by_browser[ALICE]
    assert isinstance(view, Orbit)
    assert view.focal_point == pytest.approx((0.0, 0.0, 0.0), abs=1e-5)


def test_views_are_saved_shown_renamed_and_removed(looking: TwoBrowserViewer) -> None:
    looking.do(ShowView(TopDownOrtho(scale=50.0), ALICE))
    state = looking.do(SaveView("Plan", ALICE))
    assert state.settings.views == {"Plan": TopDownOrtho(scale=50.0)}
    assert state.file.is_changed
    looking.do(ShowView("Plan", BOB))
    assert looking.cameras.by_browser[BOB] == TopDownOrtho(scale=50.0)
    looking.do(SaveView("Other", BOB))
    assert list(looking.do(RenameView("Plan", "Map")).settings.views) == ["Map", "Other"]
    assert "already" in looking.refusal(RenameView("Map", "Other"))
    assert "name is empty" in looking.refusal(RenameView("Map", ""))
    assert "the limit is 200" in looking.refusal(SaveView("x" * 201, ALICE))
    assert "did you mean `Map`?" in looking.refusal(ShowView("Mapp", ALICE))
    assert list(looking.do(RemoveView("Map")).settings.views) == ["Other"]
    assert "Unknown saved view `Map`" in looking.refusal(RemoveView("Map"))
    assert "name is empty" in looking.refusal(SaveView("", ALICE))


def test_the_chosen_default_view_is_saved_in_the_config(looking: TwoBrowserViewer) -> None:
    looking.do(ShowView(TopDownOrtho(x=3.0), ALICE))
    looking.do(StartWithView(ALICE))
    assert looking.cameras.start == TopDownOrtho(x=3.0)
    looking.do(SaveView("Plan", ALICE))
    text = dump(looking.bench.viewer.config())
    assert parse(text, "x.yaml").settings == looking.bench.viewer.settings
    assert "type: TopDownOrtho" in text


def test_opening_a_config_shows_its_view(looking: TwoBrowserViewer) -> None:
    looking.do(Load("view: {distance: 4}\nviews: {Near: {distance: 1}}\n", "x.yaml"))
    assert looking.cameras.start == Orbit(distance=4.0)
    assert set(looking.cameras.by_browser.values()) == {Orbit(distance=4.0)}
    looking.do(ShowView("Near"))
    assert set(looking.cameras.by_browser.values()) == {Orbit(distance=1.0)}


def test_a_picture_is_requested_from_one_browser(looking: TwoBrowserViewer) -> None:
    looking.do(SaveImage(BOB, "robot.png"))
    assert looking.cameras.images == [("robot.png", BOB)]


def test_without_browsers_there_is_nothing_to_change(bench: Benches) -> None:
    looking = TwoBrowserViewer(bench(cameras=(cameras := TwoBrowsers())), cameras)
    cameras.by_browser.clear()
    assert "No browser is connected" in looking.refusal(ResetView())
    assert "No browser is connected" in looking.refusal(SaveView("A"))


def test_a_frame_is_looked_at_where_it_is_and_one_without_a_pose_is_refused(
    looking: TwoBrowserViewer,
) -> None:
    looking.do(FocusFrame("base", ALICE))
    view = looking.cameras.by_browser[ALICE]
    assert isinstance(view, Orbit)
    assert view.focal_point == pytest.approx((4.0, 0.0, 0.0))
    assert "moon" in looking.refusal(FocusFrame("moon", ALICE))

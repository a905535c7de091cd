"""Two pages of a scene: they show the same, each in the colours of its theme."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import playwright.sync_api as playwright
import pytest

from tests.scene.conftest import View
from tests.scene.test_page import EVERYTHING
from webviz.api.nodes import Labels, Lines, Pose, Rgb
from webviz.scene import set_background
from webviz.scene.schemes import SCHEMES

OWN = (200, 30, 90)
ACROSS = np.array([[(-3.0, 0.0, 0.0), (3.0, 0.0, 0.0)]], np.float32)
BESIDE = (-2.0, 2.5, 0.0)
"""A place of the scene where nothing is."""


@pytest.fixture(scope="module")
def second(tab: View, browser: playwright.Browser) -> Iterator[View]:
    """A second page of the scene."""
    second = View(browser, tab.scene)
    yield second
    second.close()
    tab.wait_for(lambda: len(tab.scene.link.server.get_clients()) == 1)


@pytest.fixture
def other(second: View, view: View) -> View:
    """The second page, with a light theme."""
    second.tab.emulate_media(color_scheme="light")
    return second


def test_a_page_that_joins_late_begins_with_rvizs_orbit_view_and_sees_the_same(
    view: View, request: pytest.FixtureRequest
) -> None:
    for key, make in EVERYTHING.items():
        view.scene.upsert("base_link", key, make(1))
        view.scene.upsert("base_link", key, make(40))
    view.scene.set_pose("base_link", Pose((0.5, 0.0, 0.0)))
    view.show()
    late: View = request.getfixturevalue("second")
    client = max(late.scene.link.server.get_clients().items())[1]
    late.wait_for(lambda: bool(np.allclose(client.camera.position, (5, 5, 50**0.5), atol=1e-4)))
    assert client.camera.fov == pytest.approx(np.pi / 4)
    assert client.camera.look_at == pytest.approx((0, 0, 0), abs=1e-6)
    late.look((0.0, -0.01, 10.0), (0.0, 0.0, 0.0))
    late.wait_for(lambda: late.draw(2) or bool((late.pixels() == view.pixels()).mean() > 0.999))


def look(view: View, place: tuple[float, float, float], expected: Rgb) -> None:
    view.wait_for(
        lambda: view.draw(1) or np.abs(np.subtract(view.color_at(place), expected)).max() <= 2,
        f"{expected} at {place}",
    )


def test_each_page_has_the_background_and_the_grid_of_its_theme(view: View, other: View) -> None:
    view.scene.upsert("room", "grid", Lines(ACROSS, None, 0.5, "m"))
    view.scene.upsert("room", "own", Lines(ACROSS + np.array((0, 2, 0), np.float32), OWN, 0.5, "m"))
    view.scene.flush()
    for page, theme in ((view, "dark"), (other, "light")):
        look(page, BESIDE, SCHEMES[theme]["background"])
        look(page, (0.0, 0.0, 0.0), SCHEMES[theme]["grid"])
        look(page, (0.0, 2.0, 0.0), OWN)
    other.tab.emulate_media(color_scheme="dark")
    look(other, (0.0, 0.0, 0.0), SCHEMES["dark"]["grid"])


def test_a_chosen_background_is_that_of_all_pages_until_it_is_automatic_again(
    view: View, other: View
) -> None:
    server = view.scene.link.server
    set_background(server, OWN)
    for page in (view, other):
        look(page, BESIDE, OWN)
    set_background(server, None)
    look(view, BESIDE, SCHEMES["dark"]["background"])
    look(other, BESIDE, SCHEMES["light"]["background"])


def share(view: View, color: Rgb) -> float:
    """The share of the picture in a colour."""
    return float((np.abs(view.pixels().astype(int) - color).max(axis=2) <= 2).mean())


def test_texts_without_a_colour_contrast_with_the_theme_and_others_keep_theirs(
    view: View, other: View
) -> None:
    at, white = np.zeros((1, 3), np.float32), (255, 255, 255)
    view.scene.upsert("room", "text", Labels(at, ("HHH",), 6.0))
    view.scene.flush()
    for page, theme in ((view, "dark"), (other, "light")):
        color = SCHEMES[theme]["text"]
        page.wait_for(lambda page=page, color=color: page.draw(1) or share(page, color) > 0.02)
    assert share(other, white) == 0
    view.scene.upsert("room", "text", Labels(at, ("HHH",), 6.0, colors=white))
    view.scene.flush()
    other.wait_for(lambda: other.draw(1) or share(other, white) > 0.02)

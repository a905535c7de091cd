"""Pictures that are compared: what counts, what is masked, what a failure says and leaves."""

from __future__ import annotations

import dataclasses
import resource
import signal
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import psutil
import pytest
from processes import command_lines

from webviz.api.errors import Error
from webviz.api.views import Orbit
from webviz.shell.pictures.browser import BrowserDied, NoBrowser
from webviz.shell.testing import TOLERANCE, Harness, share_of_difference
from webviz.shell.testing.comparing import load, masked, store
from webviz.shell.testing.pictures import ReferenceImages
from webviz.shell.testing.shared_renderer import SharedRenderer

VIEW = Orbit(distance=7.0)


def with_references(stage: Harness, folder: Path, *, update: bool = False) -> ReferenceImages:
    """Let a stage compare with pictures in a folder of the test."""
    references = ReferenceImages(folder / "pictures", folder / "output", folder, update)
    stage.snapshots = dataclasses.replace(stage.snapshots, references=references, view=VIEW)
    return references


@pytest.fixture
def references(filled: Harness, tmp_path: Path) -> ReferenceImages:
    """Hold the picture `scan` of `filled`."""
    with_references(filled, tmp_path, update=True)
    filled.check_picture("scan")
    return with_references(filled, tmp_path)


def test_the_same_input_gives_the_same_picture_to_the_bit(filled: Harness) -> None:
    once = filled.picture()
    filled.look(Orbit(distance=3.0))
    other = filled.picture()
    filled.look(Orbit())
    assert (filled.picture() == once).all()
    assert share_of_difference(other, once) > TOLERANCE


def test_another_stage_with_the_same_input_gives_the_same_picture(
    filled: Harness, request: pytest.FixtureRequest
) -> None:
    once = filled.picture()
    filled.set("enabled", False, "Scan")
    assert (filled.picture() != once).any()
    filled.set("enabled", True, "Scan")
    assert (filled.picture() == once).all()


def test_a_transparent_picture_has_no_background(filled: Harness) -> None:
    opaque, clear = filled.picture(), filled.picture(transparent=True)
    assert clear.shape == (300, 400, 4)
    assert clear[0, 0].tolist() == [0, 0, 0, 0]
    scan = opaque.max(axis=2) == 255  # edges of points are blended
    assert scan.any()
    assert (clear[..., 3][scan] == 255).all()
    over = clear[..., :3] * (clear[..., 3:] / 255) + 48 * (1 - clear[..., 3:] / 255)
    assert share_of_difference(over.round().astype(np.uint8), opaque) <= TOLERANCE


def test_pictures_have_the_requested_size(filled: Harness) -> None:
    filled.resize(320, 200)
    assert filled.picture().shape == (200, 320, 3)


def test_a_missing_reference_names_the_option_that_makes_it(
    filled: Harness, tmp_path: Path
) -> None:
    with_references(filled, tmp_path)
    with pytest.raises(
        AssertionError, match=r"pictures/scan\.png is missing\. Run pytest with --up"
    ):
        filled.check_picture("scan")


def test_a_wrong_picture_leaves_the_difference(
    filled: Harness, references: ReferenceImages
) -> None:
    filled.check_picture("scan")
    filled.set("size", 0.5, "Scan")
    with pytest.raises(AssertionError, match=r"See output/scan\.png and output/scan\.diff"):
        filled.check_picture("scan")
    red = load(references.output / "scan.difference.png") == (255, 0, 0)
    assert 0.001 < red.all(axis=2).mean() < 0.4
    assert load(references.output / "scan.png").shape == (300, 400, 3)


def test_masked_pixels_are_ignored(filled: Harness, references: ReferenceImages) -> None:
    reference = load(references.folder / "scan.png")
    filled.set("size", 0.25, "Scan")
    actual = filled.picture()
    rows, columns = np.nonzero(np.abs(actual.astype(int) - reference).max(axis=2) > 12)
    box = (columns.min() - 2, rows.min() - 2, columns.max() + 3, rows.max() + 3)
    with pytest.raises(AssertionError, match="differ"):
        filled.check_picture("scan")
    filled.check_picture("scan", mask=[box])


def test_a_mask_is_grey_and_may_reach_over_the_edge() -> None:
    picture = np.zeros((20, 30, 3), np.uint8)
    assert (masked(picture, [(-5, -5, 10, 100)])[:, :10] == 128).all()
    assert (masked(picture, [(-5, -5, 10, 100)])[:, 10:] == 0).all()
    assert (masked(picture, [(-5, -5, -1, -1)]) == 0).all()


def test_a_picture_of_another_size_is_reported(
    filled: Harness, references: ReferenceImages
) -> None:
    filled.snapshots.references = dataclasses.replace(references, size=(320, 240))
    with pytest.raises(
        AssertionError, match=r"has 320 x 240 pixels, pictures/scan.png has 400 x 3"
    ):
        filled.check_picture("scan")


def test_an_update_keeps_images_that_still_match(
    filled: Harness, tmp_path: Path, references: ReferenceImages
) -> None:
    path = references.folder / "scan.png"
    before = path.stat().st_ino
    with_references(filled, tmp_path, update=True)
    filled.check_picture("scan")
    assert path.stat().st_ino == before
    filled.set("size", 0.5, "Scan")
    filled.check_picture("scan")
    assert path.stat().st_ino != before
    assert path.stat().st_size < 15_000


def test_a_display_that_makes_no_difference_is_named(
    filled: Harness, references: ReferenceImages
) -> None:
    filled.check_picture("scan", each_display=True)
    filled.set("style", "Points", "Scan")
    filled.set("size_pixels", 1.0, "Scan")
    with_references(filled, references.root, update=True)
    with pytest.raises(AssertionError, match="The picture small would be the same without Scan"):
        filled.check_picture("small", each_display=True)


def test_a_disk_that_is_full_leaves_the_old_picture(tmp_path: Path) -> None:
    path = tmp_path / "a.png"
    store(np.zeros((4, 4, 3), np.uint8), path)
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (10, hard))
    try:
        with pytest.raises(Error, match="File too large"):
            store(np.ones((4, 4, 3), np.uint8), path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert (load(path) == 0).all()
    assert [file.name for file in tmp_path.iterdir()] == ["a.png"]


@pytest.fixture
def shared_renderer() -> Iterator[SharedRenderer]:
    """One of its own, for tests in which its browser dies."""
    shared_renderer = SharedRenderer()
    yield shared_renderer
    shared_renderer.close()


def browsers() -> list[psutil.Process]:
    """The browsers that this process has started, without their helpers."""
    return [
        process
        for process, line in command_lines().items()
        if "--remote-debugging-pipe" in line and "--type" not in line
        if not line.startswith("/bin/sh ")  # by which Debian starts it
    ]


def test_a_browser_that_dies_is_reported_and_replaced(
    filled: Harness, shared_renderer: SharedRenderer, tmp_path: Path
) -> None:
    before = browsers()
    filled.snapshots.shared_renderer = shared_renderer
    picture = filled.picture()
    (ours,) = set(browsers()) - set(before)
    helpers = ours.children(recursive=True)
    ours.send_signal(signal.SIGKILL)
    with_references(filled, tmp_path, update=True)
    with pytest.raises(BrowserDied, match="The browser crashed while drawing"):
        filled.check_picture("scan")
    assert list(tmp_path.rglob("*.png")) == []
    _, alive = psutil.wait_procs(helpers, timeout=60)
    assert alive == []
    filled.look(Orbit())
    assert (filled.picture() == picture).all(), "another browser, the same picture"
    shared_renderer.close()
    assert set(browsers()) - set(before) == set()


def test_a_missing_browser_is_explained_in_one_sentence(
    filled: Harness,
    shared_renderer: SharedRenderer,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
) -> None:
    filled.snapshots.shared_renderer = shared_renderer
    monkeypatch.setenv("PATH", "")
    monkeypatch.setenv("PLAYWRIGHT_BROWSERS_PATH", str(tmp_path))
    with pytest.raises(NoBrowser, match=r"No browser found\. Install Chromium"):
        filled.picture()
    monkeypatch.setenv("WEBVIZ_BROWSER", "/nowhere/chromium")
    with pytest.raises(NoBrowser, match="WEBVIZ_BROWSER is '/nowhere/chromium'"):
        filled.picture()
    monkeypatch.setenv("WEBVIZ_BROWSER", "/bin/false")
    with pytest.raises(NoBrowser, match="/bin/false does not start"):
        filled.picture()

"""Pictures as files."""

from __future__ import annotations

import contextlib
import io
import os
import stat
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import PIL.Image
import PIL.ImageSequence
import playwright.sync_api as playwright
import pytest

from webviz.api.errors import UsageError
from webviz.data.transforms import TransformBuffer, diagnose
from webviz.data.transforms.picture import draw_tree
from webviz.shell.cli import frames
from webviz.shell.pictures import videos
from webviz.shell.pictures.files import (
    OutputError,
    check,
    contact_sheet,
    numbered,
    save,
    save_animation,
    with_clock,
)

RED, BLUE = (255, 0, 0), (0, 0, 255)


def plain(color: tuple[int, ...], size: tuple[int, int] = (40, 30)) -> PIL.Image.Image:
    return PIL.Image.new("RGBA" if len(color) == 4 else "RGB", size, color)


@pytest.mark.parametrize("ending", [".png", ".webp", ".jpg", ".JPEG", ".gif"])
def test_the_format_of_a_picture_follows_its_extension(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"a{ending}"
    save(plain(RED), path)
    with PIL.Image.open(path) as image:
        assert np.abs(np.asarray(image.convert("RGB"), int) - RED).max() < 5
    assert os.listdir(tmp_path) == [path.name]


def test_a_picture_can_be_read_by_others_as_far_as_the_umask_lets_them(tmp_path: Path) -> None:
    before = os.umask(0o022)
    try:
        save(plain(RED), tmp_path / "a.png")
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "a.png").stat().st_mode) == 0o644


def test_transparency_is_kept(tmp_path: Path) -> None:
    for name in ("a.png", "a.webp"):
        save(plain((255, 0, 0, 0)), tmp_path / name)
        with PIL.Image.open(tmp_path / name) as image:
            assert np.asarray(image.convert("RGBA"))[..., 3].max() == 0


@pytest.mark.parametrize("ending", [".gif", ".webp"])
def test_an_animation_shows_every_picture(tmp_path: Path, ending: str) -> None:
    path = tmp_path / f"a{ending}"
    save_animation((plain(color) for color in (RED, BLUE, RED)), path, 5.0)
    with PIL.Image.open(path) as image:
        frames = []
        for frame in PIL.ImageSequence.Iterator(image):
            frames.append(np.asarray(frame.convert("RGB"), int)[10, 10])
            assert frame.info["duration"] == 200
        assert image.info["loop"] == 0
    assert np.abs(np.array(frames) - (RED, BLUE, RED)).max() < 5


def test_a_contact_sheet_shows_every_picture_above_its_caption() -> None:
    sheet = contact_sheet([("one", plain(RED)), ("two", plain(BLUE)), ("three", plain(RED))], 2)
    pixels = np.asarray(sheet)
    red, blue = ((pixels == color).all(axis=2).sum() for color in (RED, BLUE))
    assert (red, blue) == (2 * 40 * 30, 40 * 30)
    assert sheet.width < 3 * 40
    caption = pixels[4 + 30 : 4 + 30 + 20, 4:44]
    assert (caption > 150).any()


def test_a_contact_sheet_that_is_too_large_is_refused() -> None:
    with pytest.raises(OutputError, match="the limit is 16000 per side"):
        contact_sheet([("", plain(RED, (8000, 10)))] * 3, 3)


def test_names_of_several_pictures_sort_by_time() -> None:
    path = Path("out/run.png")
    assert numbered(path, "", None, 1) == path
    assert numbered(path, "", 3, 11) == Path("out/run-03.png")
    assert numbered(path, "Front left/2", None, 1) == Path("out/run-Front_left_2.png")
    assert numbered(path, "Top", 0, 2) == Path("out/run-Top-0.png")


@pytest.mark.parametrize(
    ("name", "options", "sentence"),
    [
        ("a.txt", {}, "no supported image extension"),
        ("a", {}, "no supported image extension"),
        ("a.jpg", {"transparent": True}, r"Use .png or .webp"),
        ("a.png", {"is_animation": True}, r"does not support animation. Use .gif or .webp"),
        ("nowhere/a.png", {}, "No such file or directory"),
    ],
)
def test_a_name_that_does_not_do_is_refused_at_once(
    tmp_path: Path, name: str, options: dict[str, Any], sentence: str
) -> None:
    with pytest.raises(OutputError if "nowhere" in name else UsageError, match=sentence):
        check(tmp_path / name, **{"is_animation": False, "transparent": False, **options})
    assert os.listdir(tmp_path) == []


def test_a_failure_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "a.gif"
    save(plain(RED), path)
    old = path.read_bytes()

    def broken() -> Iterator[PIL.Image.Image]:
        yield plain(RED)
        raise RuntimeError("the browser died")

    with pytest.raises(RuntimeError, match="the browser died"):
        save_animation(broken(), path, 10.0)
    with pytest.raises(RuntimeError, match="the browser died"):
        save_animation(broken(), tmp_path / "b.webp", 10.0)
    assert path.read_bytes() == old
    assert os.listdir(tmp_path) == ["a.gif"]


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full here")
def test_a_full_disk_is_one_sentence_and_a_device_stays_one(tmp_path: Path) -> None:
    path = tmp_path / "full.png"
    path.symlink_to("/dev/full")
    noise = np.random.default_rng(1).integers(0, 255, (200, 200, 3), np.uint8)
    with pytest.raises(OutputError, match=r"Cannot write .*full\.png: No space left on device\."):
        save(PIL.Image.fromarray(noise), path)
    assert stat.S_ISCHR(path.stat().st_mode)


def test_a_tree_of_frames_is_a_png(
    browser: playwright.Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(frames, "launched", lambda: contextlib.nullcontext(browser))
    buffer = TransformBuffer()
    buffer.set_transform("map", "odom", 1, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    picture = draw_tree(diagnose(buffer), "Frames")
    with PIL.Image.open(io.BytesIO(frames.to_png(picture))) as image:
        assert image.size == (picture.width, picture.height)
        colors = {color for _, color in image.convert("RGB").getcolors(1 << 16) or ()}
    assert {(255, 255, 255), (0xF6, 0xF8, 0xFA)} <= colors


def test_a_clock_is_written_into_the_lower_left_corner() -> None:
    pixels = np.asarray(with_clock(plain(BLUE, (640, 360)), "12.40 s"))
    assert (pixels[:300] == BLUE).all()
    assert (pixels[:, 300:] == BLUE).all()
    assert (pixels != BLUE).any(axis=2).sum() > 200


def test_a_video_has_all_pictures(tmp_path: Path) -> None:
    name, reason = videos.encoder()
    if not name:
        pytest.skip(f"{reason}: no video can be made")
    path = tmp_path / "a.mp4"
    videos.save_video((plain(RED, (41, 31)) for _ in range(5)), path, 10.0, name)
    data = path.read_bytes()
    assert b"ftyp" in data[:32]
    assert os.listdir(tmp_path) == [path.name]


def test_a_video_that_ffmpeg_cannot_make_leaves_nothing(tmp_path: Path) -> None:
    name, reason = videos.encoder()
    if not name:
        pytest.skip(f"{reason}: no video can be made")

    def broken() -> Iterator[PIL.Image.Image]:
        yield plain(RED)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        videos.save_video(broken(), tmp_path / "a.mp4", 10.0, name)
    with pytest.raises(OutputError, match="ffmpeg failed"):
        videos.save_video(iter([plain(RED)]), tmp_path / "no" / "a.mp4", 10.0, name)
    assert os.listdir(tmp_path) == []

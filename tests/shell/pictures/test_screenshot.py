"""`webviz screenshot` as a user meets it: files, words, exit status, and nothing left behind."""

from __future__ import annotations

import functools
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import numpy as np
import photos
import PIL.Image
import PIL.ImageSequence
import psutil
import pytest
import trimesh
from bags import Bag, strings
from processes import command_lines, send
from program import Program
from several import several
from waiting import until

from tests.shell.pictures.conftest import CommandResult
from webviz.shell.cli import main as cli

CONFIG = Path(__file__).parent / "top.yaml"
COMMAND = [sys.executable, "-m", "webviz", "screenshot", "-d", str(CONFIG)]
SMALL = ["--size", "320x240"]
MANY = ["--every", "0.02", *SMALL]
"""Pictures for a minute, so that something can happen meanwhile."""
PATIENCE_S = 180.0
"""Time in seconds for what takes five seconds on a machine that does nothing else."""


@pytest.fixture
def refusal(screenshot: Callable[..., CommandResult], tmp_path: Path) -> Callable[..., str]:
    """The sentence with which the command refuses; nothing may be written."""

    def refusal(*arguments: str) -> str:
        before = sorted(os.listdir(tmp_path))
        result = screenshot(*arguments)
        assert result.status == 1, result.errors
        assert sorted(os.listdir(tmp_path)) == before
        (line,) = result.errors.splitlines()
        return line

    return refusal


@pytest.fixture
def start(tmp_path: Path) -> Iterator[Callable[..., Program]]:
    """Start the command; it and the browser are ended at the end."""
    log = tmp_path.with_suffix(".log")
    with several(
        lambda *arguments: Program([*COMMAND, *arguments], {**os.environ}, log),
        lambda program: program.end(signal.SIGKILL),
    ) as start:
        yield start


def while_drawing(program: Program, folder: Path) -> dict[psutil.Process, str]:
    """Wait until an animation is being drawn, and return all processes with their command lines."""
    family: dict[psutil.Process, str] = {}

    def has_tab() -> bool:
        family.update(command_lines(program.process.pid))
        return any(" --type=renderer" in line for line in family.values())

    # The file is begun before the browser is there; to list processes takes long.
    until(lambda: any(folder.glob(".*.part")) and has_tab(), look_s=0.1)
    return family


def left_of(family: Iterable[psutil.Process]) -> list[psutil.Process]:
    _, alive = psutil.wait_procs(family, timeout=PATIENCE_S)
    return alive


def test_a_picture_of_a_bag(run: Path, tmp_path: Path) -> None:
    arguments = ["--bag", str(run), "--at", "2", "-o", "a.png", *SMALL]
    result = subprocess.run(
        [*COMMAND, *arguments], capture_output=True, text=True, timeout=PATIENCE_S, cwd=tmp_path
    )
    assert result.returncode == 0, result.stderr
    assert result.stderr == ""
    assert result.stdout == "webviz: wrote a.png, 1 picture of 320 x 240 pixels.\n"
    with PIL.Image.open(tmp_path / "a.png") as image:
        pixels = np.asarray(image)
    assert pixels.shape == (240, 320, 3)
    assert (pixels == (255, 0, 255)).all(axis=2).sum() > 20
    assert os.listdir(tmp_path) == ["a.png"]


def test_an_image_of_a_bag_is_written_as_it_is(
    tmp_path: Path, screenshot: Callable[..., CommandResult]
) -> None:
    bag = Bag()
    bag.add("/camera/image_raw", photos.RAW)
    for second in (0, 1, 2):
        pixels = np.full((24, 36, 3), (80 * second, 10, 20), np.uint8)
        bag.put(second, "/camera/image_raw", photos.raw(pixels, "rgb8"))
    bag.add("/depth/compressedDepth", photos.COMPRESSED)
    depths = np.full((24, 36), 1500, np.uint16)
    depths[:, :18] = 500
    bag.put(0, "/depth/compressedDepth", photos.compressed_depth(depths))
    bag.write(tmp_path / "run")
    arguments = ["--bag", "run", "-o", "a.png", "--image"]
    screenshot = functools.partial(screenshot, config=None)
    result = screenshot(*arguments, "/camera/image_raw", "--at", "1")
    assert result.status == 0
    assert "1 picture of 36 x 24 pixels" in result.output
    with PIL.Image.open("a.png") as image:
        assert np.abs(np.asarray(image, np.int16) - (80, 10, 20)).max() == 0
    assert screenshot(*arguments, "/depth/compressedDepth").status == 0
    with PIL.Image.open("a.png") as image:
        assert np.asarray(image)[0, [0, 35], 0].tolist() == [0, 255]
    result = screenshot(*arguments, "/nothing")
    assert result.status == 1
    assert "No image to write." in result.errors


def test_without_a_config_the_topics_of_the_bag_are_shown(
    run: Path, screenshot: Callable[..., CommandResult]
) -> None:
    result = screenshot("--bag", str(run), "-o", "a.png", *SMALL, config=None)
    assert (result.status, result.errors) == (0, "")


def test_several_times_and_views_are_files_of_their_own(
    run: Path, tmp_path: Path, screenshot: Callable[..., CommandResult]
) -> None:
    at = ["--at", "1", "--at", "end", "--view", "Far", "--transparent"]
    result = screenshot("--bag", str(run), *at, "-o", "a.png", *SMALL)
    assert result.output.startswith("webviz: wrote a-Far-0.png to a-Far-1.png, 2 pictures")
    assert sorted(os.listdir(tmp_path)) == ["a-Far-0.png", "a-Far-1.png"]


def test_several_times_with_the_ending_of_a_gif_are_an_animation(
    run: Path, tmp_path: Path, screenshot: Callable[..., CommandResult]
) -> None:
    times = ["--from", "1", "--to", "3", "--every", "0.5", "--fps", "4"]
    result = screenshot("--bag", str(run), *times, "-o", "a.gif", *SMALL)
    assert result.status == 0, result.errors
    with PIL.Image.open(tmp_path / "a.gif") as image:
        durations = [frame.info["duration"] for frame in PIL.ImageSequence.Iterator(image)]
    assert durations == [250] * 5


def test_a_contact_sheet_is_one_picture(
    run: Path, tmp_path: Path, screenshot: Callable[..., CommandResult]
) -> None:
    sheet = ["--every", "2", "--contact-sheet", "--size", "160x90"]
    result = screenshot("--bag", str(run), *sheet, "-o", "a.png")
    assert "4 pictures of 160 x 90 pixels" in result.output
    with PIL.Image.open(tmp_path / "a.png") as image:
        assert 320 < image.width < 350


def test_a_display_that_is_not_ok_makes_a_table_and_status_3(
    run: Path, tmp_path: Path, screenshot: Callable[..., CommandResult]
) -> None:
    options = ["--set", "displays.Scan.topic=/scann", "--bag", str(run), "-o", "a.png", *SMALL]
    result = screenshot(*options)
    assert result.status == 3
    assert (tmp_path / "a.png").exists()
    first, *table = result.errors.splitlines()
    assert first == "webviz: not all displays are OK at 6 s of the bag:"
    assert table[0].startswith("  WARN   Scan  No publisher on /scann. Choose /scan, the nearest ")


def test_meshes_below_a_mesh_root_are_drawn(
    tmp_path: Path, screenshot: Callable[..., CommandResult]
) -> None:
    mesh = tmp_path / "meshes" / "box.stl"
    mesh.parent.mkdir()
    trimesh.creation.box().export(mesh)
    geometry = f"<geometry><mesh filename='file://{mesh}'/></geometry>"
    bag = Bag()
    bag.add("/robot_description", "std_msgs/msg/String", latched=True)
    text = f"<robot name='r'><link name='box'><visual>{geometry}</visual></link></robot>"
    bag.put(0.0, "/robot_description", {"data": text})
    bag.transform(0.0, "map", "box", static=True)
    config = tmp_path / "robot.yaml"
    config.write_text("{fixed_frame: map, displays: [{type: RobotModel, name: Robot}]}")
    options = ["--bag", str(bag.write(tmp_path / "bag")), "-o", "a.png", *SMALL]
    result = screenshot(*options, "--mesh-root", str(mesh.parent), config=config)
    assert result.status == 0, result.errors


def test_help_lists_every_exit_status(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli(["screenshot", "--help"]) == 0
    text = capsys.readouterr().out
    for status in ("0  ", "1  ", "2  ", "3  ", "4  ", "130"):
        assert f"\n  {status}" in text


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--bag", "nowhere.mcap"], "Bag nowhere.mcap not found"),
        (["--bag", "RUN", "--at", "20"], "20 s is outside of RUN. Give 0 to 6 s"),
        (["--bag", "RUN", "-o", "nowhere/a.png"], "Cannot write nowhere/a.png"),
        (["--bag", "RUN", "--wait-for", "Scam"], "did you mean `Scan`?"),
        (["--bag", "RUN", "--mesh-root", "nowhere"], "--mesh-root nowhere is not a folder"),
    ],
)
def test_a_mistake_is_one_sentence_and_status_1(
    run: Path, refusal: Callable[..., str], arguments: list[str], sentence: str
) -> None:
    options = [argument.replace("RUN", str(run)) for argument in arguments]
    line = refusal("-o", "a.png", *SMALL, *options)
    assert line.startswith("webviz: ")
    assert sentence.replace("RUN", str(run)) in line


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        ([], "needs --output FILE."),
        (["-o", "a.png", "--at", "3"], "--at needs --bag"),
        (["-o", "a.png", "--map", "m.yaml"], "--map needs --bag"),
        (["-o", "a.png", "--bag", "x", "--at", "soon"], "'soon' is not a valid time"),
        (["-o", "a.png", "--bag", "x", "--size", "big"], "Write it as 1280x720"),
        (["-o", "a.png", "--bag", "x", "--to", "3"], "need --every"),
        (["-o", "a.png", "--bag", "x", "--fps", "3"], "--fps needs an animation"),
        (["-o", "a.png", "--timeout", "-1"], "Must be > 0."),
        (["-o", "a.png", "--image", "/a", "-d", "x.yaml"], "--display-config has no effect with"),
        (["-o", "a.png", "--bag", "x", "--transform", *"abcde"], "`c` is not a number"),
        (["-o", "a.bmp"], "no supported image extension"),
        (["-o", "a.jpg", "--transparent"], ".jpg does not support transparency"),
        (["-o", "a.png", "--size", "9x9"], "16 to 8192 pixels per side"),
        (["-o", "a.png", "--bag", "x", "--contact-sheet", "--size", "9x9"], "16 to 8192 pixels"),
        (
            ["-o", "a.webp", "--bag", "x", "--every", "1", "--view", "a", "--view", "b"],
            "An animation shows one view",
        ),
    ],
)
def test_wrong_arguments_are_status_2(
    capsys: pytest.CaptureFixture[str], arguments: list[str], sentence: str
) -> None:
    assert cli(["screenshot", *arguments]) == 2
    assert sentence in capsys.readouterr().err


def test_only_skipped_topics_that_a_display_wants_are_listed(
    tmp_path: Path, screenshot: Callable[..., CommandResult]
) -> None:
    bag = strings(0, 1)
    for topic in ("/odd", "/other"):
        bag.add(topic, "odd_msgs/msg/Odd", definition="other_msgs/Missing part\n")
        bag.put(0, topic, b"\x00\x01\x00\x00")
    folder = bag.write(tmp_path / "run")
    config = tmp_path / "odd.yaml"
    config.write_text("displays: [{type: Path, topic: /odd}]\n")
    result = screenshot("--bag", str(folder), "-o", "a.png", *SMALL, config=config)
    assert result.status == 3, result.errors
    assert f"webviz: {folder}: /odd is skipped: " in result.errors
    assert "/other" not in result.errors
    assert f"webviz: {folder}: The topics are /words." in result.errors


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full here")
def test_a_full_disk_is_one_sentence(
    run: Path, tmp_path: Path, refusal: Callable[..., str]
) -> None:
    (tmp_path / "a.png").symlink_to("/dev/full")
    line = refusal("--bag", str(run), "-o", "a.png", *SMALL)
    assert line == "webviz: Cannot write a.png: No space left on device."


@pytest.mark.parametrize(
    ("number", "whole_family"),
    [(signal.SIGINT, True), (signal.SIGINT, False)],
    ids=["Ctrl-C in a terminal", "SIGINT"],
)
def test_an_interrupted_run_leaves_no_file_and_no_process(
    run: Path,
    tmp_path: Path,
    start: Callable[..., Program],
    number: signal.Signals,
    whole_family: bool,
) -> None:
    program = start("--bag", str(run), *MANY, "-o", str(tmp_path / "a.webp"))
    family = while_drawing(program, tmp_path)
    send(number, family if whole_family else ())
    assert program.end(number) == 130, program.output()
    assert program.output() == "webviz: interrupted.\n"
    assert os.listdir(tmp_path) == []
    assert left_of(family) == []


def test_a_terminated_run_ends_although_its_browser_hangs(
    run: Path, tmp_path: Path, start: Callable[..., Program]
) -> None:
    program = start("--bag", str(run), *MANY, "-o", str(tmp_path / "a.webp"))
    family = while_drawing(program, tmp_path)
    send(signal.SIGSTOP, family)
    assert program.end(signal.SIGTERM) == 130, program.output()
    assert program.output() == "webviz: interrupted.\n"
    assert os.listdir(tmp_path) == []
    assert left_of(family) == []


def test_a_browser_that_dies_midway_is_one_sentence(
    run: Path, tmp_path: Path, start: Callable[..., Program]
) -> None:
    program = start("--bag", str(run), *MANY, "-o", str(tmp_path / "a.webp"))
    family = while_drawing(program, tmp_path)
    # Debian starts it by a shell script, which comes first.
    *_, browser = (
        process
        for process, line in family.items()
        if " --remote-debugging" in line and " --type=" not in line
    )
    browser.kill()
    assert program.process.wait(PATIENCE_S) == 1
    assert program.output().startswith("webviz: The browser crashed while drawing")
    assert program.output().count("\n") == 1
    assert os.listdir(tmp_path) == []
    assert left_of(family) == []


def test_a_video_is_a_webp_without_ffmpeg(
    run: Path,
    tmp_path: Path,
    screenshot: Callable[..., CommandResult],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("webviz.shell.pictures.videos.shutil.which", lambda name: None)
    result = screenshot("--bag", str(run), "--every", "2", "--clock", "-o", "a.mp4", *SMALL)
    assert result.status == 4, "a.mp4 is missing"
    assert result.errors.startswith("webviz: a.webp instead of a video, since ffmpeg is not inst")
    assert result.output.startswith("webviz: wrote a.webp, 4 pictures")
    with PIL.Image.open(tmp_path / "a.webp") as image:
        assert len(list(PIL.ImageSequence.Iterator(image))) == 4

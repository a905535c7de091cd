"""Loading in a process: what hangs, dies or takes too much memory there costs one shape."""

from __future__ import annotations

import gc
import json
import os
import pickle
import signal
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from pathlib import Path

import psutil
import pytest
from processes import command_lines

from webviz.data.memory import DECODING, MemoryBudget
from webviz_urdf import (
    Loading,
    LoadingStopped,
    LoadRequest,
    Robot,
    RobotDescriptionError,
    load_robot,
    loading,
)

Loadings = Callable[[str], tuple[Loading, Future[Robot]]]
BOX = (
    "<robot name='r'><link name='l'><visual><geometry><box size='1 1 1'/></geometry></visual>"
    "</link></robot>"
)


def with_mesh(path: Path) -> str:
    """A robot of three links; the second has the mesh."""
    links = "".join(
        f"<link name='{name}'><visual><geometry>{shape}</geometry></visual></link>"
        for name, shape in (
            ("first", "<sphere radius='1'/>"),
            ("mesh", f"<mesh filename='{path}'/>"),
            ("last", "<box size='1 1 1'/>"),
        )
    )
    joints = "".join(
        f"<joint name='{name}' type='fixed'><parent link='first'/><child link='{name}'/></joint>"
        for name in ("mesh", "last")
    )
    return f"<robot name='r'>{links}{joints}</robot>"


def processes() -> list[psutil.Process]:
    """Return the living processes that load robots."""
    return [child for child, line in command_lines().items() if "webviz_urdf.loader" in line]


@pytest.fixture
def start(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Loadings]:
    """Run a `Loading` in a thread; every test begins without a spare process."""
    monkeypatch.setenv("WEBVIZ_MESH_ROOT", str(tmp_path))
    loading.end_spare()
    with ThreadPoolExecutor() as pool:
        begun: list[Loading] = []

        def start(text: str) -> tuple[Loading, Future[Robot]]:
            begun.append(Loading(LoadRequest(text=text)))
            return begun[-1], pool.submit(begun[-1].run)

        yield start
        for each in begun:
            each.stop()
    loading.end_spare()


def wait_for_mesh(begun: Loading) -> psutil.Process:
    """The process, at work on the mesh."""
    deadline = time.monotonic() + 60
    while begun.at[2] != "mesh":
        assert time.monotonic() < deadline, begun.at
        time.sleep(0.002)
    (process,) = processes()
    return process


def test_a_process_gives_the_same_robot_and_is_kept_for_the_next(
    start: Loadings, tmp_path: Path, slow_dae: Path
) -> None:
    text = with_mesh(slow_dae)
    robot = start(text)[1].result(60)
    expected = load_robot(text, loading.Resolver([tmp_path]))
    assert [s.node for link in robot.links.values() for s in link.visuals] == [
        s.node for link in expected.links.values() for s in link.visuals
    ]
    (process,) = processes()
    start(BOX)[1].result(60)
    assert processes() == [process]
    assert b"trimesh" not in pickle.dumps(expected)  # which viewers would import, and scipy


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSTOP])
def test_a_mesh_that_ends_or_halts_the_process_is_missing_and_the_rest_is_shown(
    start: Loadings, slow_dae: Path, monkeypatch: pytest.MonkeyPatch, number: signal.Signals
) -> None:
    monkeypatch.setattr(loading, "DEADLINE_S", 5.0)
    begun, future = start(with_mesh(slow_dae))
    process = wait_for_mesh(begun)
    process.send_signal(number)
    robot = future.result(60)
    assert [name for name, link in robot.links.items() if link.visuals] == ["first", "last"]
    (missing,) = robot.missing
    assert (missing.link, missing.uri) == ("mesh", str(slow_dae))
    assert ("ended the process" if number == signal.SIGKILL else "took longer") in missing.reason


def test_a_mesh_that_needs_more_memory_than_loading_may_take_is_missing(
    start: Loadings, tmp_path: Path
) -> None:
    bomb = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "buffers": [{"uri": "data:application/octet-stream;base64,AAAA", "byteLength": 3}],
        "bufferViews": [{"buffer": 0, "byteLength": 3}],
        "accessors": [{"componentType": 5126, "count": 1 << 30, "type": "VEC3"}],
    }
    path = tmp_path / "bomb.gltf"
    path.write_text(json.dumps(bomb))
    robot = start(with_mesh(path))[1].result(60)
    assert "exceeds the memory limit" in robot.missing[0].reason
    assert robot.links["last"].visuals


def test_a_mesh_that_needs_more_than_usual_is_loaded_with_more(
    start: Loadings, slow_dae: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(loading, "USUAL_MEMORY", 30_000_000)
    assert not start(with_mesh(slow_dae))[1].result(60).missing
    assert processes() == []  # it would keep what it has taken


def test_loading_waits_for_the_memory_that_it_may_take(
    start: Loadings, slow_dae: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(loading, "DECODING", MemoryBudget(400_000_000))
    begun, slow = start(with_mesh(slow_dae))
    process = wait_for_mesh(begun)
    process.suspend()
    waiting, stopped = start(BOX)
    waiting.stop()
    with pytest.raises(LoadingStopped):
        stopped.result(60)
    _, last = start(BOX)
    assert processes() == [process]
    process.resume()
    assert not slow.result(60).missing
    assert last.result(60).name == "r"


def test_a_robot_over_the_memory_budget_is_refused(
    start: Loadings, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(loading, "DECODING", MemoryBudget(1_000_000_000, 0))
    with pytest.raises(
        RobotDescriptionError,
        match=r"^The robot takes 0 MB of memory; 0 MB of 0 MB are left\. Simplify",
    ):
        start(BOX)[1].result(60)


def test_a_robot_gives_its_memory_back(start: Loadings) -> None:
    before = DECODING.room
    robot = start(BOX)[1].result(60)
    assert DECODING.room < before
    del robot
    gc.collect()
    assert DECODING.room >= before


def test_a_description_that_hangs_the_process_is_refused(
    start: Loadings, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(loading, "START_S", 0.0)
    with pytest.raises(RobotDescriptionError, match="took longer than 0 s"):
        start(BOX)[1].result(60)
    assert processes() == []


def test_an_invalid_description_is_reported_and_the_process_kept(start: Loadings) -> None:
    with pytest.raises(RobotDescriptionError, match="is empty"):
        start("")[1].result(60)
    assert len(processes()) == 1


def test_loading_that_is_stopped_ends_at_once_with_its_process(
    start: Loadings, slow_dae: Path
) -> None:
    begun, future = start(with_mesh(slow_dae))
    process = wait_for_mesh(begun)
    os.kill(process.pid, signal.SIGSTOP)
    begun.stop()
    with pytest.raises(LoadingStopped):
        future.result(60)
    assert not process.is_running()


def test_loading_that_was_stopped_before_it_began_never_begins(start: Loadings) -> None:
    begun = Loading(LoadRequest(text=BOX))
    begun.stop()
    with pytest.raises(LoadingStopped):
        begun.run()


def test_robots_are_loaded_side_by_side(start: Loadings, slow_dae: Path) -> None:
    begun, slow = start(with_mesh(slow_dae))
    process = wait_for_mesh(begun)
    process.suspend()
    assert start(BOX)[1].result(60).name == "r"
    assert not slow.done()
    process.resume()
    assert not slow.result(60).missing
    assert len(processes()) == 1


def test_a_description_file_is_a_regular_file(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "robot.urdf")
    with pytest.raises(RobotDescriptionError, match="not a regular file"):
        Loading(LoadRequest(path=str(tmp_path / "robot.urdf"))).run()

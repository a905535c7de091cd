"""The systems: how each is started, and how a client watches it."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from side_by_side.scenes import Scene
from side_by_side.watchers import FileWatcher, FoxgloveWatcher, ViserWatcher, Watcher

Watch = Callable[[int, Path, Scene | None, bool], Watcher]
"""Function of the port, the folder of the run, what shall be recognised, and whether it stops
reading."""


@dataclass(frozen=True)
class System:
    """A system under test.

    Args:
        name: of the command line.
        title: for people.
        command: what to start, given the scene and the folder of the run.
        watch: makes a client.
        packages: whose versions are told.
        is_served: whether there are clients at all.
    """

    name: str
    title: str
    command: Callable[[Scene, Path], Sequence[str]]
    watch: Watch
    packages: tuple[str, ...]
    is_served: bool = True


def _module(name: str) -> Callable[[Scene, Path], Sequence[str]]:
    def command(scene: Scene, folder: Path) -> Sequence[str]:
        topics = [f"{topic}={kind}" for topic, kind in scene.topics.items()]
        return [sys.executable, "-m", f"side_by_side.systems.{name}", *topics]

    return command


def _floor(scene: Scene, folder: Path) -> Sequence[str]:
    python, m, module, *topics = _module("floor")(scene, folder)
    return [python, m, module, str(folder / "floor.bin"), *topics]


def _config(scene: Scene, folder: Path) -> str:
    config = folder / "scene.yaml"
    config.write_text(scene.config)
    return str(config)


def _bridged(scene: Scene, folder: Path) -> Sequence[str]:
    python, m, module, *topics = _module("bridged")(scene, folder)
    return [python, m, module, _config(scene, folder), *topics]


def _webviz(scene: Scene, folder: Path) -> Sequence[str]:
    # The others do not remember the last minute either.
    options = ["--port", "0", "--no-autosave", "--set", "memory.seconds=0"]
    return [sys.executable, "-m", "webviz", "-d", _config(scene, folder), *options]


def _traced(scene: Scene, folder: Path) -> Sequence[str]:
    python, m, _, *arguments = _webviz(scene, folder)
    return [python, m, "side_by_side.systems.traced", str(folder / "steps.txt"), *arguments]


def _watch_viser(port: int, folder: Path, scene: Scene | None, stalls: bool) -> Watcher:
    return ViserWatcher(port, scene, stalls)


def _watch_foxglove(port: int, folder: Path, scene: Scene | None, stalls: bool) -> Watcher:
    return FoxgloveWatcher(port, scene, stalls)


def _watch_floor(port: int, folder: Path, scene: Scene | None, stalls: bool) -> Watcher:
    return FileWatcher(folder / "floor.bin")


SYSTEMS = {
    system.name: system
    for system in (
        System("floor", "rclpy alone", _floor, _watch_floor, ("rclpy",), is_served=False),
        System("webviz", "webviz", _webviz, _watch_viser, ("ros-webviz", "viser")),
        System(
            "bridged",
            "webviz behind foxglove-sdk",
            _bridged,
            _watch_viser,
            ("ros-webviz", "viser", "foxglove-sdk"),
        ),
        System("plain", "plain viser", _module("plain"), _watch_viser, ("viser",)),
        System("foxglove", "foxglove-sdk", _module("foxglove"), _watch_foxglove, ("foxglove-sdk",)),
    )
}
TRACED = System("traced", "webviz, traced", _traced, _watch_viser, ("ros-webviz", "viser"))
"""webviz with a trace of its slow steps, which takes time itself."""

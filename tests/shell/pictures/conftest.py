"""A robot that was recorded while it drove along x, one metre a second."""

from __future__ import annotations

import functools
import signal
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import playwright.sync_api as playwright
import pytest
from bags import START_NS, Bag, ns

from webviz.shell.cli import main as cli
from webviz.shell.pictures import capture
from webviz.shell.pictures.headless_renderer import HeadlessRenderer
from webviz.shell.testing import header

SIZE = (320, 240)
CONFIG = Path(__file__).parent / "top.yaml"
SECONDS = 6
SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def write_run(path: Path) -> Path:
    """Scans of three points around the robot, ten a second, and its transforms."""
    bag = Bag()
    bag.add("/scan", "sensor_msgs/msg/LaserScan", best_effort=True)
    bag.transform(0, "map", "odom", static=True)
    for step in range(10 * SECONDS + 1):
        at_s = step / 10
        bag.transform(at_s, "odom", "base", x=at_s)
        scan = {
            "header": header("base", START_NS + ns(at_s)),
            "angle_min": -0.2,
            "angle_max": 0.2,
            "angle_increment": 0.2,
            "range_max": 10.0,
            "ranges": [0.1, 0.1, 0.1],
        }
        bag.put(at_s, "/scan", scan)
    return bag.write(path)


@pytest.fixture(scope="session")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The bag."""
    return write_run(tmp_path_factory.mktemp("bags") / "run")


@pytest.fixture(scope="package")
def renderer(browser: playwright.Browser) -> Iterator[HeadlessRenderer]:
    """One tab for all pictures."""
    renderer = HeadlessRenderer(browser, *SIZE)
    yield renderer
    renderer.close()


@dataclass(frozen=True)
class CommandResult:
    """Exit status and output of a command."""

    status: int
    output: str
    errors: str


@pytest.fixture
def screenshot(
    renderer: HeadlessRenderer,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capfd: pytest.CaptureFixture[str],
) -> Iterator[Callable[..., CommandResult]]:
    """Run `webviz screenshot` in this process, by the tab of all pictures, in the test's folder.

    To start Python, a browser and a page takes longer than most pictures.
    """
    shared = functools.partial(capture.pictures, renderer=renderer)
    monkeypatch.setattr(capture, "pictures", shared)
    monkeypatch.setenv("WEBVIZ_MESH_ROOT", "")  # what --mesh-root adds is taken back
    monkeypatch.chdir(tmp_path)
    handlers = {number: signal.getsignal(number) for number in SIGNALS}

    def screenshot(*arguments: str, config: Path | None = CONFIG) -> CommandResult:
        options = () if config is None else ("-d", str(config))
        status = cli(["screenshot", *options, *arguments])
        printed = capfd.readouterr()
        return CommandResult(status, printed.out, printed.err)

    yield screenshot
    for number, handler in handlers.items():
        signal.signal(number, handler)

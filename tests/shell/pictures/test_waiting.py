"""Displays that load or wait: pictures wait for them, and neither is a warning."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest
from bags import START_NS, Bag, ns

from webviz import Context, Display, Sample
from webviz.api.status import Level
from webviz.files import opening
from webviz.files.config import Config, Settings
from webviz.shell.doctor.scene import NoScene
from webviz.shell.pictures import offline_viewer
from webviz.shell.pictures.offline_viewer import OfflineViewer
from webviz.shell.testing import header
from webviz.sources.bag.history import BagHistory
from webviz.sources.player import Player

SCAN = "fixed_frame: map\ndisplays: [{type: LaserScan, topic: /scan}]"
SHORT_S = 0.5
PATIENCE_S = 60.0


class Loading(Display):
    """A dot that a worker computes until it is let go."""

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        if ctx.background("dot", _computed) is not None:
            ctx.points("dot", [[0.0, 0.0, 0.0]], (1, 1, 1), 0.1)


GO = threading.Event()


def _computed() -> bool:
    return GO.wait(PATIENCE_S)


@pytest.fixture(autouse=True)
def let_go() -> Iterator[None]:
    """Nothing computes after a test."""
    GO.clear()
    yield
    GO.set()


@contextlib.contextmanager
def open_viewer(config: Config, bag: Path) -> Iterator[tuple[OfflineViewer, Player]]:
    """A viewer of a bag at its end."""
    with contextlib.closing(Player(BagHistory(bag))) as source:
        viewer = OfflineViewer(config, source, NoScene())  # pyright: ignore[reportArgumentType]
        with contextlib.closing(viewer.loop):
            viewer.seek(source, source.history.end_ns, time.monotonic() + PATIENCE_S)
            yield viewer, source


def of_a_display(display: Display) -> Config:
    return Config(Settings(fixed_frame="map"), [display])


def write_bag(path: Path, last_scan_s: float = 1.0) -> Path:
    """Scans and transforms of a second, the scan at the end perhaps without its transform."""
    bag = Bag()
    bag.add("/scan", "sensor_msgs/msg/LaserScan")
    for at_s in (0.0, 0.5, 1.0):
        bag.transform(at_s, "map", "base")
    stamp_ns = START_NS + ns(last_scan_s)
    scan = {"header": header("base", stamp_ns), "range_max": 10.0, "ranges": [1.0, 1.0]}
    bag.put(1.0, "/scan", scan)
    return bag.write(path)


def test_a_display_still_loading_at_the_time_out_gets_more_time(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(offline_viewer, "LOADING_S", SHORT_S)
    with open_viewer(of_a_display(Loading(name="Dot")), write_bag(tmp_path / "bag")) as (viewer, _):
        began = time.monotonic()
        readiness = viewer.wait(["Dot"], deadline=began)
        assert time.monotonic() - began >= SHORT_S
        assert readiness.statuses["Dot"].level is Level.IDLE
        assert not readiness.is_ok, "the time for it ran out"
        monkeypatch.setattr(offline_viewer, "LOADING_S", PATIENCE_S)
        timer = threading.Timer(SHORT_S, GO.set)
        timer.start()
        readiness = viewer.wait(["Dot"], deadline=began)
        timer.join()
        assert (readiness.statuses["Dot"].level, readiness.is_ok) == (Level.OK, True)


def test_a_message_without_transforms_at_the_end_of_a_bag_is_ok(tmp_path: Path) -> None:
    config = opening.parse(SCAN, "scan.yaml")
    with open_viewer(config, write_bag(tmp_path / "bag", last_scan_s=1.05)) as (viewer, _):
        readiness = viewer.wait(["LaserScan"], deadline=time.monotonic() + PATIENCE_S)
    assert readiness.statuses["LaserScan"].level is Level.IDLE
    assert readiness.is_ok

"""Robots with connections in a whole viewer."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest
from bridges import FoxgloveServer, foxglove_server
from waiting import until

import webviz
from webviz.api.status import Level
from webviz.commands import Open
from webviz.shell import live_source
from webviz.shell.app import running
from webviz.shell.cli import main
from webviz.sources.bag.files import BagFiles

ROBOTS = """\
version: 1
fixed_frame: odom
robots:
- {{namespace: r1, connection: "{0}", shared: [odom]}}
- {{namespace: r2, connection: "{1}", shared: [odom]}}
displays:
- {{type: LaserScan, name: "{{robot}}", topic: "/{{robot}}/scan"}}
"""


@pytest.fixture(scope="module")
def servers() -> Iterator[tuple[FoxgloveServer, FoxgloveServer]]:
    with foxglove_server() as one, foxglove_server(0, "ahead=-2.5") as two:
        yield one, two


@pytest.fixture
def config(
    servers: tuple[FoxgloveServer, FoxgloveServer], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Path:
    """The config of a fleet, on a machine without ROS."""
    monkeypatch.setattr(live_source, "is_alone", lambda robots: any(robots))
    monkeypatch.setattr(running, "is_alone", lambda robots: any(robots))
    path = tmp_path / "fleet.yaml"
    path.write_text(ROBOTS.format(*(server.url for server in servers)))
    return path


def clock_problem(viewer: webviz.Viewer) -> str:
    """The problem with the clocks, "" if there is none; a busy machine may delay messages."""
    clocks = viewer.statuses.get("Clocks")
    return clocks.text if clocks and clocks.level > Level.OK else ""


def test_robots_are_drawn_remembered_and_saved_together(config: Path, tmp_path: Path) -> None:
    with webviz.Viewer(config, port=0) as viewer:
        viewer.attend(60)

        def is_drawn() -> bool:
            viewer.attend(60)
            statuses = viewer.statuses
            status = getattr(statuses.get("Connection to r2"), "text", "")
            behind = re.search(r"clock is ([\d.]+) s behind", status)
            return (
                behind is not None
                and float(behind[1]) == pytest.approx(2.5, abs=0.05)  # as far as links tell
                and all(display.status.level is Level.OK for display in viewer)
                and {"r1/laser", "r2/laser"} <= set(viewer.frames)
            )

        until(is_drawn, lambda: (viewer.statuses, [d.statuses for d in viewer]))
        until(lambda: not clock_problem(viewer), lambda: viewer.statuses)
        viewer.rewind(0.5)
        assert viewer.state.playback
        assert viewer.state.playback.is_live is False
        viewer.return_to_live()
        folder = viewer.save_last(folder=tmp_path / "saved")
        with closing(BagFiles([folder])) as bag:
            topics = {channel.topic for channel in bag.channels}
        assert {"/r1/scan", "/r2/scan", "/r1/tf", "/r2/tf_static"} <= topics


def test_a_config_that_is_opened_later_is_connected(config: Path, tmp_path: Path) -> None:
    later = tmp_path / "later.yaml"
    text = config.read_text().replace("r2", "r3")
    broken = '- {namespace: r4, connection: "ws://"}\n'
    later.write_text(text.replace("displays:", broken + "displays:"))
    with webviz.Viewer(config, port=0) as viewer:
        viewer.attend(60)
        until(lambda: "r2/laser" in viewer.frames)
        viewer.do(Open(str(later)))

        def is_drawn() -> bool:
            viewer.attend(60)
            levels = {each.name: each.status.level for each in viewer}
            return (levels["r1"], levels.get("r3")) == (Level.OK, Level.OK)

        until(is_drawn, lambda: (viewer.statuses, [d.statuses for d in viewer]))
        assert "Connection to r2" not in viewer.statuses
        assert "not the address of a bridge" in viewer.statuses["Connection to r4"].text


def test_a_rule_is_tested_over_all_connections(
    config: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(config.parent)
    files = sorted(config.parent.iterdir())
    rules = [word for limit in (1, 1000) for word in ("--rule", f"/r2/scan.rate > {limit}")]
    assert main(["test", "-d", str(config), "--seconds", "2", *rules]) != 0
    assert "1 of 2 rules hold" in capsys.readouterr().out
    assert sorted(config.parent.iterdir()) == files  # no recording

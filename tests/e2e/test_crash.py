"""A viewer that is killed: its next start brings back what was set up."""

from __future__ import annotations

import signal
from collections.abc import Callable
from pathlib import Path

import pytest
from pages import COARSE
from program import Program
from side import Side

from webviz.shell.pictures.browser import Page

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

CONFIG = "displays: [{type: Grid, name: Floor}]\n"


def test_a_killed_viewer_restores_what_was_not_saved(
    start: Callable[..., Program], open_page: Callable[..., Page], tmp_path: Path
) -> None:
    config, state = tmp_path / "lab.yaml", tmp_path / "state"
    config.write_text(CONFIG)

    def begin() -> Program:
        arguments = ("webviz", "--port", "0", "-d", str(config))
        return start(*arguments, env={"XDG_STATE_HOME": str(state)})

    viewer = begin()
    page = open_page(viewer.url(), resolution=COARSE)
    Side(page).select("Floor")
    page.tab.keyboard.press("F2")
    page.tab.keyboard.type("Ground")
    page.tab.keyboard.press("Enter")
    page.wait_for(lambda: any(state.rglob("lab-*.yaml")), "the session")
    page.close()
    assert viewer.end(signal.SIGKILL) == -signal.SIGKILL

    viewer = begin()
    page = open_page(viewer.url(), resolution=COARSE)
    viewer.wait_for(r"Restored 1 display of the last session. Start with --no-restore to see the")
    page.tab.get_by_text("Restored 1 display of the last session.").wait_for()
    tree = page.tab.get_by_role("tree")
    tree.get_by_text("Ground").wait_for()
    page.tab.locator(".wv-toast").get_by_role("button", name="Undo").click()
    tree.get_by_text("Floor").wait_for()
    assert config.read_text() == CONFIG
    assert viewer.end() == 0
    assert not any(state.rglob("lab-*.yaml"))

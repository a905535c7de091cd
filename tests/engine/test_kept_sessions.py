"""Unsaved changes are kept, and restored by the next viewer of the same config."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from bench import Bench, Benches

from webviz.api.roles import Role
from webviz.commands import (
    ChangeView,
    Export,
    FocusDisplay,
    FocusFrame,
    Identify,
    Load,
    LookUpTransform,
    RemoveDisplay,
    ResetView,
    Save,
    SaveImage,
    Select,
    SetFixedFrame,
    SetProperty,
    ShowView,
    Undo,
    WriteDisplays,
)
from webviz.engine.commands import NodePicks, Sender
from webviz.files.opening import load
from webviz.files.sessions import MAX_VIEWERS, Sessions
from webviz.server.access import rules
from webviz_displays.axes import Axes


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return tmp_path / "default.yaml"


@pytest.fixture
def start(bench: Benches, file: Path) -> Callable[..., Any]:
    """Start a viewer of one and the same config."""

    def start(**options: Any) -> Any:
        b = bench(Axes(name="A"), Axes(name="B"), session=file, **options)
        b.turn()
        return b

    return start


def frames(b: Bench) -> list[str]:
    return [row.name for row in b.viewer.state().rows]


def test_unsaved_changes_are_restored_and_undone_in_one_step(start: Benches, file: Path) -> None:
    b = start()
    b.do(SetProperty("display1", "length", 2.5))
    b.do(RemoveDisplay("display2"))
    b.viewer.close()
    assert file.stat().st_mode & 0o077 == 0
    b = start()
    state = b.viewer.state()
    assert (len(state.rows), b.display(Axes).length) == (1, 2.5)
    assert state.history.undo[0].label == "Restore 1 display"
    assert state.file.is_changed
    b.viewer.close()
    b = start()
    b.do(Undo())
    assert frames(b) == ["A", "B"]
    assert not b.viewer.state().file.is_changed
    b.viewer.close()
    assert not file.exists(), "there is nothing to keep"


def test_a_viewer_that_changes_nothing_keeps_nothing(start: Benches, file: Path) -> None:
    start().viewer.close()
    assert not file.exists()


def test_saved_changes_are_not_kept_in_the_session(
    bench: Benches, file: Path, tmp_path: Path
) -> None:
    config = tmp_path / "lab.yaml"
    config.write_text("displays: [{type: Axes, name: A}]\n")
    before = config.read_text()

    def start() -> Any:
        b = bench(*load(config).displays, session=file, path=config)
        b.turn()
        return b

    b = start()
    b.do(SetProperty("display1", "length", 2.5))
    b.viewer.close()
    assert config.read_text() == before, "only Save writes the user's file"
    b = start()
    assert b.viewer.state().rows[0].display.length == 2.5
    assert b.ask(Save()) == "Saved lab.yaml."
    b.viewer.close()
    assert not file.exists()
    assert start().viewer.state().history.undo == ()


def test_a_config_uploaded_by_a_browser_is_restored_without_a_file(start: Benches) -> None:
    b = start()
    b.ask(Load("fixed_frame: odom\ndisplays: [{type: Grid, name: Floor}]", "mine.yaml"))
    b.viewer.close()
    state = start().viewer.state()
    assert [row.name for row in state.rows] == ["Floor"]
    assert (state.fixed_frame, state.file.path) == ("odom", "")


def test_a_session_of_another_config_is_set_aside(
    start: Benches, bench: Benches, file: Path
) -> None:
    b = start()
    b.do(SetProperty("display1", "length", 2.5))
    b.viewer.close()
    other = bench(Axes(name="Other"), session=file)
    other.turn()
    assert frames(other) == ["Other"]
    status = other.viewer.state().statuses["Session"].text
    assert "The config or its options have changed since." in status
    [axes, _] = load(file.with_name("default.old.yaml")).displays
    assert isinstance(axes, Axes)
    assert axes.length == 2.5


def test_another_fixed_frame_at_the_start_holds(start: Benches) -> None:
    b = start()
    b.do(SetProperty("display1", "length", 2.5))
    b.do(SetFixedFrame("base"))
    b.viewer.close()
    assert start().viewer.state().fixed_frame == "base"
    b = start(fixed_frame="odom")
    assert b.viewer.state().fixed_frame == "odom"
    assert b.display(Axes).length == 2.5


def test_no_restore_shows_the_config_and_loses_nothing(start: Benches, file: Path) -> None:
    b = start()
    b.do(RemoveDisplay("display2"))
    b.viewer.close()
    b = start(restore=False)
    assert frames(b) == ["A", "B"]
    assert b.viewer.state().statuses.get("Session") is None
    assert file.with_name("default.old.yaml").exists()


@pytest.mark.parametrize(
    "damage",
    [
        lambda text: "",
        lambda text: text[: len(text) // 2] + "\0",
        lambda text: text.replace('{"path"', '{"pat'),
        lambda text: text.partition("\n")[0] + "\n: [",
        lambda text: text.partition("\n")[2],
    ],
)
def test_a_damaged_session_is_set_aside_and_reported(
    start: Benches, file: Path, damage: Callable[[str], str]
) -> None:
    b = start()
    b.do(RemoveDisplay("display2"))
    b.viewer.close()
    file.write_text(damage(file.read_text()))
    b = start()
    assert frames(b) == ["A", "B"]
    assert "The last session was not restored: " in b.viewer.state().statuses["Session"].text
    assert file.with_name("default.old.yaml").exists()
    b.do(RemoveDisplay("display1"))
    b.viewer.close()
    assert frames(start()) == ["B"]


def test_viewers_at_once_keep_sessions_of_their_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    sessions = Sessions()
    claims = [sessions.claim(None) for _ in range(MAX_VIEWERS)]
    paths = [claim.path for claim in claims if claim]
    assert [path.name for path in paths[:2]] == ["default.yaml", "default-2.yaml"]
    assert len(set(paths)) == MAX_VIEWERS
    assert sessions.claim(None) is None
    assert "8 viewers show this config already" in caplog.text
    assert claims[1]
    claims[1].close()
    again = sessions.claim(None)
    assert again
    assert again.path == paths[1]
    for claim in (claims[0], again, *claims[2:]):
        assert claim
        claim.close()


def test_configs_of_one_name_have_sessions_of_their_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", str(tmp_path))
    sessions, paths = Sessions(), set[Path]()
    for config in (Path("a/lab.yaml"), Path("b/lab.yaml"), Path("b/lab.rviz"), None):
        claim = sessions.claim(config)
        assert claim
        paths.add(claim.path)
        claim.close()
    assert len(paths) == 4


@pytest.mark.skipif(not Path("/dev/null").exists(), reason="no /dev/null")
def test_a_folder_that_cannot_be_written_is_logged_once(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setenv("XDG_STATE_HOME", os.devnull)
    assert Sessions().claim(None) is None
    assert len(caplog.records) == 1


def test_watchers_leave_nothing_in_a_session(start: Benches, file: Path) -> None:
    commands = (
        ChangeView("distance", 3.0),
        Export(lambda text: None),
        FocusDisplay("display1"),
        FocusFrame("map"),
        Identify(NodePicks("display1", "", ())),
        LookUpTransform("map", "base"),
        ResetView(),
        SaveImage(),
        Select(),
        ShowView("A"),
        WriteDisplays(("display1",)),
    )
    b = start()
    for command in commands:
        b.until_done(b.viewer.enqueue(command, Sender(1)))
    b.viewer.close()
    assert not file.exists()
    allowed = {kind for kind, role in rules.commands().items() if role is Role.WATCHER}
    assert allowed == set(map(type, commands))

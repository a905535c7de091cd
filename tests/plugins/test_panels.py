"""Panels of plug-ins in the config: their list, their properties, and edits of their file."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from webviz.api import registry
from webviz.engine.commands import Load, ReloadPlugin, SetPanelProperty, Undo
from webviz.engine.plugins import load
from webviz.files.config import ConfigError, Unreadable, document
from webviz.files.config.overrides import override
from webviz.files.opening import parse

CODE = """\
from typing import Annotated
from webviz import Panel, Prop

class Notes(Panel):
    most: Annotated[int, Prop(ge=1)] = 3

class Jobs(Panel):
    place = 50
"""
LISTED = "displays: []\npanels:\n- {type: Notes, most: 7}\n"


@pytest.fixture
def file(tmp_path: Path) -> Iterator[Path]:
    path = tmp_path / "panels.py"
    path.write_text(CODE)
    load(path)
    yield path
    registry.register(str(path), {})


def panels(config: Any) -> list[tuple[str, Any]]:
    """Name and property of each."""
    return [(each.name, getattr(each, "most", None)) for each in config.panels]


def carried_out(b: Any, command: Any) -> Any:
    """The answer to a command, which may need a thread and several turns."""
    answer = b.viewer.enqueue(command)
    give_up = time.monotonic() + 30
    while not answer.done() and time.monotonic() < give_up:
        b.turn()
    return answer


def test_without_a_list_there_are_all_of_them_in_the_order_of_their_tabs(file: Path) -> None:
    config = parse("displays: []\n", "x.yaml")
    assert panels(config) == [("Jobs", None), ("Notes", 3)]
    assert "panels" not in document(config)


def test_what_a_file_says_of_panels_is_read_overridden_and_written_again(file: Path) -> None:
    config = parse(LISTED, "x.yaml")
    assert panels(config) == [("Notes", 7)]
    assert document(config)["panels"] == [{"type": "Notes", "most": 7}]
    assert panels(override(config, ["panels.Notes.most=9"])) == [("Notes", 9)]
    with pytest.raises(ConfigError, match=r"no panel `Note`, did you mean `Notes`\?"):
        override(config, ["panels.Note.most=9"])


def test_a_panel_that_cannot_be_used_is_kept_with_the_reason(bench: Callable[..., Any]) -> None:
    config = parse("displays: []\npanels:\n- {type: Notes, most: 7}\n", "x.yaml")
    (panel,) = config.panels
    assert isinstance(panel, Unreadable)
    assert "panels[0].type: unknown panel type `Notes`" in panel.reason
    assert document(config)["panels"] == [{"type": "Notes", "most": 7}]
    b = bench(strict=False)
    carried_out(b, Load(LISTED, "x.yaml"))
    assert "unknown panel type" in b.viewer.state().statuses["Panels"].text


def test_a_property_is_set_saved_undone_and_kept_when_the_file_is_edited(
    file: Path, bench: Callable[..., Any]
) -> None:
    b = bench(strict=False)

    def do(command: Any) -> Any:
        return carried_out(b, command).exception() or panels(b.viewer.config())

    assert do(SetPanelProperty("Notes", "most", 5)) == [("Jobs", None), ("Notes", 5)]
    assert "most: expected >= 1, got 0" in str(do(SetPanelProperty("Notes", "most", 0)))
    assert do(Undo()) == [("Jobs", None), ("Notes", 3)]
    do(SetPanelProperty("Notes", "most", 6))
    tab = b.viewer.state().panels[1]
    file.write_text(CODE.replace("class Jobs", "class Tasks"))
    assert do(ReloadPlugin(file)) == [("Notes", 6), ("Tasks", None)]
    again = b.viewer.state().panels[0]
    assert (again.id, type(again.panel) is type(tab.panel)) == (tab.id, False)
    assert do(Load(LISTED, "x.yaml")) == [("Notes", 7)]
    file.write_text(CODE)
    assert do(ReloadPlugin(file)) == [("Notes", 7), ("Jobs", None)], "a new one is shown"

"""Panels of plug-ins in the config: their list, their properties, and edits of their file."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from bench import Benches

from webviz.api import registry
from webviz.commands import (
    AddPanel,
    CallService,
    Load,
    OpenPanels,
    Publish,
    ReloadPlugin,
    RemovePanel,
    SetPanelProperty,
    Undo,
)
from webviz.data.messages import encode
from webviz.engine.pipeline.plugins import load
from webviz.files.config import ConfigError, Unreadable, document
from webviz.files.config.overrides import override
from webviz.files.opening import parse
from webviz.shell.testing.remembering_graph import RememberingGraph

CODE = """\
from typing import Annotated
from webviz import Panel, Prop

class Notes(Panel):
    most: Annotated[int, Prop(ge=1)] = 3

class Jobs(Panel):
    pass
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


def test_without_a_list_there_are_all_of_them_in_the_order_of_their_tabs(file: Path) -> None:
    config = parse("displays: []\n", "x.yaml")
    assert panels(config) == [("Jobs", None), ("Notes", 3)]
    assert "panels" not in document(config)


def test_panels_of_a_file_are_read_overridden_and_written_again(file: Path) -> None:
    config = parse(LISTED, "x.yaml")
    assert panels(config) == [("Notes", 7)]
    assert document(config)["panels"] == [{"type": "Notes", "most": 7}]
    assert panels(override(config, ["panels.Notes.most=9"])) == [("Notes", 9)]
    with pytest.raises(ConfigError, match=r"no panel `Note`, did you mean `Notes`\?"):
        override(config, ["panels.Note.most=9"])


def test_a_panel_that_cannot_be_used_is_kept_with_the_reason(bench: Benches) -> None:
    config = parse("displays: []\npanels:\n- {type: Notes, most: 7}\n", "x.yaml")
    (panel,) = config.panels
    assert isinstance(panel, Unreadable)
    assert "panels[0].type: unknown panel type `Notes`" in panel.reason
    assert document(config)["panels"] == [{"type": "Notes", "most": 7}]
    b = bench(strict=False)
    state = b.do(Load(LISTED, "x.yaml"))
    assert "unknown panel type" in state.statuses["Panels"].text


def test_a_property_is_set_saved_undone_and_kept_when_the_file_is_edited(
    file: Path, bench: Benches
) -> None:
    b = bench(strict=False)

    def do(command: Any) -> Any:
        return panels(b.do(command) and b.viewer.config())

    assert do(SetPanelProperty("Notes", "most", 5)) == [("Jobs", None), ("Notes", 5)]
    assert "most: expected >= 1, got 0" in b.refusal(SetPanelProperty("Notes", "most", 0))
    changed = b.viewer.state().panels[1].panel
    assert do(Undo()) == [("Jobs", None), ("Notes", 3)]
    assert b.viewer.state().panels[1].panel is changed, "it keeps what it has read"
    do(SetPanelProperty("Notes", "most", 6))
    tab = b.viewer.state().panels[1]
    file.write_text(CODE.replace("class Jobs", "class Tasks"))
    assert do(ReloadPlugin(file)) == [("Notes", 6), ("Tasks", None)]
    again = b.viewer.state().panels[0]
    assert (again.id, type(again.panel) is type(tab.panel)) == (tab.id, False)
    assert do(Load(LISTED, "x.yaml")) == [("Notes", 7)]
    file.write_text(CODE)
    assert do(ReloadPlugin(file)) == [("Notes", 7), ("Jobs", None)], "a new one is shown"


WIRED = """\
from webviz import Panel
from webviz.commands import CallService, Publish

class Wired(Panel):
    heard = []

    def subscriptions(self):
        return {"/words": "std_msgs/msg/String"}

    def publications(self):
        return {"/answers": "std_msgs/msg/String"}

    def take(self, topic, message):
        self.heard.append((topic, message.data))
"""


def test_an_open_panel_reads_topics_and_is_advertised(tmp_path: Path, bench: Benches) -> None:
    path = tmp_path / "panels.py"
    path.write_text(WIRED)
    wired: Any = load(path)["Wired"]
    try:
        b = bench(graph=RememberingGraph())
        text = ("/words", "std_msgs/msg/String", {"data": "one"})
        b.publish(*text)
        b.turn()
        assert "/words" not in b.source.subscriptions
        assert wired.heard == []
        b.do(OpenPanels(frozenset({"Wired"})))
        assert b.source.subscriptions["/words"].type == "std_msgs/msg/String"
        assert "/answers" in {advertisement.topic for advertisement in b.graph.advertised}
        b.publish(*text)
        b.publish("/words", "std_msgs/msg/String", {"data": "two"})
        b.source.put("/words", "std_msgs/msg/String", b"\x00\x01\x00\x00\xff")
        b.turn()
        assert wired.heard == [("/words", "one"), ("/words", "two")]
        b.do(Publish("/answers", "std_msgs/msg/String", {"data": "yes"}))
        ((advertisement, message),) = b.graph.published
        assert (advertisement.topic, message.data) == ("/answers", "yes")
        b.do(OpenPanels(frozenset()))
        assert "/words" not in b.source.subscriptions
    finally:
        registry.register(str(path), {})


FORMER = """\
from webviz import Panel

class Asked(Panel):
    on_request = True

class Later(Panel):
    pass

class Sooner(Panel):
    place = 50
    heard = []

    def subscriptions(self):
        return {"/words": "std_msgs/msg/String"}

    def receive(self, topic, message, received_ns):
        self.heard.append((message.data, received_ns > 0))
"""


def test_panels_with_names_from_before_go_on(tmp_path: Path, bench: Benches) -> None:
    path = tmp_path / "panels.py"
    path.write_text(FORMER)
    try:
        sooner: Any = load(path)["Sooner"]
        config = parse("displays: []\n", "x.yaml")
        assert [each.name for each in config.panels] == ["Sooner", "Later"]
        b = bench(strict=False)
        b.do(OpenPanels(frozenset({"Sooner"})))
        b.publish("/words", "std_msgs/msg/String", {"data": "one"})
        b.turn()
        assert sooner.heard == [("one", True)]
    finally:
        registry.register(str(path), {})


def test_a_service_answers_or_has_a_reason(bench: Benches) -> None:
    b = bench(graph=RememberingGraph())
    answers: list[Any] = []
    call = CallService(
        "/start", "std_srvs/srv/Trigger", {}, answered=answers.append, failed=answers.append
    )
    b.do(call)
    assert answers.pop() == "No node offers /start. Start one."
    response = encode("std_srvs/srv/Trigger_Response", {"success": True, "message": "on"})
    b.graph.responses["/start"] = response
    b.do(call)
    assert (answers[0].success, answers[0].message) == (True, "on")
    unknown = b.refusal(CallService("/start", "std_srvs/srv/Nothing", {}))
    assert unknown == "Not called: No definition of std_srvs/srv/Nothing is known."


def test_a_panel_on_request_is_added_and_removed_by_a_command(bench: Benches) -> None:
    b = bench()
    assert [tab.tab for tab in b.viewer.state().panels] == []
    added = [AddPanel("Nav2"), AddPanel("Nav2", {"namespace": "robot1", "name": "Second"})]
    assert [b.ask(command) for command in added] == ["Added Navigation 2.", "Added Second."]
    assert [tab.tab for tab in b.viewer.state().panels] == ["Nav2", "Nav2 2"]
    panel_entries = document(b.viewer.config())["panels"]
    assert panel_entries[1] == {"type": "Nav2", "name": "Second", "namespace": "robot1"}
    assert b.ask(RemovePanel("Navigation 2")) == "Removed Navigation 2."
    b.do(Undo())
    assert [tab.panel.name for tab in b.viewer.state().panels] == ["Navigation 2", "Second"]
    assert b.refusal(AddPanel("Nav3")) == "Unknown panel type `Nav3`: did you mean `Nav2`?"
    sentence = "Not added: namespace: expected text, got 5."
    assert b.refusal(AddPanel("Nav2", {"namespace": 5})) == sentence

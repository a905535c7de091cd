"""Rights that an owner gives in the page, at a whole viewer, by programs that speak as pages do."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

import webviz
from tests.features.rights.conftest import CALIBRATE, TokenViewer
from webviz import commands
from webviz.api.roles import Role
from webviz.features import rights
from webviz.features.rights import MAX_REQUESTS, NOT_ONE_NAME
from webviz.shell.testing.remembering_graph import RememberingGraph
from webviz.shell.testing.source import HandFedSource

FAR = "10.1.2.3"


def test_an_owner_allows_one_name_until_the_viewer_ends_or_it_is_taken_back(
    token_viewer: TokenViewer,
) -> None:
    owner = token_viewer.enter(Role.OWNER)
    assert "Let the owner allow it for this session" in token_viewer.call()
    assert token_viewer.graph.requests == []
    assert owner.do("Allow", name=CALIBRATE) == "Allowed for this session: call /calibrate."
    assert token_viewer.call() == ""
    assert len(token_viewer.graph.requests) == 1
    assert owner.do("Forbid", name=CALIBRATE) == "No longer allowed: call /calibrate."
    assert token_viewer.call() != ""
    assert len(token_viewer.graph.requests) == 1
    assert token_viewer.journal()[:2] == [
        "No longer allowed: call /calibrate.",
        "Allowed for this session: call /calibrate.",
    ]


def test_allowed_names_end_with_the_viewer(make: Callable[..., TokenViewer]) -> None:
    token_viewer = make()
    assert token_viewer.enter(Role.OWNER).do("Allow", name=CALIBRATE).startswith("Allowed")
    assert make().call() != ""


@pytest.mark.parametrize("role", [Role.WATCHER, Role.OPERATOR])
@pytest.mark.parametrize("command", ["Allow", "Forbid", "Decline"])
def test_other_roles_allow_nothing(token_viewer: TokenViewer, role: Role, command: str) -> None:
    guest = token_viewer.enter(role)
    assert guest.do(command, name=CALIBRATE).startswith("Not allowed: this needs an owner")
    assert token_viewer.call() != ""


def test_an_owner_of_another_machine_gives_no_rights(token_viewer: TokenViewer) -> None:
    answer = token_viewer.enter(Role.OWNER, FAR).do("Allow", name=CALIBRATE)
    assert answer.startswith("Not allowed: pages of other machines give no rights.")
    assert token_viewer.call() != ""
    assert not any("Allowed" in text for text in token_viewer.journal())


@pytest.mark.parametrize(
    "name",
    [
        *("/*", "*", "/calib*", "/[a-z]*", "/calibrat?", "calibrate", "", "/", "/a b", "/a\nb"),
        *("~/calibrate", "/calibrate/_action/send_goal", "/" + "a" * 300, "/a\u202eb"),
    ],
)
def test_patterns_and_partial_names_are_refused(token_viewer: TokenViewer, name: str) -> None:
    assert token_viewer.enter(Role.OWNER).do("Allow", name=name) == NOT_ONE_NAME
    assert token_viewer.call() != ""
    assert token_viewer.allowed() == []


def test_a_viewer_that_may_publish_nothing_stays_so(make: Callable[..., TokenViewer]) -> None:
    token_viewer = make(publish=False)
    answer = token_viewer.enter(Role.OWNER).do("Allow", name=CALIBRATE)
    assert answer.startswith("This viewer was started with --no-publish.")
    assert "--no-publish" in token_viewer.call()


@pytest.mark.parametrize("command", ["Allow", "Forbid", "AskOwner", "Decline"])
def test_no_program_and_so_no_script_of_a_panel_gives_rights(
    token_viewer: TokenViewer, command: str
) -> None:
    with pytest.raises(webviz.Error, match="Only an owner does this, in the page"):
        token_viewer.viewer.do(getattr(commands, command)(CALIBRATE))
    assert token_viewer.allowed() == []
    assert token_viewer.call() != ""


def test_an_operator_asks_and_the_owner_answers(
    token_viewer: TokenViewer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rights, "PAUSE_S", 0.0)
    owner, operator = token_viewer.enter(Role.OWNER), token_viewer.enter(Role.OPERATOR, FAR)
    assert operator.do("AskOwner", name=CALIBRATE) == "Asked the owner: call /calibrate."
    waiting = token_viewer.store(owner, "permission_requests")
    (who,) = [t.name for t in token_viewer.viewer.access.tokens if t.role == "operator"]
    assert waiting == {CALIBRATE: {"who": who, "use": "call /calibrate"}, "allowed": []}
    assert operator.do("AskOwner", name=CALIBRATE).endswith("asked for this already.")
    assert owner.do("Decline", name=CALIBRATE) == "Not allowed for now: call /calibrate."
    assert operator.do("AskOwner", name=CALIBRATE).startswith("The owner declined for now.")
    assert token_viewer.store(owner, "permission_requests") == {"allowed": []}
    assert token_viewer.call() != ""
    assert operator.do("AskOwner", name="/other") == "Asked the owner: publish on /other."
    assert owner.do("Allow", name="/other").startswith("Allowed")
    assert token_viewer.store(owner, "permission_requests") == {"allowed": ["/other"]}
    assert operator.do("AskOwner", name="/other") == "/other is allowed already."


def test_everything_that_is_done_with_rights_is_in_the_journal(token_viewer: TokenViewer) -> None:
    owner, operator = token_viewer.enter(Role.OWNER), token_viewer.enter(Role.OPERATOR)
    answer = [
        operator.do("AskOwner", name=CALIBRATE),
        owner.do("Decline", name=CALIBRATE),
        owner.do("Allow", name=CALIBRATE),
        owner.do("Forbid", name=CALIBRATE),
    ]
    assert token_viewer.journal() == [*reversed(answer)]


def test_nothing_is_allowed_on_a_bag(make: Callable[..., TokenViewer]) -> None:
    token_viewer = make(is_read_only=True)
    answer = token_viewer.enter(Role.OWNER).do("Allow", name=CALIBRATE)
    assert answer == "This source can only be read."
    assert token_viewer.call() == "This source can only be read."


def test_requests_are_bounded(token_viewer: TokenViewer, monkeypatch: pytest.MonkeyPatch) -> None:
    operator = token_viewer.enter(Role.OPERATOR)
    assert operator.do("AskOwner", name="/a").startswith("Asked the owner")
    assert "No owner is connected" in token_viewer.journal()[0]
    # Another page of the same link is no other asker.
    again = token_viewer.enter(Role.OPERATOR)
    assert again.do("AskOwner", name="/b").startswith("The owner was asked a moment ago.")
    monkeypatch.setattr(rights, "PAUSE_S", 0.0)
    answers = [operator.do("AskOwner", name=f"/x{i}") for i in range(MAX_REQUESTS)]
    assert [a.startswith("Asked") for a in answers] == [True] * (MAX_REQUESTS - 1) + [False]
    watcher = token_viewer.enter(Role.WATCHER)
    assert watcher.do("AskOwner", name="/a").startswith("Not allowed: this needs an operator")


def test_only_owners_read_the_requests(token_viewer: TokenViewer) -> None:
    operator = token_viewer.enter(Role.OPERATOR)
    operator.send("Watch", store="permission_requests")
    operator.send("Watch", store="permission:/calibrate")
    values = operator.receive("Values")
    assert values["store"] == "permission:/calibrate"
    assert values["set"]["is_open"] is True


def config_with(text: str, folder: Path) -> Path:
    path = folder / "lab.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def test_the_config_file_allows_a_name_for_good(
    make: Callable[..., TokenViewer], tmp_path: Path
) -> None:
    path = config_with("version: 1\npublish: [/goal_pose]\n", tmp_path)
    token_viewer = make(config=path)
    owner = token_viewer.enter(Role.OWNER)
    answer = owner.do("Allow", name=CALIBRATE, always=True)
    assert answer == "Allowed for this session: call /calibrate. Saved lab.yaml."
    assert "publish: [/goal_pose, /calibrate]" in path.read_text()
    token_viewer.close()
    assert make(config=path).call() == ""


def test_a_config_without_a_list_keeps_its_names_when_one_is_added(
    make: Callable[..., TokenViewer], tmp_path: Path
) -> None:
    path = config_with("version: 1\n", tmp_path)
    token_viewer = make(config=path)
    owner = token_viewer.enter(Role.OWNER)
    assert "Saved lab.yaml." in owner.do("Allow", name=CALIBRATE, always=True)
    after = make(config=path)
    assert after.call() == ""
    owner = after.enter(Role.OWNER)
    assert after.store(owner, "permission:/goal_pose")["refusal"] == ""


def test_autosave_and_another_config_do_not_keep_allowed_names(
    make: Callable[..., TokenViewer], tmp_path: Path
) -> None:
    file = tmp_path / "last.yaml"
    token_viewer = make(autosave=file)
    owner = token_viewer.enter(Role.OWNER)
    assert owner.do("Allow", name=CALIBRATE).startswith("Allowed")
    assert owner.do("Load", text="version: 1\npublish: []\n", name="x.yaml").startswith("Opened")
    assert token_viewer.call() == ""
    token_viewer.close()
    assert CALIBRATE not in file.read_text()


def test_a_restricted_graph_compares_session_names_as_they_are() -> None:
    from webviz.sources import RestrictedGraph, Rights

    source = HandFedSource(graph=RememberingGraph())  # pyright: ignore[reportArgumentType]
    restricted_graph = RestrictedGraph(source, Rights(publish=()), lambda: ())
    restricted_graph.allow("/go")
    assert restricted_graph.refusal("/go") == ""
    assert restricted_graph.refusal("/go/_action/send_goal") == ""
    assert restricted_graph.refusal("/gone") != ""
    restricted_graph.allow("/*")
    assert restricted_graph.refusal("/x") != ""
    restricted_graph.forbid("/go")
    assert restricted_graph.refusal("/go") != ""
    closed = RestrictedGraph(source, Rights(may_publish=False), lambda: None)
    closed.allow("/go")
    assert closed.refusal("/go") != ""
    assert not closed.is_open("/go")

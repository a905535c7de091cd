"""The rules name every message, command and store, and no role may do more than they say."""

from __future__ import annotations

from pathlib import Path

import pytest

import webviz
from webviz import commands
from webviz.api.roles import Role
from webviz.engine import feature
from webviz.engine.commands import Command, PageCommand
from webviz.features.selection import MAX_SELECTED
from webviz.server.access import rules
from webviz.server.access.roles import LIMITS, LINKS
from webviz.server.channel import messages
from webviz.server.channel.messages import FromPage
from webviz.server.channel.refusals import answer
from webviz.server.http.viser_messages import message_type

NOT_OF_PAGES = {
    "CallService": "panels of the viewer send it",
    "OpenPanels": "follows from the stores that pages watch",
    "Publish": "panels of the viewer send it",
    "SendGoal": "panels of the viewer send it",
    "Command": "base class",
    "FileCommand": "base class",
    "InspectLatency": "follows from the stores that pages watch",
    "InspectSelections": "follows from the stores that pages watch",
    "InspectTopic": "of programs",
    "InspectTopics": "follows from the stores that pages watch",
    "ListName": "follows from Allow",
    "InspectTransforms": "follows from the stores that pages watch",
    "Refresh": "of programs; watching a store sends it",
    "Restore": "of the start of a viewer",
    "RestoreSelection": "of the start of a viewer",
    "ReloadPlugin": "runs code of a file",
    "TraceDisplay": "of programs",
}
"""Commands that no page may send, and why."""

WATCHING = {
    "ChangeView",
    "Export",
    "FocusDisplay",
    "FocusFrame",
    "Identify",
    "LookUpTransform",
    "ResetView",
    "SaveImage",
    "Select",
    "ShowView",
    "WriteDisplays",
}
OWNING = {
    "CompareRecording",
    "EndComparison",
    "Load",
    "Open",
    "OpenRecording",
    "Save",
    "SaveMemory",
    "StartRecording",
    "StopRecording",
}
OWNING |= {"Dismiss", "Invite", "ListReport", "Revoke", "SaveReport"}
OWNING |= {"BeginUpload", "UploadPart", "ReadOutput", "Allow", "Decline", "Forbid"}
OWNING |= {"ListMoment", "ShareMoment", "StopSharing"}
OF_THE_SERVER = ("Dismiss", "Invite", "Revoke", "UseWidget")
"""Done by itself, without the frame loop."""


def every_command() -> set[str]:
    public = [getattr(commands, name) for name in commands.__all__]
    results = {c.__name__ for c in public if isinstance(c, type) and issubclass(c, Command)}
    return results | {*OF_THE_SERVER}


def every_message() -> set[str]:
    return {c.__name__ for c in FromPage.__subclasses__() if c.__module__.startswith("webviz.")}


def test_every_command_has_a_role_or_a_reason_why_no_page_may_send_it() -> None:
    allowed = {command.__name__ for command in rules.commands()}
    assert not allowed & NOT_OF_PAGES.keys()
    assert allowed | NOT_OF_PAGES.keys() == every_command()


def test_every_message_of_pages_has_a_role() -> None:
    assert rules.MESSAGES.keys() == every_message()


def test_every_message_to_viser_is_one_that_viser_knows() -> None:
    assert all(message_type(kind) for kind in rules.SCENE)
    assert rules.MESSAGES.keys().isdisjoint(rules.SCENE)


def test_programs_have_no_commands_that_the_server_carries_out_itself() -> None:
    results = {n for n, each in feature.commands().items() if issubclass(each.type, PageCommand)}
    assert results == {*OF_THE_SERVER}
    assert results.isdisjoint(commands.__all__)


def test_addresses_journal_and_links_are_for_owners() -> None:
    of_owners = {name for name, each in feature.stores().items() if each.role is Role.OWNER}
    assert of_owners >= {"addresses", "journal", "links"}


def test_commands_of_interest_to_the_owner_are_in_the_journal() -> None:
    noted = {name for name, each in feature.commands().items() if each.is_noted}
    people = {"Dismiss", "Invite", "Revoke"}
    rights = {"Allow", "AskOwner", "Decline", "Forbid"}
    files = {"BeginUpload", "Load", "Open", "Save"}
    assert noted == people | rights | files | {"UseTool", "LookBackAlone"}


@pytest.mark.parametrize("command", sorted(every_command()))
def test_a_higher_role_may_send_all_commands_of_a_lower_one(command: str) -> None:
    may = [not rules.refusal(role, "CommandRequest", command) for role in Role]
    assert may == sorted(may)
    if command in NOT_OF_PAGES:
        assert may == [False, False, False]
    elif command in WATCHING:
        assert may == [True, True, True]
    else:
        assert may == [False, command not in OWNING, True]


@pytest.mark.parametrize("kind", sorted({*rules.MESSAGES, *rules.SCENE} - {"CommandRequest"}))
def test_a_watcher_sends_nothing_that_others_notice(kind: str) -> None:
    harmless = {
        "SyncReply",
        "Hello",
        "Ping",
        "Unwatch",
        "ViewReport",
        "ViewerCameraMessage",
        "Watch",
    }
    harmless |= {"FramesShown", "ReadPixel", "ShowPictures"}  # of the page's own image panes
    assert (rules.refusal(Role.WATCHER, kind) == "") == (kind in harmless)
    assert rules.refusal(Role.OWNER, kind) == ""


@pytest.mark.parametrize(
    "kind", ["", "None", "Identity", "Shell", "GuiUpdateMessage", "ShareUrlRequest"]
)
def test_unlisted_messages_are_refused_to_every_role(kind: str) -> None:
    assert all(rules.refusal(role, kind) for role in Role)


def test_a_refusal_is_one_sentence_with_a_remedy() -> None:
    assert rules.refusal(Role.WATCHER, "Drive") == (
        "Not allowed: this needs an operator, and you are a watcher. Ask the owner of this viewer "
        "for another link."
    )


def test_a_store_of_owners_is_for_owners() -> None:
    assert rules.refusal(Role.OPERATOR, "Watch", store="journal:1")
    assert not rules.refusal(Role.OWNER, "Watch", store="journal")
    assert not rules.refusal(Role.WATCHER, "Watch", store="journals")


def test_refused_requests_are_answered_with_the_reason() -> None:
    drive = messages.Drive("tool", 1, 0.0, 0.0, 0.0)
    assert answer(drive, "No.") == messages.DrivingReport("tool", 0, None, "No.")
    save = messages.CommandRequest(7, "Save", {})
    assert answer(save, "No.") == messages.CommandResult(7, "Save", "error", "No.", {})
    assert answer(messages.Ping(), "No.") is None


def test_every_role_has_limits_and_a_link() -> None:
    assert {*LIMITS} == {*LINKS.values()} == {*Role}
    assert [LIMITS[role].messages_per_second for role in Role] == [100.0, 200.0, 200.0]
    assert [LIMITS[role].bytes_per_message >> 10 for role in Role] == [1, 32, 32]
    assert [LIMITS[role].max_characters >> 10 for role in Role] == [256, 1024, 3072]
    shares = [LIMITS[role].share for role in Role]
    assert shares == sorted(shares)
    assert shares[-1] == 1.0


def test_the_page_sends_no_longer_config_than_an_owner_may() -> None:
    source = (Path(webviz.__file__).parent / "features/files/files.js").read_text()
    assert "const MAX_CHARACTERS = (3 << 20) - 1000;" in source
    assert LIMITS[Role.OWNER].max_characters == 3 << 20
    assert LIMITS[Role.OWNER].max_values == 3 << 20


def test_the_longest_message_of_a_role_takes_little_of_its_rate() -> None:
    seconds = {
        role: limits.max_characters / limits.bytes_per_message / limits.messages_per_second
        for role, limits in LIMITS.items()
    }
    assert max(seconds[Role.OPERATOR], seconds[Role.OWNER]) < 0.5
    assert LIMITS[Role.WATCHER].max_characters > 100 * MAX_SELECTED
    watcher = LIMITS[Role.WATCHER]
    assert watcher.bytes_per_message * watcher.messages_per_second == pytest.approx(100e3, rel=0.1)

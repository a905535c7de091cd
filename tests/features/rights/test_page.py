"""Rights in the page: where the form is, before it is filled in, in real browsers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

import playwright.sync_api as playwright
import pytest
from playwright.sync_api import expect
from waiting import until

from tests.features.rights.conftest import CALIBRATE, TokenViewer
from webviz import commands
from webviz.api.roles import Role
from webviz.features import rights

CONFIG = f"""\
version: 1
publish: [/goal_pose]
displays: [{{type: Grid}}]
panels:
- {{type: ServiceCall, service: {CALIBRATE}}}
- {{type: Parameters, node: /camera}}
"""
MAY_NOT = "This viewer may not call /calibrate yet."

Enter = Callable[[Role], playwright.Page]


@pytest.fixture
def token_viewer(make: Callable[..., TokenViewer], tmp_path: Path) -> TokenViewer:
    (path := tmp_path / "lab.yaml").write_text(CONFIG)
    return make(config=path)


@pytest.fixture
def enter(token_viewer: TokenViewer, browser: playwright.Browser) -> Iterator[Enter]:
    """Open the page with the cookie of a role, at the form of the service."""
    errors: list[str] = []
    contexts: list[playwright.BrowserContext] = []

    def enter(role: Role) -> playwright.Page:
        context = browser.new_context(viewport={"width": 1280, "height": 720})
        contexts.append(context)
        name, value = token_viewer.cookie(role)
        context.add_cookies([{"name": name, "value": value, "url": token_viewer.viewer.url}])
        page = context.new_page()
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto(token_viewer.viewer.url)
        page.get_by_role("tab", name="Service call").click()
        expect(page.get_by_label("YAML")).to_be_visible(timeout=60_000)
        return page

    yield enter
    for context in contexts:
        context.close()
    assert errors == []


def permission(page: playwright.Page) -> playwright.Locator:
    return page.get_by_label("Permission")


def test_the_owner_allows_a_service_where_its_form_is(
    token_viewer: TokenViewer, enter: Enter
) -> None:
    page = enter(Role.OWNER)
    expect(permission(page)).to_contain_text(MAY_NOT)
    call = page.get_by_role("button", name="Call", exact=True)
    expect(call).to_be_disabled()
    # Before the fields: nothing is filled in for nothing.
    above = permission(page).bounding_box()
    below = page.get_by_label("YAML").bounding_box()
    assert above
    assert below
    assert above["y"] < below["y"]
    allow = page.get_by_role("button", name="Allow for this session")
    allow.focus()
    page.keyboard.press("Enter")
    expect(permission(page)).to_contain_text("Allowed for this session.")
    call.click()
    expect(page.get_by_text("Answered.")).to_be_visible()
    assert [service for service, _, _ in token_viewer.graph.requests] == [CALIBRATE]
    page.get_by_role("button", name="Take back").click()
    expect(permission(page)).to_contain_text(MAY_NOT)
    expect(call).to_be_disabled()
    assert token_viewer.call() != ""


def test_the_file_allows_it_for_good(token_viewer: TokenViewer, enter: Enter) -> None:
    page = enter(Role.OWNER)
    page.get_by_role("button", name="Always, in lab.yaml").click()
    expect(page.get_by_text("Saved lab.yaml.")).to_be_visible()
    assert token_viewer.call() == ""


def test_an_operator_asks_the_owner(
    token_viewer: TokenViewer, enter: Enter, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rights, "PAUSE_S", 0.0)
    monkeypatch.setattr(rights, "DECLINED_S", 1.0)
    owner, operator = enter(Role.OWNER), enter(Role.OPERATOR)
    expect(permission(operator)).to_contain_text(f"{MAY_NOT} Its owner can allow it.")
    expect(operator.get_by_role("button", name="Allow for this session")).to_be_hidden()
    ask = operator.get_by_role("button", name="Ask the owner")
    ask.click()
    expect(permission(operator)).to_contain_text("The owner has been asked.")
    request = owner.get_by_label("Requests", exact=True)
    expect(request).to_contain_text("operator asks to call /calibrate.")
    request.get_by_role("button", name="Not now").click()
    expect(request).to_be_hidden()
    expect(permission(operator)).to_contain_text("The owner declined for now.")
    expect(ask).to_be_visible()
    until(
        lambda: (
            not token_viewer.store(token_viewer.enter(Role.OWNER), f"permission:{CALIBRATE}")[
                "declined"
            ]
        )
    )
    ask.click()
    request.get_by_role("button", name="Allow for this session").click()
    expect(permission(operator)).to_contain_text("Allowed for this session.")
    operator.get_by_role("button", name="Call", exact=True).click()
    expect(operator.get_by_text("Answered.")).to_be_visible()
    assert len(token_viewer.graph.requests) == 1


def test_a_watcher_sees_whose_permission_it_needs(enter: Enter) -> None:
    page = enter(Role.WATCHER)
    expect(permission(page)).to_contain_text("Its owner can allow it to operators.")
    expect(permission(page).get_by_role("button")).to_have_count(0)


def test_a_page_that_lies_gets_no_rights(token_viewer: TokenViewer, enter: Enter) -> None:
    page = enter(Role.OPERATOR)
    page.evaluate(
        """async () => {
            const channel = await import("webviz/channel.js");
            const lie = { type: "CommandRequest", number: 1e6, arguments: { name: "/calibrate" } };
            for (const command of ["Allow", "Decline", "Forbid"])
                channel.send({ ...lie, command });
        }"""
    )
    expect(permission(page)).to_contain_text(MAY_NOT)
    assert token_viewer.allowed() == []
    assert token_viewer.call() != ""


def test_a_tool_whose_topic_was_changed_is_allowed_at_its_properties(
    token_viewer: TokenViewer, enter: Enter
) -> None:
    token_viewer.viewer.do(commands.SetToolProperty("2D Goal Pose", "topic.name", "/elsewhere"))
    page = enter(Role.OWNER)
    page.get_by_role("tab", name="Tools").click()
    notice = permission(page).filter(has_text="This viewer may not publish on /elsewhere yet.")
    notice.get_by_role("button", name="Allow for this session").click()
    expect(permission(page).filter(has_text="Allowed for this session.")).to_be_visible()
    assert token_viewer.allowed() == ["/elsewhere"]
    use = commands.UseTool("2D Goal Pose", ((1.0, 2.0, 0.0),))
    token_viewer.viewer.do(use)
    until(lambda: token_viewer.graph.published)
    assert token_viewer.graph.published[0][0].topic == "/elsewhere"


def test_parameters_look_read_only_where_they_are(token_viewer: TokenViewer, enter: Enter) -> None:
    page = enter(Role.OWNER)
    page.get_by_role("tab", name="Parameters").click()
    text = "This viewer may not change the parameters of /camera yet."
    expect(permission(page)).to_contain_text(text)
    expect(page.get_by_role("button", name="Load YAML")).to_be_disabled()
    page.get_by_role("button", name="Allow for this session").click()
    expect(page.get_by_role("button", name="Load YAML")).to_be_enabled()
    assert token_viewer.allowed() == ["/camera/set_parameters"]

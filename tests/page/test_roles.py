"""Links with tokens in a real browser, and what the page shows of roles."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import playwright.sync_api as playwright
import pytest
from pages import COARSE
from playwright.sync_api import expect

from tests.page.everything import named
from tests.page.page_bench import PageBench, PageServer
from tests.page.tabs import ViewerTab, open_page
from webviz import commands
from webviz.api.roles import Role
from webviz.files.config import DockedPanel, Layout
from webviz.server.access import token_file
from webviz.server.access.access import Access
from webviz.server.access.starting import link
from webviz.server.access.tokens import Token, make
from webviz.tools.goal_pose import GoalPose

WHY = "Only operators may do this. Your link is for a watcher."


@dataclass
class TokenPages:
    """A viewer that asks for tokens, with a watcher and its owner.

    Args:
        url: of the page.
        path: of the file with tokens.
        tokens: one of each role.
        page_server: of the viewers.
        watcher, owner: their tabs.
    """

    url: str
    path: Path
    tokens: dict[Role, Token]
    page_server: PageServer
    watcher: ViewerTab
    owner: ViewerTab


@pytest.fixture(scope="module")
def pages(
    browser: playwright.Browser, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[TokenPages]:
    path = tmp_path_factory.mktemp("tokens") / "tokens.json"
    now = datetime.now(UTC)
    tokens = {role: make(f"the {role.label}", role, now) for role in Role}
    token_file.modify(path, lambda _: list(tokens.values()))
    access = Access(True, path)
    page_server = PageServer(access)
    url = f"http://127.0.0.1:{page_server.server.get_port()}"

    def tab(role: Role) -> ViewerTab:
        page = open_page(browser)
        answer = page.context.request.get(
            link(url, tokens[role]), headers={"Sec-Fetch-Site": "none"}
        )
        assert answer.ok
        return ViewerTab(page, page_server)

    pages = TokenPages(url, path, tokens, page_server, tab(Role.WATCHER), tab(Role.OWNER))
    yield pages
    for each in (pages.watcher, pages.owner):
        each.page.context.close()
    page_server.close()


@pytest.fixture(autouse=True)
def viewer(pages: TokenPages, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> PageBench:
    """A viewer with one tool and two displays, which saves into a folder of the test."""
    monkeypatch.chdir(tmp_path)
    viewer = pages.page_server.begin()
    goal = GoalPose(name="Goal")
    viewer.show(*named("a", "b"), tools=[goal])
    viewer.link("map", "odom")
    for tab in (pages.watcher, pages.owner):
        tab.catch_up()
    viewer.forget_commands()
    return viewer


def toasts(tab: ViewerTab) -> playwright.Locator:
    return tab.page.locator(".wv-toasts")


def test_a_link_leaves_no_token_in_the_address_nor_for_scripts(
    pages: TokenPages, browser: playwright.Browser
) -> None:
    with browser.new_context(java_script_enabled=False) as context:  # of the page, not of this test
        page = context.new_page()
        # From another site: its cookie would not be sent after a plain redirect.
        page.set_content(f'<a href="{link(pages.url, pages.tokens[Role.WATCHER])}">Watch</a>')
        page.click("a")
        page.wait_for_url(f"{pages.url}/")
        page.locator("#root").wait_for(state="attached")
        assert page.evaluate("document.cookie") == ""
        assert page.evaluate("document.referrer") == ""
        cookies = context.cookies()
        assert cookies
        for cookie in cookies:
            assert (cookie.get("httpOnly"), cookie.get("sameSite")) == (True, "Strict")
        page.goto(link(pages.url, pages.tokens[Role.OPERATOR]), wait_until="commit")
        page.wait_for_url(f"{pages.url}/", wait_until="commit")


def test_what_a_watcher_may_not_do_says_why(pages: TokenPages) -> None:
    watcher = pages.watcher
    page = watcher.page
    watcher.wait_for(lambda: page.locator(".wv-role").inner_text() == "watcher")
    for name in ("Undo", "Redo", "Pause", "Reset"):
        button = watcher.button(name)
        expect(button).to_have_attribute("aria-disabled", "true")
        expect(button).to_have_attribute("data-why", WHY)
    page.locator(".wv-tree-add").click(force=True)  # it is disabled
    expect(toasts(watcher)).to_contain_text(WHY)
    expect(page.locator("dialog")).to_have_count(0)
    page.keyboard.press("Control+s")
    expect(toasts(watcher)).to_contain_text("Only the owner of this viewer may do this.")
    expect(page.locator('input[aria-label="Fixed frame"]')).to_be_disabled()
    expect(page.get_by_role("button", name="Goal", exact=True)).to_have_attribute(
        "aria-disabled", "true"
    )
    assert watcher.viewer.commands == []


def test_a_watcher_reads_properties_and_cannot_change_them(pages: TokenPages) -> None:
    watcher = pages.watcher
    watcher.page.get_by_role("treeitem", name="a", exact=True).locator(".wv-tree-name").click()
    watcher.wait_for(lambda: watcher.page.locator(".wv-property").count() > 3)
    fields = watcher.page.locator(".wv-property-control").locator("input, select, textarea")
    assert fields.count() > 3
    for field in fields.all():
        expect(field).to_be_disabled()
    expect(watcher.page.get_by_role("checkbox", name="Show a", exact=True)).to_be_disabled()
    watcher.page.keyboard.press("Delete")
    watcher.turn()
    assert [c for c in watcher.viewer.commands if isinstance(c, commands.RemoveDisplay)] == []


def test_lists_tabs_and_the_tree_are_locked_too(pages: TokenPages) -> None:
    watcher = pages.watcher
    page = watcher.page
    expect(watcher.button("Add a panel")).to_have_attribute("data-why", WHY)
    names = [page.get_by_role("treeitem", name=name, exact=True) for name in "ab"]
    a, b = (name.locator(".wv-tree-name").bounding_box() for name in names)
    assert a is not None
    assert b is not None
    page.mouse.move(a["x"] + 5, a["y"] + 5)
    page.mouse.down()
    page.mouse.move(b["x"] + 5, b["y"] + 15, steps=5)
    expect(page.locator(".wv-tree-ghost")).to_have_count(0)
    page.mouse.up()
    names[0].locator(".wv-tree-name").dblclick()
    expect(page.locator(".wv-tree-rename")).to_have_count(0)
    page.keyboard.press("Control+k")
    entry = page.get_by_role("option", name="Fixed frame: odom")
    expect(entry).to_have_attribute("data-why", WHY)
    expect(entry).to_have_attribute("aria-disabled", "true")
    page.keyboard.press("Escape")
    watcher.turn()
    assert watcher.viewer.commands == []


def test_a_watcher_has_a_view_of_their_own(pages: TokenPages) -> None:
    pages.watcher.page.evaluate("async () => void (await import('webviz/act.js')).act('ResetView')")
    pages.watcher.wait_for_command(commands.ResetView())


def test_a_watcher_arranges_panels_for_themselves(pages: TokenPages) -> None:
    watcher, owner = pages.watcher, pages.owner
    watcher.page.locator("#wv-tab-topics").click(button="right")
    watcher.page.get_by_role("menuitemradio", name="Beside the scene").click()
    beside = "section.wv-docked[data-panel=topics]"
    watcher.wait_for(lambda: watcher.page.locator(beside).count() == 1)
    assert (owner.page.locator(".wv-docked").count(), watcher.viewer.commands) == (0, [])
    shared = Layout(below=(DockedPanel(panel="doctor"),))
    pages.page_server.viewer.show(layout=shared)
    for tab in (watcher, owner):
        tab.wait_for(lambda tab=tab: tab.page.locator(".wv-docked").count() == 1)
        tab.wait_for(lambda tab=tab: tab.page.locator(".wv-below > .wv-docked").count() == 1)
    pages.page_server.viewer.show()
    watcher.wait_for(lambda: watcher.page.locator(".wv-docked").count() == 0)


def test_a_page_that_asks_all_the_same_is_refused_by_the_server(pages: TokenPages) -> None:
    ask = """async () => {
      const channel = await import('webviz/channel.js');
      window.answers = [];
      channel.on('CommandResult', ({number, text}) => number === 9999 && window.answers.push(text));
      channel.send({type: 'CommandRequest', number: 9999, command: 'Undo', arguments: {}});
    }"""
    pages.watcher.page.evaluate(ask)
    pages.watcher.wait_for(lambda: pages.watcher.page.evaluate("window.answers.length"))
    assert pages.watcher.page.evaluate("window.answers") == [
        "Not allowed: this needs an operator, and you are a watcher. Ask the owner of this viewer "
        "for another link."
    ]
    assert pages.watcher.viewer.commands == []


def test_the_owner_sees_who_is_there_and_invites_others(pages: TokenPages, tmp_path: Path) -> None:
    owner = pages.owner
    owner.button("Undo")
    expect(owner.page.locator(".wv-locked")).to_have_count(0)
    save = "(await import('webviz/act.js')).act('Save', {path: 'lab.yaml'})"
    owner.page.evaluate(f"async () => void {save}")
    owner.wait_for_command(commands.Save("lab.yaml"))
    assert (tmp_path / "lab.yaml").exists()
    owner.button("Menu").click()
    owner.page.get_by_role("menuitem", name="People…").click()
    people = owner.page.get_by_role("dialog")
    owner.wait_for(lambda: people.get_by_role("table", name="Connected").locator("td").count() > 6)
    text = people.inner_text()
    for part in ("the watcher", "the owner (you)", "127.0.0.1", "Saved lab.yaml."):
        owner.wait_for(lambda part=part: part in people.inner_text())
    assert pages.tokens[Role.WATCHER].secret not in text
    people.get_by_label("Name", exact=True).fill("Ada")
    role = people.get_by_role("combobox", name="Role")
    role.fill("operator")
    role.press("Enter")
    people.get_by_role("button", name="Make a link").click()
    owner.wait_for(lambda: people.locator("code").count() == 1)
    address = people.locator("code").inner_text()
    (token,) = (t for t in token_file.read(pages.path) if t.name == "Ada")
    assert address == link(pages.url, token)
    assert owner.page.evaluate("document.querySelector('.wv-invitation img').naturalWidth") > 50
    expect(people.get_by_role("note")).to_contain_text("Only this machine can open this link.")
    people.get_by_label("Name", exact=True).fill("Ada")
    people.get_by_role("button", name="Make a link").click()
    owner.wait_for(lambda: "There is a link for Ada already" in people.inner_text())
    links = people.get_by_role("table", name="Links").get_by_role("row")
    expect(links.filter(has_text="the owner").get_by_role("button")).to_have_count(0)
    ada = links.filter(has_text="Ada")
    expect(ada).to_contain_text("operator")
    ada.get_by_role("button", name="Revoke link").click()
    owner.page.get_by_role("button", name="Revoke", exact=True).click()
    expect(toasts(owner)).to_contain_text("Revoked the link of Ada.")
    owner.wait_for(lambda: ada.count() == 0)
    assert "Ada" not in {token.name for token in token_file.read(pages.path)}
    owner.page.keyboard.press("Escape")


def test_the_owner_ends_visits_and_revokes_links(pages: TokenPages) -> None:
    """The last test of this module, since the watcher is gone then."""
    owner, watcher = pages.owner, pages.watcher
    owner.button("Menu").click()
    owner.page.get_by_role("menuitem", name="People…").click()
    people = owner.page.locator(".wv-people")
    connected = people.get_by_role("table", name="Connected")
    row = connected.get_by_role("row").filter(has_text="the watcher")
    owner_row = connected.get_by_role("row").filter(has_text="(you)")
    owner.wait_for(lambda: row.get_by_role("button").count() == 2)
    expect(owner_row.get_by_role("button")).to_have_count(0)

    def end(button: str, confirm: str) -> None:
        row.get_by_role("button", name=button).click()
        owner.page.get_by_role("button", name=confirm, exact=True).click()

    end("End visit", "End")
    expect(watcher.page.locator("body")).to_contain_text("The owner has disconnected this page.")
    owner.wait_for(lambda: row.count() == 0)
    watcher.page.goto(f"{pages.url}/?fixedDpr={COARSE}")
    owner.wait_for(lambda: row.count() == 1)
    end("Revoke link", "Revoke")
    expect(toasts(owner)).to_contain_text("Revoked the link of the watcher.")
    expect(watcher.page.locator("body")).to_contain_text("This viewer requires a link.")
    names = {token.name for token in token_file.read(pages.path)}
    assert "the watcher" not in names
    assert "the owner" in names
    owner.page.keyboard.press("Escape")

"""The tree of displays under a page that stays open while its viewer starts again.

Ids are given anew then, and may be those of other displays.
"""

from __future__ import annotations

import pytest
from viser_internals import cut_connections

from tests.page.everything import group, named
from tests.page.page_bench import PageServer
from tests.page.tabs import ViewerTab
from tests.page.trees import Tree
from webviz.files.config import Item
from webviz.scene.server import Server
from webviz_displays.grid import Grid

KEEP_OUT = """() => {
  window.KeptWebSocket = WebSocket;
  window.WebSocket = class {
    static OPEN = 1;
    readyState = 0;
    constructor() { window.isKeptOut = true; }
    close() {}
  };
}"""


@pytest.fixture
def tree(viewer_tab: ViewerTab) -> Tree:
    return Tree(viewer_tab)


def cut_off(tab: ViewerTab, server: Server) -> None:
    """End the connections of all pages, and wait until the page has a new one."""
    before = set(server.get_clients())
    cut_connections(server)
    tab.wait_for(lambda: server.get_clients() and not before & set(server.get_clients()))


def start_again(page_server: PageServer, tab: ViewerTab, *displays: Item) -> None:
    """Start another viewer with displays while the page is kept out, until it is cut off again."""
    # A page that is back before would see that displays have other names.
    tab.page.evaluate(KEEP_OUT)
    cut_off(tab, page_server.server)
    tab.wait_for(lambda: tab.page.evaluate("window.isKeptOut"))
    page_server.begin().show(*displays)
    tab.page.evaluate("() => { window.WebSocket = window.KeptWebSocket; }")


def test_an_id_of_another_display_gets_its_icon(page_server: PageServer, tree: Tree) -> None:
    icon = tree.row("a").locator(".wv-tree-type").first
    page_server.viewer.show(*named("a"))
    tree.wait_for_names("a")
    assert icon.get_attribute("data-icon") == "plug"
    id_ = page_server.viewer.id("a")
    start_again(page_server, tree.tab, Grid(name="a"))
    assert page_server.viewer.id("a") == id_
    cut_off(tree.tab, page_server.server)
    tree.tab.wait_for(lambda: icon.get_attribute("data-tip") == "Grid")
    assert icon.get_attribute("data-icon") == "grid"
    assert icon.locator("svg").count() == 1


def test_after_a_lost_connection_names_say_what_was_selected_and_folded(
    page_server: PageServer, tree: Tree, monkeypatch: pytest.MonkeyPatch
) -> None:
    page_server.viewer.show(group("g", *named("a")), *named("b"))
    tree.fold("g")
    tree.click("b")
    before = {row.id: row.name for row in page_server.viewer.rows}
    start_again(page_server, tree.tab, *named("new"), group("g", *named("a")), *named("b"))
    now = {row.id: row.name for row in page_server.viewer.rows}
    assert not before.items() & now.items()
    # The settings come first: the page must not take the displays of before for those of now.
    channel = page_server.server.channel
    watched = channel.watched
    monkeypatch.setattr(channel, "watched", lambda: watched() - {"displays"})
    cut_off(tree.tab, page_server.server)
    tree.tab.wait_for(lambda: "settings" in watched())
    for _ in range(5):
        tree.tab.turn()
    monkeypatch.undo()
    tree.wait_for_names("new", "g", "b")
    assert tree.selected() == ["b"]
    tree.fold("g")

"""Saving and opening in the page."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import playwright.sync_api as playwright
import pytest
import viser

from webviz.api.status import Level
from webviz.edges.gui.dialogs import Dialog, Dialogs
from webviz.edges.gui.file_names import file_name, title_of
from webviz.engine.commands import Export, Load, Open, Save
from webviz.engine.state import Answer, File

LAB = File("/home/me/lab.yaml", False, "/home/me", ("lab.yaml", "nav2.rviz", "office.yaml"))


@pytest.mark.parametrize(
    ("entered", "name"),
    [
        ("lab.yaml", "lab.yaml"),
        (" lab ", "lab.yaml"),
        ("lab.yml", "lab.yml"),
        ("nav2.RVIZ", "nav2.RVIZ"),
        ("v1.2", "v1.2.yaml"),
        (".bashrc", ".bashrc.yaml"),
    ],
)
def test_a_name_without_a_known_suffix_becomes_yaml(entered: str, name: str) -> None:
    assert file_name(entered) == name


@pytest.mark.parametrize("entered", ["", "  ", "..", "a/b.yaml", "../x", "a\\b", "a\0b", "/etc/x"])
def test_a_name_that_leaves_the_folder_is_refused(entered: str) -> None:
    with pytest.raises(ValueError, match="name"):
        file_name(entered)


def test_the_title_tells_what_is_not_saved() -> None:
    assert title_of(LAB) == "lab.yaml"
    assert title_of(File("/home/me/lab.yaml", is_changed=True)) == "lab.yaml*"
    assert title_of(File()) == "webviz"
    assert title_of(LAB, is_paused=True) == "lab.yaml · paused"


def test_the_page_is_called_as_the_file(loop: Any, tab: Any) -> None:
    title = "() => document.querySelector('[data-page-title]').dataset.pageTitle"
    tab.wait_for(lambda: tab.page.evaluate(title) == "webviz")
    loop.show(file=File('/home/me/"<b>.yaml', is_changed=True))
    tab.wait_for(lambda: tab.page.evaluate(title) == '"<b>.yaml* · webviz')
    assert '"<b>.yaml*' in tab.text()


def test_save_writes_where_it_came_from(loop: Any, tab: Any) -> None:
    loop.show(file=LAB)
    tab.wait_for(lambda: "lab.yaml" in tab.text())
    tab.click("Save")
    assert loop.commands == [Save()]


def test_save_without_a_file_asks_for_a_name(loop: Any, tab: Any) -> None:
    loop.show(file=File(folder="/home/me"))
    tab.click("Save")
    tab.page.get_by_role("dialog").wait_for()
    assert "/home/me" in tab.text()
    tab.fill("File name", "hall")
    tab.dialog_button("Save").click()
    tab.wait_for(lambda: loop.turn() or tab.page.get_by_role("dialog").count() == 0)
    assert loop.commands == [Save("hall.yaml")]


def test_enter_saves_as_well(loop: Any, tab: Any) -> None:
    loop.show(file=LAB)
    tab.click("Save as")
    tab.wait_for(lambda: tab.field("File name").input_value() == "lab.yaml")
    tab.fill("File name", "hall.rviz")
    tab.field("File name").press("Enter")
    tab.wait_for(lambda: loop.turn() or loop.commands)
    assert loop.commands == [Save("hall.rviz")]


def test_another_file_is_replaced_only_when_that_was_meant(loop: Any, tab: Any) -> None:
    loop.show(file=LAB)
    tab.click("Save as")
    tab.fill("File name", "office")
    tab.dialog_button("Save").click()
    tab.wait_for(lambda: loop.turn() or "office.yaml exists already" in tab.text())
    assert loop.commands == []
    tab.dialog_button("Save").click()
    tab.wait_for(lambda: loop.turn() or loop.commands)
    assert loop.commands == [Save("office.yaml")]


def test_a_refused_name_is_told_with_the_reason(loop: Any, tab: Any) -> None:
    loop.show(file=LAB)
    tab.click("Save as")
    tab.fill("File name", "../lab.yaml")
    tab.dialog_button("Save").click()
    tab.wait_for(lambda: loop.turn() or "Enter a name without folders" in tab.text())
    tab.dialog_button("Cancel").click()
    tab.wait_for(lambda: loop.turn() or tab.page.get_by_role("dialog").count() == 0)
    assert loop.commands == []


def has_focus(control: playwright.Locator) -> bool:
    return control.evaluate("(element) => element === document.activeElement")


def choose(tab: Any, name: str) -> None:
    tab.click("Open")
    tab.field("File").click()
    tab.page.get_by_role("option", name=name).click()
    tab.pause()
    tab.dialog_button("Open").click()


def test_a_file_of_the_folder_is_opened(loop: Any, tab: Any) -> None:
    loop.show(file=LAB)
    choose(tab, "nav2.rviz")
    tab.wait_for(lambda: loop.turn() or loop.commands)
    assert loop.commands == [Open("nav2.rviz")]


def test_unsaved_changes_are_discarded_only_when_that_was_meant(
    loop: Any, tab: Any, tmp_path: Path
) -> None:
    (tmp_path / "mine.yaml").write_text("version: 1\n")
    loop.show(file=replace(LAB, is_changed=True))
    choose(tab, "nav2.rviz")
    question = "Open nav2.rviz and discard unsaved changes?"
    tab.wait_for(lambda: loop.turn() or question in tab.text())
    tab.wait_for(lambda: has_focus(tab.dialog_button("Cancel")))
    tab.page.keyboard.press("Enter")
    tab.wait_for(lambda: loop.turn() or tab.page.get_by_role("dialog").count() == 0)
    assert loop.commands == []
    upload(tab, tmp_path / "mine.yaml")
    question = "Open mine.yaml and discard unsaved changes?"
    tab.wait_for(lambda: loop.turn() or question in tab.text())
    assert loop.commands == []
    tab.dialog_button("Discard").click()
    tab.wait_for(lambda: loop.turn() or loop.commands)
    assert loop.commands == [Load("version: 1\n", "mine.yaml")]
    tab.wait_for(lambda: loop.turn() or tab.page.get_by_role("dialog").count() == 0)


def test_a_dialog_has_the_focus_on_its_first_control_however_slowly_it_is_made(
    server: viser.ViserServer, loop: Any, tab: Any
) -> None:
    class Slow(Dialog):
        def __init__(self, client: viser.ClientHandle) -> None:
            super().__init__(client.gui, "Slow")
            with self.modal:
                time.sleep(0.3)  # as on a machine that has much to do
                for name in ("First", "Second"):
                    self.gui.add_button(name)

    dialogs = Dialogs(server, lambda command, browser=None: None)
    for browser in server.get_clients():
        dialogs.open(browser, Slow)
    dialogs.update(loop.state)
    tab.dialog_button("Second").wait_for()
    tab.wait_for(lambda: has_focus(tab.dialog_button("First")))


def test_a_folder_without_files_has_nothing_to_open(loop: Any, tab: Any) -> None:
    loop.show(file=File(folder="/home/me"))
    tab.click("Open")
    tab.wait_for(lambda: tab.dialog_button("Open").is_disabled())


@pytest.mark.parametrize("size", [0, 30, 1_500_000])
def test_a_file_of_the_browser_is_uploaded(loop: Any, tab: Any, tmp_path: Path, size: int) -> None:
    text = "# ä\n" * (size // 5)
    (tmp_path / "mine.yaml").write_text(text, encoding="utf-8")
    loop.show(file=LAB)
    upload(tab, tmp_path / "mine.yaml")
    tab.wait_for(lambda: loop.turn() or loop.commands)
    assert loop.commands == [Load(text, "mine.yaml")]
    tab.wait_for(lambda: loop.turn() or tab.page.get_by_role("dialog").count() == 0)


def test_what_is_no_text_is_not_opened(loop: Any, tab: Any, tmp_path: Path) -> None:
    (tmp_path / "photo.yaml").write_bytes(b"\xff\xd8\xff\xe0")
    loop.show(file=LAB)
    upload(tab, tmp_path / "photo.yaml")
    tab.wait_for(lambda: loop.turn() or "photo.yaml is not UTF-8 text." in tab.text())
    assert loop.commands == []


def upload(tab: Any, path: Path) -> None:
    tab.click("Open")
    with tab.page.expect_file_chooser() as chooser:
        tab.dialog_button("Upload from this computer").click()
    chooser.value.set_files(path)


def test_what_is_shown_is_downloaded(loop: Any, tab: Any) -> None:
    loop.show(file=LAB)
    tab.click("Save as")
    tab.fill("File name", "mine")
    with tab.page.expect_download() as download:
        tab.dialog_button("Download to this computer").click()
        tab.wait_for(lambda: loop.turn() or loop.commands)
        export = loop.commands[0]
        assert isinstance(export, Export)
        assert export.name == "mine.yaml"
        export.deliver("version: 1\n")
    assert download.value.suggested_filename == "mine.yaml"
    assert Path(download.value.path()).read_text() == "version: 1\n"


def test_answers_are_told_once_to_everybody(
    loop: Any, tab: Any, open_tab: Callable[[], Any]
) -> None:
    loop.show()
    other = open_tab()
    loop.show(answer=Answer(1, Level.ERROR, "Not changed: size: expected `float` > 0.0."))
    for each in (tab, other):
        each.wait_for(lambda each=each: "size: expected `float` > 0.0." in each.text())
    loop.turn()
    assert tab.text().count("Not changed") == 1
    late = open_tab()
    assert "Not changed" not in late.text()

"""Dialogs over the page."""

from __future__ import annotations

import playwright.sync_api as playwright
import pytest

from tests.page.tabs import ViewerTab

OPEN = """async () => {
  const { openDialog } = await import("webviz/controls/dialog.js");
  const { el } = await import("webviz/dom.js");
  window.answer = "open";
  const field = el("input", { "aria-label": "Name" });
  const accept = () => field.value !== "";
  openDialog({
    title: "Save view",
    content: field,
    buttons: [{ label: "Cancel", value: "cancel" },
              { label: "Save", value: "save", primary: true, accept }],
  }).then((value) => { window.answer = value });
}"""
ASK = """async (text) => {
  const { ask } = await import("webviz/controls/dialog.js");
  window.answer = "open";
  ask(text, { confirm: "Discard" }).then((value) => { window.answer = value });
}"""


@pytest.fixture
def dialog(viewer_tab: ViewerTab) -> playwright.Locator:
    """A dialog with a field that must not be empty."""
    viewer_tab.page.evaluate(OPEN)
    return viewer_tab.page.get_by_role("dialog")


def answer(tab: ViewerTab) -> object:
    """Return the answer the dialog was closed with."""
    return tab.page.evaluate("window.answer")


def wait_for_answer(tab: ViewerTab, expected: object) -> None:
    """Wait until the dialog is closed with this answer."""
    tab.wait_for(lambda: answer(tab) != "open")
    assert answer(tab) == expected


def test_a_dialog_is_called_as_its_title(viewer_tab: ViewerTab, dialog: playwright.Locator) -> None:
    playwright.expect(dialog).to_have_accessible_name("Save view")
    dialog.press("Escape")
    wait_for_answer(viewer_tab, None)


def test_escape_answers_with_null(viewer_tab: ViewerTab, dialog: playwright.Locator) -> None:
    viewer_tab.page.keyboard.press("Escape")
    wait_for_answer(viewer_tab, None)


def test_enter_in_a_field_is_the_primary_button(
    viewer_tab: ViewerTab, dialog: playwright.Locator
) -> None:
    dialog.get_by_label("Name").fill("top")
    viewer_tab.page.keyboard.press("Enter")
    wait_for_answer(viewer_tab, "save")


def test_a_dialog_stays_while_its_button_is_not_accepted(
    viewer_tab: ViewerTab, dialog: playwright.Locator
) -> None:
    dialog.get_by_role("button", name="Save").click()
    viewer_tab.turn()
    assert answer(viewer_tab) == "open"
    dialog.get_by_role("button", name="Cancel").click()
    wait_for_answer(viewer_tab, "cancel")


def test_a_question_has_the_focus_on_cancel_and_is_text(viewer_tab: ViewerTab) -> None:
    viewer_tab.page.evaluate(ASK, "Discard <img src=x onerror=alert(1)>?")
    dialog = viewer_tab.page.get_by_role("dialog")
    playwright.expect(dialog.get_by_text("Discard <img src=x onerror=alert(1)>?")).to_be_visible()
    playwright.expect(dialog.get_by_role("button", name="Cancel")).to_be_focused()
    viewer_tab.page.keyboard.press("Enter")
    wait_for_answer(viewer_tab, False)
    viewer_tab.page.evaluate(ASK, "Discard?")
    dialog.get_by_role("button", name="Discard").click()
    wait_for_answer(viewer_tab, True)

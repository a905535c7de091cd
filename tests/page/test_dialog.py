"""Dialogs over the page."""

from __future__ import annotations

import playwright.sync_api as playwright
import pytest

from tests.page.conftest import Tab

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
def dialog(tab: Tab) -> playwright.Locator:
    """A dialog with a field that must not be empty."""
    tab.page.evaluate(OPEN)
    return tab.page.get_by_role("dialog")


def answer(tab: Tab) -> object:
    """Return the answer the dialog was closed with."""
    return tab.page.evaluate("window.answer")


def wait_for_answer(tab: Tab, expected: object) -> None:
    """Wait until the dialog is closed with this answer."""
    tab.wait_for(lambda: answer(tab) != "open")
    assert answer(tab) == expected


def test_a_dialog_is_called_as_its_title(tab: Tab, dialog: playwright.Locator) -> None:
    playwright.expect(dialog).to_have_accessible_name("Save view")
    dialog.press("Escape")
    wait_for_answer(tab, None)


def test_escape_answers_with_null(tab: Tab, dialog: playwright.Locator) -> None:
    tab.page.keyboard.press("Escape")
    wait_for_answer(tab, None)


def test_enter_in_a_field_is_the_primary_button(tab: Tab, dialog: playwright.Locator) -> None:
    dialog.get_by_label("Name").fill("top")
    tab.page.keyboard.press("Enter")
    wait_for_answer(tab, "save")


def test_a_dialog_stays_while_its_button_is_not_accepted(
    tab: Tab, dialog: playwright.Locator
) -> None:
    dialog.get_by_role("button", name="Save").click()
    tab.turn()
    assert answer(tab) == "open"
    dialog.get_by_role("button", name="Cancel").click()
    wait_for_answer(tab, "cancel")


def test_a_question_has_the_focus_on_cancel_and_is_text(tab: Tab) -> None:
    tab.page.evaluate(ASK, "Discard <img src=x onerror=alert(1)>?")
    dialog = tab.page.get_by_role("dialog")
    playwright.expect(dialog.get_by_text("Discard <img src=x onerror=alert(1)>?")).to_be_visible()
    playwright.expect(dialog.get_by_role("button", name="Cancel")).to_be_focused()
    tab.page.keyboard.press("Enter")
    wait_for_answer(tab, False)
    tab.page.evaluate(ASK, "Discard?")
    dialog.get_by_role("button", name="Discard").click()
    wait_for_answer(tab, True)

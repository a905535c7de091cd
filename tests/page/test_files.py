"""Saving, opening and downloading in the page."""

from __future__ import annotations

from pathlib import Path

import playwright.sync_api as playwright
import pytest
from msgspec.structs import replace

from tests.page.conftest import Loop, Tab
from webviz.commands import Export, Load, Open, Save
from webviz.engine.state import ConfigFile

LAB = ConfigFile("/home/me/lab.yaml", False, "/home/me", ("lab.yaml", "nav2.rviz", "office.yaml"))


def show(tab: Tab, file: ConfigFile) -> None:
    """Show a file, and wait until the page knows it."""
    tab.loop.show(file=file)
    name = Path(file.path).name or "webviz"
    tab.wait_for(lambda: tab.page.locator(".wv-file").inner_text() == name)
    tab.wait_for(lambda: tab.page.locator(".wv-mark").is_visible() == file.is_changed)


def dialog(tab: Tab, title: str) -> playwright.Locator:
    return tab.page.get_by_role("dialog", name=title)


def test_the_page_is_called_as_the_file(tab: Tab) -> None:
    show(tab, ConfigFile('/home/me/"<b>.yaml', is_changed=True, folder="/home/me"))
    assert tab.page.title() == '* "<b>.yaml · webviz'
    show(tab, ConfigFile(folder="/home/me"))
    assert tab.page.title() == "webviz"


def test_save_writes_where_it_came_from(tab: Tab) -> None:
    show(tab, LAB)
    tab.button("Menu").click()
    tab.page.get_by_role("menuitem", name="Save Ctrl+S").click()
    tab.wait_for_command(Save())


def test_save_without_a_file_asks_for_a_name(tab: Tab) -> None:
    show(tab, ConfigFile(folder="/home/me"))
    tab.page.keyboard.press("Control+s")
    assert "In /home/me of the machine that runs webviz" in dialog(tab, "Save as").inner_text()
    dialog(tab, "Save as").get_by_label("File name").fill("hall")
    dialog(tab, "Save as").get_by_role("button", name="Save").click()
    tab.wait_for_command(Save("hall.yaml"))


def test_enter_saves_and_the_answer_is_told(tab: Tab, loop: Loop) -> None:
    show(tab, LAB)
    loop.answer = "Saved hall.rviz."
    tab.page.keyboard.press("Control+Shift+s")
    field = dialog(tab, "Save as").get_by_label("File name")
    assert field.input_value() == "lab.yaml"
    field.fill("hall.rviz")
    field.press("Enter")
    tab.wait_for_command(Save("hall.rviz"))
    tab.wait_for(lambda: "Saved hall.rviz." in tab.text())


def test_another_file_is_replaced_only_when_that_was_meant(tab: Tab, loop: Loop) -> None:
    show(tab, LAB)
    tab.page.keyboard.press("Control+Shift+s")
    save = dialog(tab, "Save as").get_by_role("button", name="Save")
    dialog(tab, "Save as").get_by_label("File name").fill("office")
    save.click()
    tab.wait_for(lambda: "office.yaml exists already. Save again to replace it." in tab.text())
    assert loop.commands == []
    save.click()
    tab.wait_for_command(Save("office.yaml"))


def test_a_refused_name_is_told_with_the_reason(tab: Tab, loop: Loop) -> None:
    show(tab, LAB)
    tab.page.keyboard.press("Control+Shift+s")
    dialog(tab, "Save as").get_by_label("File name").fill("../lab.yaml")
    dialog(tab, "Save as").get_by_role("button", name="Save").click()
    tab.wait_for(lambda: "Enter a name without folders" in tab.text())
    dialog(tab, "Save as").get_by_role("button", name="Cancel").click()
    playwright.expect(dialog(tab, "Save as")).to_have_count(0)
    assert loop.commands == []


def test_a_file_of_the_folder_is_opened(tab: Tab) -> None:
    show(tab, LAB)
    tab.page.keyboard.press("Control+o")
    dialog(tab, "Open").get_by_role("button", name="nav2.rviz").click()
    tab.wait_for_command(Open("nav2.rviz"))


def test_files_that_come_and_go_are_shown_while_the_dialog_is_open(tab: Tab, loop: Loop) -> None:
    show(tab, ConfigFile(folder="/home/me"))
    tab.page.keyboard.press("Control+o")
    files = dialog(tab, "Open").get_by_role("group", name="Files")
    playwright.expect(files).to_contain_text("No config files there.")
    loop.show(file=LAB)
    tab.wait_for(lambda: files.get_by_role("button").count() == 3)
    tab.page.keyboard.press("Escape")


def test_unsaved_changes_are_discarded_only_when_that_was_meant(
    tab: Tab, loop: Loop, tmp_path: Path
) -> None:
    (tmp_path / "mine.yaml").write_text("version: 1\n")
    show(tab, replace(LAB, is_changed=True))
    tab.page.keyboard.press("Control+o")
    dialog(tab, "Open").get_by_role("button", name="nav2.rviz").click()
    question = dialog(tab, "Unsaved changes")
    playwright.expect(question).to_contain_text("Open nav2.rviz and discard unsaved changes?")
    tab.page.keyboard.press("Enter")  # the focus is on Cancel
    playwright.expect(question).to_have_count(0)
    upload(tab, tmp_path / "mine.yaml")
    playwright.expect(question).to_contain_text("Open mine.yaml and discard unsaved changes?")
    assert loop.commands == []
    question.get_by_role("button", name="Discard").click()
    tab.wait_for_command(Load("version: 1\n", "mine.yaml"))


@pytest.mark.parametrize("size", [0, 30, 1_500_000])
def test_a_file_of_the_browser_is_uploaded(tab: Tab, tmp_path: Path, size: int) -> None:
    text = "# ä\n" * (size // 5)
    (tmp_path / "mine.yaml").write_text(text, encoding="utf-8")
    show(tab, LAB)
    upload(tab, tmp_path / "mine.yaml")
    tab.wait_for_command(Load(text, "mine.yaml"))


@pytest.mark.parametrize(
    ("name", "content", "reason"),
    [
        ("photo.yaml", b"\xff\xd8\xff\xe0", "photo.yaml is not UTF-8 text."),
        ("large.yaml", b"#" * (2 << 20) + b"#", "large.yaml is too large for a config"),
        ("lines.yaml", b"\n" * (2 << 20), "lines.yaml is too large for a config"),
        ("photo.png", b"", "photo.png is not a config"),
    ],
)
def test_what_is_no_config_is_not_sent(
    tab: Tab, tmp_path: Path, name: str, content: bytes, reason: str
) -> None:
    (tmp_path / name).write_bytes(content)
    show(tab, LAB)
    upload(tab, tmp_path / name)
    tab.wait_for(lambda: reason in tab.text())
    assert tab.loop.commands == []


def upload(tab: Tab, path: Path) -> None:
    tab.page.keyboard.press("Control+o")
    with tab.page.expect_file_chooser() as chooser:
        dialog(tab, "Open").get_by_role("button", name="Upload from this computer").click()
    chooser.value.set_files(path)


DROP = """(text) => {
  const data = new DataTransfer();
  data.items.add(new File([text], "mine.yaml"));
  for (const type of ["dragenter", "dragover", "drop"]) {
    const event = new DragEvent(type, { dataTransfer: data, bubbles: true, cancelable: true });
    document.querySelector("#root canvas").dispatchEvent(event);
  }
}"""


def test_a_file_that_is_dropped_on_the_page_is_opened(tab: Tab) -> None:
    show(tab, LAB)
    tab.page.evaluate(DROP, "version: 1\n")
    tab.wait_for_command(Load("version: 1\n", "mine.yaml"))
    assert "Drop a config" not in tab.text()


def test_a_file_over_the_page_shades_it(tab: Tab) -> None:
    tab.page.evaluate("(name) => window.dispatchEvent(new DragEvent(name))", "dragenter")
    assert not tab.page.get_by_text("Drop a config").is_visible()
    tab.page.evaluate(
        """(text) => {
          const dataTransfer = new DataTransfer();
          dataTransfer.items.add(new File([text], "mine.yaml"));
          window.dispatchEvent(new DragEvent("dragenter", { dataTransfer }));
        }""",
        "version: 1\n",
    )
    cover = tab.page.locator(".wv-file-drop")
    # A dashed box on a shade, unlike the place that a dragged panel would take.
    playwright.expect(cover).to_have_css("border-top-width", "0px")
    playwright.expect(cover.locator("p")).to_have_css("border-top-style", "dashed")
    size = tab.page.viewport_size
    assert size is not None
    assert cover.bounding_box() == {"x": 0, "y": 0, **size}


@pytest.mark.parametrize(
    ("item", "name"), [("Download as YAML", "lab.yaml"), ("Download as .rviz", "lab.rviz")]
)
def test_what_is_shown_is_downloaded(tab: Tab, loop: Loop, item: str, name: str) -> None:
    show(tab, LAB)
    tab.button("Menu").click()
    tab.page.get_by_role("menuitem", name=item).click()
    tab.wait_for(lambda: loop.commands)
    export = loop.commands[0]
    assert isinstance(export, Export)
    assert export.name == name
    with tab.page.expect_download() as download:
        export.deliver("version: 1\n")
    assert download.value.suggested_filename == name
    assert Path(download.value.path()).read_text() == "version: 1\n"


def test_a_name_is_given_to_what_is_downloaded(tab: Tab, loop: Loop) -> None:
    show(tab, LAB)
    tab.page.keyboard.press("Control+Shift+s")
    dialog(tab, "Save as").get_by_label("File name").fill("mine")
    dialog(tab, "Save as").get_by_role("button", name="Download").click()
    tab.wait_for(lambda: loop.commands)
    export = loop.commands[0]
    assert isinstance(export, Export)
    assert export.name == "mine.yaml"

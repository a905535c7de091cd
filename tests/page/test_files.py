"""Saving, opening and downloading in the page."""

from __future__ import annotations

from pathlib import Path

import playwright.sync_api as playwright
import pytest

from tests.page.everything import named
from tests.page.page_bench import PageBench
from tests.page.tabs import ViewerTab
from webviz.commands import AddDisplay, Export, Load, Open, Save
from webviz.files import opening
from webviz.files.config import Branch, Config, Settings
from webviz_displays.grid import Grid


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of a viewer that is started without a file."""
    folder = tmp_path / "configs"
    folder.mkdir()
    monkeypatch.chdir(folder)
    return folder


@pytest.fixture
def tab(folder: Path, viewer_tab: ViewerTab) -> ViewerTab:
    """The tab of a viewer without a file."""
    wait_for_name(viewer_tab, "webviz")
    return viewer_tab


@pytest.fixture
def lab(folder: Path, viewer: PageBench, tab: ViewerTab) -> Path:
    """A file with a display, which is open, beside two others with a grid."""
    for name in ("nav2.rviz", "office.yaml"):
        opening.save(Config(Settings(), [Grid(name=name)]), folder / name)
    opening.save(Config(Settings(), [*named("scan")]), folder / "lab.yaml")
    show(tab, folder / "lab.yaml")
    tab.wait_for(lambda: "office.yaml" in viewer.states[-1].file.others)
    tab.turn()
    tab.catch_up()
    return folder / "lab.yaml"


def show(tab: ViewerTab, path: Path) -> None:
    """Show a config with a display and this file, and wait until the page knows it."""
    tab.viewer.show(*named("scan"), path=path)
    wait_for_name(tab, path.name)


def wait_for_name(tab: ViewerTab, name: str, *, is_changed: bool = False) -> None:
    """Wait until the page says that this file is open, and whether it was changed."""
    tab.wait_for(lambda: tab.page.locator(".wv-file").inner_text() == name)
    tab.wait_for(lambda: tab.page.locator(".wv-mark").is_visible() == is_changed)


def change(tab: ViewerTab, name: str) -> None:
    """Add a display, and wait until the page knows of the unsaved change."""
    tab.viewer.do(AddDisplay("Grid", {"name": "more"}))
    wait_for_name(tab, name, is_changed=True)


def names_in(file: Path) -> list[str]:
    """The displays in a config file."""
    displays = opening.load(file).displays
    return [each.name for each in displays if not isinstance(each, Branch)]


def dialog(tab: ViewerTab, title: str) -> playwright.Locator:
    return tab.page.get_by_role("dialog", name=title)


def test_the_page_is_called_as_the_file(tab: ViewerTab, folder: Path) -> None:
    assert tab.page.title() == "webviz"
    show(tab, folder / '"<b>.yaml')
    assert tab.page.title() == '"<b>.yaml · webviz'
    change(tab, '"<b>.yaml')
    assert tab.page.title() == '* "<b>.yaml · webviz'


def test_save_writes_where_it_came_from(tab: ViewerTab, lab: Path) -> None:
    change(tab, "lab.yaml")
    tab.button("Menu").click()
    tab.page.get_by_role("menuitem", name="Save Ctrl+S").click()
    tab.wait_for_command(Save())
    assert names_in(lab) == ["scan", "more"]
    wait_for_name(tab, "lab.yaml")


def test_save_without_a_file_asks_for_a_name(tab: ViewerTab, folder: Path) -> None:
    tab.page.keyboard.press("Control+s")
    assert f"In {folder} of the machine that runs webviz" in dialog(tab, "Save as").inner_text()
    dialog(tab, "Save as").get_by_label("File name").fill("hall")
    dialog(tab, "Save as").get_by_role("button", name="Save").click()
    tab.wait_for_command(Save("hall.yaml", replace=False))
    assert names_in(folder / "hall.yaml") == []
    wait_for_name(tab, "hall.yaml")


def test_enter_saves_and_the_answer_is_told(tab: ViewerTab, lab: Path) -> None:
    tab.page.keyboard.press("Control+Shift+s")
    field = dialog(tab, "Save as").get_by_label("File name")
    assert field.input_value() == "lab.yaml"
    field.fill("hall.rviz")
    field.press("Enter")
    tab.wait_for_command(Save("hall.rviz", replace=False))
    tab.wait_for(lambda: "Saved hall.rviz." in tab.text())
    assert lab.with_name("hall.rviz").read_text().startswith("Panels:\n")


def test_another_file_is_replaced_only_when_that_was_meant(tab: ViewerTab, lab: Path) -> None:
    office = lab.with_name("office.yaml")
    tab.page.keyboard.press("Control+Shift+s")
    save = dialog(tab, "Save as").get_by_role("button", name="Save")
    dialog(tab, "Save as").get_by_label("File name").fill("office")
    save.click()
    tab.wait_for(lambda: "office.yaml exists already. Save again to replace it." in tab.text())
    assert tab.viewer.commands == []
    assert names_in(office) == ["office.yaml"]
    save.click()
    tab.wait_for_command(Save("office.yaml"))
    assert names_in(office) == ["scan"]


def test_a_refused_name_is_told_with_the_reason(tab: ViewerTab, lab: Path) -> None:
    tab.page.keyboard.press("Control+Shift+s")
    dialog(tab, "Save as").get_by_label("File name").fill("../lab.yaml")
    dialog(tab, "Save as").get_by_role("button", name="Save").click()
    tab.wait_for(lambda: "Enter a name without folders" in tab.text())
    dialog(tab, "Save as").get_by_role("button", name="Cancel").click()
    playwright.expect(dialog(tab, "Save as")).to_have_count(0)
    assert tab.viewer.commands == []
    assert not (lab.parent.parent / "lab.yaml").exists()


@pytest.mark.usefixtures("lab")
def test_a_file_of_the_folder_is_opened(tab: ViewerTab) -> None:
    tab.page.keyboard.press("Control+o")
    dialog(tab, "Open").get_by_role("button", name="nav2.rviz").click()
    tab.wait_for_command(Open("nav2.rviz"))
    assert tab.viewer.outline() == "nav2.rviz"
    wait_for_name(tab, "nav2.rviz")


def test_files_that_come_and_go_are_shown_while_the_dialog_is_open(
    tab: ViewerTab, folder: Path
) -> None:
    tab.page.keyboard.press("Control+o")
    files = dialog(tab, "Open").get_by_role("group", name="Files")
    playwright.expect(files).to_contain_text("No config files there.")
    for name in ("lab.yaml", "nav2.rviz", "office.yaml"):
        (folder / name).touch()
    tab.wait_for(lambda: files.get_by_role("button").count() == 3)
    (folder / "nav2.rviz").unlink()
    tab.wait_for(lambda: files.get_by_role("button").count() == 2)
    tab.page.keyboard.press("Escape")


@pytest.mark.usefixtures("lab")
def test_unsaved_changes_are_discarded_only_when_that_was_meant(
    tab: ViewerTab, tmp_path: Path
) -> None:
    (tmp_path / "mine.yaml").write_text("version: 1\n")
    change(tab, "lab.yaml")
    tab.page.keyboard.press("Control+o")
    dialog(tab, "Open").get_by_role("button", name="nav2.rviz").click()
    question = dialog(tab, "Unsaved changes")
    playwright.expect(question).to_contain_text("Open nav2.rviz and discard unsaved changes?")
    tab.page.keyboard.press("Enter")  # the focus is on Cancel
    playwright.expect(question).to_have_count(0)
    upload(tab, tmp_path / "mine.yaml")
    playwright.expect(question).to_contain_text("Open mine.yaml and discard unsaved changes?")
    assert tab.viewer.commands == []
    assert tab.viewer.outline() == "scan more"
    question.get_by_role("button", name="Discard").click()
    tab.wait_for_command(Load("version: 1\n", "mine.yaml"))
    assert tab.viewer.outline() == ""


@pytest.mark.usefixtures("lab")
@pytest.mark.parametrize("size", [0, 30, 1_500_000])
def test_a_file_of_the_browser_is_uploaded(tab: ViewerTab, tmp_path: Path, size: int) -> None:
    text = "version: 1\n" + "# ä\n" * (size // 5) if size else ""
    (tmp_path / "mine.yaml").write_text(text, encoding="utf-8")
    upload(tab, tmp_path / "mine.yaml")
    tab.wait_for_command(Load(text, "mine.yaml"))
    answer = "Opened mine.yaml (not yet saved on this machine)." if size else "mine.yaml is empty: "
    tab.wait_for(lambda: answer in tab.text())
    assert tab.viewer.outline() == ("" if size else "scan")


@pytest.mark.parametrize(
    ("name", "content", "reason"),
    [
        ("photo.yaml", b"\xff\xd8\xff\xe0", "photo.yaml is not UTF-8 text."),
        ("large.yaml", b"#" * (2 << 20) + b"#", "large.yaml is too large for a config"),
        ("lines.yaml", b"\n" * (2 << 20), "lines.yaml is too large for a config"),
        ("photo.png", b"", "photo.png is not a config"),
    ],
)
@pytest.mark.usefixtures("lab")
def test_what_is_no_config_is_not_sent(
    tab: ViewerTab, tmp_path: Path, name: str, content: bytes, reason: str
) -> None:
    (tmp_path / name).write_bytes(content)
    upload(tab, tmp_path / name)
    tab.wait_for(lambda: reason in tab.text())
    assert tab.viewer.commands == []
    assert tab.viewer.outline() == "scan"


def upload(tab: ViewerTab, path: Path) -> None:
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


@pytest.mark.usefixtures("lab")
def test_a_file_that_is_dropped_on_the_page_is_opened(tab: ViewerTab) -> None:
    tab.page.evaluate(DROP, "version: 1\n")
    tab.wait_for_command(Load("version: 1\n", "mine.yaml"))
    assert tab.viewer.outline() == ""
    assert "Drop a config" not in tab.text()


def test_a_file_over_the_page_shades_it(tab: ViewerTab) -> None:
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
@pytest.mark.usefixtures("lab")
def test_what_is_shown_is_downloaded(tab: ViewerTab, item: str, name: str) -> None:
    tab.button("Menu").click()
    with tab.page.expect_download() as download:
        tab.page.get_by_role("menuitem", name=item).click()
        tab.wait_for(lambda: tab.viewer.commands)
    (export,) = tab.viewer.commands
    assert isinstance(export, Export)
    assert export.name == name
    check_download(tab, download.value, name)


def check_download(tab: ViewerTab, download: playwright.Download, name: str) -> None:
    """Check that a file of this name was downloaded, with all that the viewer shows."""
    text, _ = opening.text_of(tab.viewer.viewer.config(), name)
    assert download.suggested_filename == name
    assert Path(download.path()).read_text() == text


@pytest.mark.usefixtures("lab")
def test_a_name_is_given_to_what_is_downloaded(tab: ViewerTab) -> None:
    tab.page.keyboard.press("Control+Shift+s")
    dialog(tab, "Save as").get_by_label("File name").fill("mine")
    with tab.page.expect_download() as download:
        dialog(tab, "Save as").get_by_role("button", name="Download").click()
        tab.wait_for(lambda: tab.viewer.commands)
    (export,) = tab.viewer.commands
    assert isinstance(export, Export)
    assert export.name == "mine.yaml"
    check_download(tab, download.value, "mine.yaml")

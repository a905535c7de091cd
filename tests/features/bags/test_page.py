"""Bags and written files in the page, in a real browser."""

from __future__ import annotations

import base64
from collections.abc import Iterator
from pathlib import Path

import playwright.sync_api as playwright
import pytest
from bags import strings
from playwright.sync_api import expect
from waiting import until

from tests.features.bags.conftest import LibraryViewer


@pytest.fixture
def page(library: LibraryViewer, browser: playwright.Browser) -> Iterator[playwright.Page]:
    context = browser.new_context(
        viewport={"width": 1280, "height": 720}, permissions=["clipboard-read", "clipboard-write"]
    )
    page = context.new_page()
    errors: list[str] = []
    page.on("pageerror", lambda error: errors.append(str(error)))
    page.goto(library.viewer.url)
    expect(page.get_by_role("button", name="Record", exact=True)).to_be_visible(timeout=60_000)
    yield page
    context.close()
    assert errors == []


def test_a_bag_is_opened_beside_configs_and_live_topics_come_back(
    library: LibraryViewer, page: playwright.Page
) -> None:
    page.keyboard.press("Control+o")
    bags = page.get_by_role("group", name="Bags")
    expect(bags.get_by_role("button")).to_contain_text(["run.mcap"])
    bags.get_by_role("button", name="run.mcap").focus()
    page.keyboard.press("Enter")
    until(lambda: library.names() == ("run.mcap",))
    expect(page.get_by_role("dialog")).to_have_count(0)
    expect(page.get_by_text("press L to return")).to_be_visible()
    page.keyboard.press("l")
    until(lambda: library.names() == ())


def test_a_second_run_is_compared_and_goes_again(
    library: LibraryViewer, page: playwright.Page
) -> None:
    strings(0.0, 0.5).write_file(library.folder / "second.mcap")
    dialog = page.get_by_role("dialog", name="Open")
    page.keyboard.press("Control+o")
    expect(dialog.get_by_role("button", name="Compare")).to_have_count(0)
    dialog.get_by_role("button", name="run.mcap").click()
    until(lambda: library.names() == ("run.mcap",))
    page.keyboard.press("Control+o")
    line = dialog.locator(".wv-bag-line", has_text="second.mcap")
    line.get_by_role("button", name="Compare").click()
    until(lambda: library.names() == ("run.mcap", "second.mcap"))
    expect(page.get_by_role("treeitem", name="Ghost", exact=False).first).to_be_visible()
    page.keyboard.press("Control+o")
    expect(dialog).to_contain_text("second.mcap is shown beside run.mcap.")
    dialog.get_by_role("button", name="End comparison").click()
    until(lambda: library.names() == ("run.mcap",))
    expect(page.get_by_role("treeitem", name="Ghost", exact=False)).to_have_count(0)


def test_a_saved_bag_is_shown_with_path_and_download(
    library: LibraryViewer, page: playwright.Page
) -> None:
    page.get_by_role("button", name="Save last").click()
    card = page.get_by_label("File", exact=True)
    expect(card).to_contain_text("Saved the last")
    (output,) = library.store("outputs").values()
    expect(card).to_contain_text(output["path"])
    card.get_by_role("button", name="Copy path").click()
    expect(page.get_by_text("Path copied.")).to_be_visible()
    assert page.evaluate("navigator.clipboard.readText()") == output["path"]
    downloads: list[playwright.Download] = []
    page.on("download", lambda download: downloads.append(download))
    card.get_by_role("button", name="Download").click()
    files = sorted(Path(output["path"]).iterdir())
    until(lambda: len(downloads) == len(files), turn=lambda: page.wait_for_timeout(50))
    for download, file in zip(downloads, files, strict=True):
        assert download.suggested_filename == file.name
        assert Path(download.path()).read_bytes() == file.read_bytes()
    card.get_by_role("button", name="Open here").click()
    until(lambda: library.names() == (output["name"],))
    expect(card).to_be_hidden()


def test_another_page_is_not_disturbed(library: LibraryViewer, page: playwright.Page) -> None:
    assert library.guest.do("SaveMemory").startswith("Saved")
    page.keyboard.press("Control+o")
    expect(page.get_by_role("group", name="Bags").get_by_role("button")).to_have_count(2)
    expect(page.get_by_label("File", exact=True)).to_be_hidden()


DROP = """([name, text]) => {
  const bytes = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
  const data = new DataTransfer();
  data.items.add(new File([bytes], name));
  for (const type of ["dragenter", "dragover", "drop"]) {
    const event = new DragEvent(type, { dataTransfer: data, bubbles: true, cancelable: true });
    document.querySelector("#root canvas").dispatchEvent(event);
  }
}"""


def test_a_bag_that_is_dropped_is_played(
    library: LibraryViewer, page: playwright.Page, tmp_path: Path
) -> None:
    bag = strings(*(0.01 * i for i in range(2000))).write_file(tmp_path / "dropped.mcap")
    content = base64.b64encode(bag.read_bytes()).decode()
    page.evaluate(DROP, ["dropped.mcap", content])
    until(lambda: library.names() == ("dropped.mcap",))
    expect(page.get_by_text("press L to return")).to_be_visible()
    expect(page.locator(".wv-upload-card")).to_be_hidden()
    page.evaluate(DROP, ["broken.zip", content])
    expect(page.get_by_text("is not a bug report")).to_be_visible()
    assert library.names() == ("dropped.mcap",)

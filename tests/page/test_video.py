"""Videos that the page records."""

from __future__ import annotations

from pathlib import Path

from playwright.sync_api import expect

from tests.page.tabs import ViewerTab

SPIN = """() => {
  window.spins = true;
  const draw = () => {
    window.__viserMutable.requestRender?.();
    if (window.spins) requestAnimationFrame(draw);
  };
  draw();
}"""


def test_a_video_of_the_scene_is_saved_by_the_browser(
    viewer_tab: ViewerTab, tmp_path: Path
) -> None:
    viewer_tab.page.get_by_role("button", name="Menu", exact=True).click()
    viewer_tab.page.get_by_role("menuitem", name="Record or stop a video").click()
    stop = viewer_tab.page.get_by_role("button", name="Stop recording the video")
    expect(stop).to_be_visible()
    viewer_tab.page.evaluate(SPIN)
    expect(stop).to_contain_text("Recording a video: ")
    viewer_tab.wait_for(lambda: "· 0 kB" not in stop.inner_text())
    with viewer_tab.page.expect_download() as download:
        stop.click()
    expect(stop).to_be_hidden()
    viewer_tab.page.evaluate("window.spins = false")
    path = tmp_path / download.value.suggested_filename
    download.value.save_as(path)
    assert path.suffix in (".mp4", ".webm")
    head = path.read_bytes()[:64]
    assert b"ftyp" in head or head.startswith(b"\x1a\x45\xdf\xa3")

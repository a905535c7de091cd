"""The site of the documentation: it builds, and every link leads somewhere."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

import pytest

ROOT = Path(__file__).parents[2]
OURS = "https://webviz.example/"


class Anchors(HTMLParser):
    """The links and ids of a page."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.ids: set[str] = {""}
        self.links: list[str] = []
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        for name, value in attrs:
            if name == "id" and value:
                self.ids.add(value)
            elif name in ("href", "src") and value and tag != "link":
                self.links.append(value)


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "tests.site", str(folder)]
    completed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert completed.returncode == 0, completed.stdout + completed.stderr
    return folder / "html"


def test_every_link_of_the_site_leads_to_a_page_and_a_heading(site: Path) -> None:
    pages = {path: Anchors(path) for path in site.rglob("*.html")}
    assert len(pages) > 150
    assert [*_broken(site, pages)] == []


def _broken(site: Path, pages: dict[Path, Anchors]) -> Iterator[str]:
    for path, page in pages.items():
        for link in page.links:
            url = urlsplit(link.removeprefix(OURS[:-1]))
            if url.scheme or url.netloc:
                continue
            start = site if url.path.startswith("/") else path.parent
            target = (start / unquote(url.path).lstrip("/")).resolve() if url.path else path
            target = target / "index.html" if target.is_dir() else target
            if not target.is_file():
                yield f"{path.relative_to(site)}: {link}"
            elif target in pages and unquote(url.fragment) not in pages[target].ids:
                yield f"{path.relative_to(site)}: no heading {link}"


def test_a_run_is_embedded_and_small(site: Path) -> None:
    page, run = site / "run/index.html", site / "runs/building.html"
    assert '<iframe src="../runs/building.html"' in page.read_text(encoding="utf-8")
    assert 1_000_000 < run.stat().st_size < 6_000_000


def test_pages_load_nothing_from_elsewhere(site: Path) -> None:
    text = (site / "index.html").read_text(encoding="utf-8")
    assert re.findall(r"""(?:src|rel="stylesheet" href)=["']?(https?:[^"' >]*)""", text) == []

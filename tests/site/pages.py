"""The Markdown of the repository as pages of a site, with links between them."""

from __future__ import annotations

import posixpath
import re
import shutil
from collections.abc import Mapping
from pathlib import Path, PurePosixPath

ROOT = Path(__file__).parents[2]
DOCS = "displays/docs/"
RENAMED = {
    "README.md": "index.md",
    "tests/benchmarks/README.md": "benchmarks.md",
    **{name: name.lower() for name in ("ARCHITECTURE.md", "CHANGELOG.md", "CONTRIBUTING.md")},
    "SECURITY.md": "security.md",
}
"""Pages from outside the documentation, by their path in the repository."""
LABEL = r"(?:[^\[\]]|!\[[^\]]*\]\([^)]*\)|\[[^\]]*\])*"
LINK = re.compile(rf"(!?)\[({LABEL})\]\(([^)\s]+)\)")
LINK_OR_CODE = re.compile(rf"(?P<code>```.*?```)|{LINK.pattern}|(?P<word>`[^`\n]*`)", re.DOTALL)


def pages() -> Mapping[str, str]:
    """Paths on the site by path in the repository."""
    targets = dict(RENAMED)
    for path in sorted((ROOT / DOCS).rglob("*.md")):
        name = path.relative_to(ROOT).as_posix()
        targets[name] = _page(name.removeprefix(DOCS))
    return targets


def _page(name: str) -> str:
    """The path of a page of the documentation: that of a folder is its index."""
    path = PurePosixPath("displays/README.md" if name == "README.md" else name)
    return (path.with_name("index.md") if path.name == "README.md" else path).as_posix()


def write(folder: Path) -> None:
    """Write all pages and their pictures to a folder."""
    targets = pages()
    for name, target in targets.items():
        path = folder / target
        path.parent.mkdir(parents=True, exist_ok=True)
        text = (ROOT / name).read_text(encoding="utf-8")
        path.write_text(_linked(text, name, targets, folder), encoding="utf-8")


def _linked(text: str, name: str, targets: Mapping[str, str], folder: Path) -> str:
    """The text of a page with links as they are on the site."""

    def replaced(match: re.Match[str]) -> str:
        if any(match.groupdict().values()):
            return match[0]  # code
        mark, label, link = match[2], match[3], match[4]
        label = LINK_OR_CODE.sub(replaced, label)  # a picture may be a link
        path, _, anchor = link.partition("#")
        if not path or ":" in path:
            return f"{mark}[{label}]({link})"
        inside = posixpath.normpath(posixpath.join(posixpath.dirname(name), path))
        target = targets.get(inside) or targets.get(f"{inside}/README.md")
        if target is None:
            if not mark:
                return label  # of code, which only a clone has
            target = _picture(inside, folder)
        relative = posixpath.relpath(target, posixpath.dirname(targets[name]) or ".")
        return f"{mark}[{label}]({relative}{'#' if anchor else ''}{anchor})"

    return LINK_OR_CODE.sub(replaced, text)


def _picture(name: str, folder: Path) -> str:
    """The path on the site of a picture, which is copied there."""
    target = f"pictures/{name.replace('/', '-')}"
    (folder / target).parent.mkdir(exist_ok=True)
    shutil.copyfile(ROOT / name, folder / target)
    return target

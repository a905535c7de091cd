"""Builds the site of the documentation: `make site`."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

from ruamel.yaml import YAML

from tests.site import example
from tests.site.pages import DOCS, ROOT, pages, write

Entry = dict[str, object]
DISPLAYS = sorted((ROOT / DOCS).glob("*.md"))

TASKS = {
    "Home": "README.md",
    "Start": {
        "Installing": "installing/README.md",
        "A run in your browser": example.NAME,
        "The page": "page/README.md",
        "RViz2's tasks": "page/rviz2_tasks.md",
        "Compared with others": "page/comparison.md",
    },
    "Tasks": {
        "Configs": "config/README.md",
        "Time": "time/README.md",
        "Finding faults": "doctor/README.md",
        "ROS": "ros/README.md",
        "Which way to my robot?": "ros/which_way.md",
        "Several robots": "ros/robots.md",
        "Your ROS": "ros/distributions.md",
        "Far away": "ros/far_away.md",
        "Bridges": "ros/bridge.md",
        "A course": "ros/course.md",
        "Outdoors": "outdoors/README.md",
        "Serving": "serving/README.md",
        "Pictures": "pictures/README.md",
        "Visual tests": "testing/README.md",
    },
    "Tools and panels": {"Tools": "tools.md", "Panels": "page/panels.md"},
    "Python": {
        "From Python": "python/README.md",
        "From an RViz plug-in": "python/from_rviz.md",
        "API": "api.md",
        "Examples": "examples/README.md",
        "Agents": "python/agents.md",
        "Reference": "reference.md",
    },
}
ABOUT = {
    "Benchmarks": "tests/benchmarks/README.md",
    "Architecture": "ARCHITECTURE.md",
    "Contributing": "CONTRIBUTING.md",
    "Security": "SECURITY.md",
    "Changelog": "CHANGELOG.md",
}
CONFIG = """\
[project]
site_name = "webviz"
site_url = "https://webviz.example/"
site_description = "RViz2 in a browser tab"
docs_dir = "docs"
site_dir = "html"
nav = {nav}

[project.theme]
language = "en"
font = false
features = [
  "content.code.copy", "navigation.indexes", "navigation.instant", "navigation.path",
  "navigation.top", "navigation.tracking", "search.highlight",
]

[[project.theme.palette]]
media = "(prefers-color-scheme: light)"
scheme = "default"

[[project.theme.palette]]
media = "(prefers-color-scheme: dark)"
scheme = "slate"

[project.markdown_extensions]
attr_list = {{}}
tables = {{}}
toc.permalink = true
pymdownx.highlight.anchor_linenums = true
pymdownx.superfences = {{}}
"""


def build(folder: Path) -> Path:
    """Build the site.

    Args:
        folder: which is emptied; the site is in its subfolder `html`.

    Returns:
        That subfolder.
    """
    shutil.rmtree(folder, ignore_errors=True)
    write(folder / "docs")
    example.write(folder / "docs")
    config = folder / "zensical.toml"
    config.write_text(CONFIG.format(nav=_toml(_nav())), encoding="utf-8")
    subprocess.run(
        [Path(sys.executable).with_name("zensical"), "build", "--strict", "-f", config],
        check=True,
        cwd=folder,
    )
    return folder / "html"


def _nav() -> list[Entry]:
    """The pages in the order of the menu; those of no chapter are found by links and search."""
    chapters: Entry = {**TASKS, "Displays": _displays(), "About": ABOUT}
    pages_by_name = {**pages(), example.NAME: example.NAME}
    return [_entry(title, what, pages_by_name) for title, what in chapters.items()]


def _displays() -> Entry:
    """The overview, and the page of each display in its group."""
    groups = YAML(typ="safe").load(ROOT / DOCS / "groups.yaml")
    by_title = {path.read_text().partition("\n")[0]: path.name for path in DISPLAYS}
    result: Entry = {"All": "README.md"}
    for group, names in groups.items():
        result[group] = {name: by_title[f"# {name}"] for name in names}
    return result


def _entry(title: str, what: object, pages_by_name: Mapping[str, str]) -> Entry:
    if isinstance(what, dict):
        return {title: [_entry(str(each), path, pages_by_name) for each, path in what.items()]}
    name = str(what)
    is_home = title == "Home"
    return {
        title: pages_by_name[name]
        if is_home or f"{DOCS}{name}" not in pages_by_name
        else pages_by_name[DOCS + name]
    }


def _toml(value: object) -> str:
    """A value as TOML on one line."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(k)} = {_toml(v)}" for k, v in value.items()) + "}"
    if isinstance(value, Iterable) and not isinstance(value, str):
        return "[" + ", ".join(map(_toml, value)) + "]"
    return json.dumps(value)


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if sys.argv[1:] else ROOT / "build" / "site"
    print(f"Open {build(folder) / 'index.html'} in a browser.")

"""Contents of the distribution: all files, requirements and licences."""

from __future__ import annotations

import fnmatch
import json
import re
import subprocess
import sys
import tarfile
import tomllib
from importlib import metadata
from pathlib import Path

import pytest
import viser

ROOT = Path(__file__).parents[2]
PACKAGES = ("webviz", "displays/webviz_displays", "urdf/webviz_urdf", "sim/webviz_sim")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
LICENCES = (ROOT / "THIRD_PARTY.md").read_text(encoding="utf-8")
CLIENT = Path(viser.__file__).parent / "client"
OPTIONAL = {"rclpy", "xacro", "pytest", "_pytest"}
"""Modules of ROS and of those who write tests; imported where they are used."""
EXTRAS = "pictures", "outdoors", "foxglove", "rosbridge", "zenoh", "mcp"
"""Extras whose modules are imported where they are used."""
REQUIREMENT = {"google": "protobuf", "PIL": "pillow", "collada": "pycollada", "re2": "google_re2"}
REQUIREMENT |= {"ruamel": "ruamel.yaml", "zenoh": "eclipse_zenoh"}
"""Names of modules that are named otherwise."""
IMPORT = re.compile(r"^ *(?:import (\w+)|from (\w+)[\w.]* import )", re.MULTILINE)
OF_ROS = re.compile(r"(\w+_(msgs|srvs|interfaces|runtime_py)|rcl_\w+|rpyutils)$")


def requirements(*extras: str) -> set[str]:
    """The names of what webviz requires."""
    expected = list(PROJECT["dependencies"])
    for extra in extras:
        expected += PROJECT["optional-dependencies"][extra]
    return {re.split(r"[<>=!\[; ]", each)[0].lower() for each in expected}


def files() -> list[Path]:
    listed = subprocess.run(
        ["git", "ls-files", *PACKAGES], cwd=ROOT, capture_output=True, text=True, check=False
    )
    if listed.returncode:
        pytest.skip("not a clone of the repository")
    return [Path(name) for name in listed.stdout.splitlines()]


def test_every_file_of_the_packages_is_installed() -> None:
    setup = (ROOT / "setup.py").read_text(encoding="utf-8")
    patterns = re.search(r'DATA = """([^"]*)"""', setup)
    assert patterns
    globs = ["*.py", *patterns[1].split()]
    missing = [str(f) for f in files() if not any(fnmatch.fnmatch(f.name, p) for p in globs)]
    assert missing == []


def test_the_description_on_a_package_index_has_no_links_into_a_clone() -> None:
    about = metadata.metadata("ros-webviz")
    text = about.json["description"]
    assert isinstance(text, str)
    assert "## Two commands" in text
    links = re.findall(r"\]\(([^)]*)\)", text)
    assert [each for each in links if not each.startswith("http")] == []
    assert about["Author-email"]
    assert about["Keywords"]


def test_every_imported_library_is_required() -> None:
    packages = {name.replace("-", "_") for name in requirements(*EXTRAS)} | OPTIONAL
    packages |= sys.stdlib_module_names | {Path(package).name for package in PACKAGES}
    result: dict[str, Path] = {}
    for file in files():
        if file.suffix == ".py":
            text = (ROOT / file).read_text(encoding="utf-8")
            result |= dict.fromkeys((a or b for a, b in IMPORT.findall(text)), file)
    missing = {name: str(file) for name, file in result.items() if not OF_ROS.match(name)}
    assert {n: f for n, f in missing.items() if REQUIREMENT.get(n, n) not in packages} == {}


def test_the_licence_of_every_requirement_is_listed() -> None:
    rows = dict(re.findall(r"^\| `([\w.-]+)` \| (.+?) \|", LICENCES, re.MULTILINE))
    assert rows.keys() == requirements("ros", *EXTRAS)
    for name, licence in rows.items():
        try:
            about = metadata.metadata(name)
        except metadata.PackageNotFoundError:
            continue
        keys = ("License-Expression", "License", "Classifier")
        fields = [each for key in keys for each in about.get_all(key) or []]
        text = " ".join(f for f in fields if " :: " not in f)
        text += " ".join(f for f in fields if f.startswith("License ::"))
        if text.strip():  # the wheels of ROS say nothing
            word = re.split(r"[- ]", licence)[0]
            assert word in text, f"{name}: {licence} is listed, its metadata say {text!r:.200}"


def test_the_licences_of_visers_page_are_listed() -> None:
    expected = json.loads((CLIENT / "package.json").read_text(encoding="utf-8"))["dependencies"]
    lock = json.loads((CLIENT / "package-lock.json").read_text(encoding="utf-8"))["packages"]
    section = LICENCES.partition("## In the page")[2].partition("\n## ")[0]
    listed = {
        name: line.partition("**")[2].partition("**")[0]
        for line in section.splitlines()
        for name in re.findall(r"`(@?[\w./-]+)`", line)
    }
    copies = [each.name for each in (CLIENT / "src/vendor").iterdir()]
    assert all(f"/{name} (MIT)" in section for name in copies), copies
    assert listed == {name: lock[f"node_modules/{name}"]["license"] for name in expected}


def test_a_source_distribution_has_all_that_a_wheel_needs_and_no_tests(tmp_path: Path) -> None:
    files()  # skips without a clone
    clone, output = tmp_path / "clone", tmp_path / "made"
    clone.mkdir()
    tree = subprocess.run(
        ["git", "ls-files", "-z", "--", ".", ":!tests"], cwd=ROOT, capture_output=True, check=True
    )
    for name in tree.stdout.decode().split("\0")[:-1]:
        (clone / name).parent.mkdir(parents=True, exist_ok=True)
        (clone / name).symlink_to(ROOT / name)
    (clone / "tests").mkdir()
    (clone / "tests/test_none.py").touch()
    command = [sys.executable, "setup.py", "-q", "sdist", "--formats=tar", "-d", str(output)]
    outcome = subprocess.run(command, cwd=clone, capture_output=True, text=True)
    assert outcome.returncode == 0, outcome.stderr
    with tarfile.open(next(output.iterdir())) as archive:
        inside = {name.partition("/")[2] for name in archive.getnames()}
    about = {"LICENSE", "THIRD_PARTY.md", "README.md", "package.xml", "setup.py", "pyproject.toml"}
    assert {*map(str, files()), *about} <= inside
    assert [name for name in inside if name.startswith("tests")] == []

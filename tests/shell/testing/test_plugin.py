"""The fixtures in other packages: separate pytest runs in separate folders."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

pytest_plugins = ["pytester"]

CONFIG = """\
version: 1
view: {distance: 6}
displays:
- type: Grid
- {type: Axes, length: 2.0, radius: 0.2}
"""
TESTS = """\
def test_axes(webviz_harness):
    stage = webviz_harness("robot.yaml")
    assert stage.axes("Axes").tolist() == [[0, 0, 0]]
    stage.check_picture("axes", each_display=True)

def test_axes_that_are_masked(webviz_harness):
    stage = webviz_harness("robot.yaml", size=(200, 150))
    stage.check_picture("masked", mask=[(20, 0, 190, 150)])
"""
NEW = """\
def test_new(webviz_harness):
    webviz_harness("robot.yaml").check_picture("new")
"""


@pytest.fixture
def package(pytester: pytest.Pytester) -> pytest.Pytester:
    """A package with a config and two tests, without pictures."""
    (pytester.path / "test").mkdir()
    (pytester.path / "test/robot.yaml").write_text(CONFIG)
    (pytester.path / "test/test_robot.py").write_text(TESTS)
    return pytester


@pytest.fixture(autouse=True)
def other_plugins(monkeypatch: pytest.MonkeyPatch) -> None:
    """None: to import hypothesis takes longer than most of these runs."""
    monkeypatch.setenv("PYTEST_DISABLE_PLUGIN_AUTOLOAD", "1")


def run(package: pytest.Pytester, *arguments: str) -> pytest.RunResult:
    options = ("-p", "no:cacheprovider", "-p", "webviz")
    return package.runpytest_subprocess(*options, *arguments, timeout=120)


def test_pictures_are_made_compared_and_masked(
    package: pytest.Pytester,
) -> None:
    run(package, "--update-pictures").assert_outcomes(passed=2)
    pictures = package.path / "test/pictures"
    assert sorted(path.name for path in pictures.iterdir()) == ["axes.png", "masked.png"]

    pictures.rename(package.path / "reference")
    package.makeini("[pytest]\nwebviz_pictures = reference\n")
    config = package.path / "test/robot.yaml"
    config.write_text(CONFIG.replace("length: 2.0", "length: 1.0"))
    (package.path / "test/test_new.py").write_text(NEW)
    result = run(package)
    result.assert_outcomes(failed=2, passed=1)
    result.stdout.fnmatch_lines(
        ["E *AssertionError: reference/new.png is missing. Run pytest with --update-pictures*"]
    )
    assert not (package.path / "reference/new.png").exists()
    result.stdout.fnmatch_lines(
        [
            "E *AssertionError: * % of the picture differ from reference/axes.png. See "
            "picture_output/axes.png and picture_output/axes.difference.png.*"
        ]
    )
    file_names = sorted(path.name for path in (package.path / "picture_output").iterdir())
    assert file_names == ["axes.difference.png", "axes.png"]
    # The message stands below the line of the test that asked, without the inside of webviz.
    assert "webviz/testing" not in result.stdout.str()


def test_without_a_browser_scenes_are_read_and_failures_are_one_sentence(
    package: pytest.Pytester, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", "")
    monkeypatch.setenv("PLAYWRIGHT_BROWSERS_PATH", str(package.path))
    package.makepyfile(
        test_first="""
        def test_grid(webviz_harness):
            import sys
            assert len(webviz_harness("test/robot.yaml").lines("Grid")) == 22
            assert "playwright" not in sys.modules

        def test_missing(webviz_harness):
            webviz_harness("robt.yaml")
        """
    )
    result = run(package, "test_first.py", "test", "--update-pictures")
    result.assert_outcomes(passed=1, failed=3)
    result.stdout.fnmatch_lines(["E *Cannot read *robt.yaml: No such file or directory*"])
    result.stdout.fnmatch_lines(
        ["E *NoBrowser: No browser found. Install Chromium or Google Chrome*"]
    )


def test_pytest_lists_the_fixtures_and_options(package: pytest.Pytester) -> None:
    text = run(package, "--fixtures", "-v").stdout.str()
    for name in ("webviz_harness", "webviz_viewer", "webviz_domain"):
        assert name in text
    assert "--update-pictures" in run(package, "--help").stdout.str()


def test_the_plug_in_imports_nothing_heavy_until_used(tmp_path: Path) -> None:
    (tmp_path / "test_nothing.py").write_text(
        "import sys\n"
        "def test_nothing():\n"
        "    heavy = {'viser', 'rclpy', 'playwright', 'PIL', 'rosbags', 'trimesh', 'ruamel'}\n"
        "    assert 'webviz.shell.pytest_plugin' in sys.modules\n"
        "    assert heavy & sys.modules.keys() == set()\n"
    )
    options = ["-q", "-p", "no:cacheprovider", "-p", "webviz"]
    command = [sys.executable, "-m", "pytest", *options, str(tmp_path)]
    finished = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert finished.returncode == 0, finished.stdout

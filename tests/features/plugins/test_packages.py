"""A package of another author, found by its entry point alone."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

EXAMPLE = Path(__file__).with_name("polygon.py")
ENTRY_POINTS = """\
[webviz.displays]
Fence = acme_displays.fence:Area
Gone = acme_displays.gone:Gone
Torn = acme_displays.torn:Torn
[webviz.checks]
acme = acme_displays.checks
"""
TORN = """\
from webviz import Display, Sync

class Torn(Display):
    sync = Sync("image", "info")
"""
CHECKS = """\
from webviz import Check

class Loose(Check):
    \"\"\"Loose fence.\"\"\"

    id = "DATA950"

    def find(self, seen):
        yield self.found("The fence is loose.", "Fix it.")
"""
CONFIG = """\
fixed_frame: map
displays:
- {type: Fence, color: [1, 2, 3]}
- {type: Gone}
- {type: Fenc}
- {type: Torn}
"""


@pytest.fixture
def run(tmp_path: Path) -> Callable[[str], str]:
    """Run Python code where a package is installed that webviz knows nothing of."""
    package = tmp_path / "acme_displays"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "fence.py").write_text(EXAMPLE.read_text())
    (package / "torn.py").write_text(TORN)
    (package / "checks.py").write_text(CHECKS)
    info = tmp_path / "acme_displays-1.0.dist-info"
    info.mkdir()
    (info / "METADATA").write_text("Metadata-Version: 2.1\nName: acme-displays\nVersion: 1.0\n")
    (info / "entry_points.txt").write_text(ENTRY_POINTS)
    (tmp_path / "x.yaml").write_text(CONFIG)
    path = os.pathsep.join([str(tmp_path), *sys.path])

    def run(code: str) -> str:
        result = subprocess.run(
            [sys.executable, "-c", code],
            capture_output=True,
            text=True,
            timeout=60,
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": path},
        )
        assert result.returncode == 0, result.stderr
        return result.stdout

    return run


def test_a_display_of_another_package_is_a_type_among_the_built_in_ones(
    run: Callable[[str], str],
) -> None:
    result = run("from webviz.api.registry import display_types; print(*display_types())").split()
    assert {"Fence", "Grid", "LaserScan"} <= set(result)


def test_a_config_can_name_it_and_is_saved_so(run: Callable[[str], str]) -> None:
    text = run(
        "from pathlib import Path\n"
        "from webviz.files.config import dump\n"
        "from webviz.files.opening import load\n"
        "print(dump(load(Path('x.yaml'))))"
    )
    assert "type: Fence\n  color: [1, 2, 3]" in text
    assert "type: Gone" in text


def test_a_display_that_does_not_load_is_reported_and_harms_no_other(
    run: Callable[[str], str],
) -> None:
    fence, gone, typo, torn = run(
        "from pathlib import Path\n"
        "from webviz.files.opening import load\n"
        "for display in load(Path('x.yaml')).displays:\n"
        "    print(type(display).__name__, getattr(display, 'reason', ''))"
    ).splitlines()
    assert fence.split() == ["Area"]
    place = "x.yaml:4: displays[1].type"
    assert f"{place}: acme_displays.gone:Gone does not load: ModuleNotFoundError" in gone
    assert "Torn does not load: TypeError: Torn.sync: 'image' is not an input" in torn
    assert "unknown display type `Fenc`, did you mean `Fence`?" in typo


def test_a_file_cannot_take_its_name(run: Callable[[str], str]) -> None:
    Path(run("import os; print(os.getcwd())").strip(), "own.py").write_text(
        "from webviz import Display\n\nclass Fence(Display):\n    pass\n"
    )
    text = run(
        "from webviz.shell.cli import main\n"
        "import sys; sys.stderr = sys.stdout\n"
        "print(main(['--plugin', 'own.py', '--port', '0']))"
    )
    assert text.splitlines() == [
        "webviz: own.py cannot be used: an installed package has a display named Fence. "
        "Rename the class.",
        "1",
    ]


def test_its_checks_are_run_and_take_no_ids_of_others(run: Callable[[str], str]) -> None:
    result = run(
        "with open('acme_displays/checks.py', 'a') as file:\n"
        "    file.write('class Thief(Check):\\n    id = \"TF003\"\\n')\n"
        "from webviz.api.check_registry import known_checks\n"
        "for check in known_checks(): print(check.id, check.__module__)"
    ).splitlines()
    assert "DATA950 acme_displays.checks" in result
    assert [each for each in result if each.startswith("TF003 ")] == [
        "TF003 webviz.checks.frames.localisation_missing"
    ]

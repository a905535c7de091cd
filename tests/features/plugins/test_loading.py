"""Loading of `--plugin FILE.py`, and one sentence for every mistake."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.features.plugins.conftest import Plugin
from webviz.api import registry
from webviz.engine.pipeline.plugins import PluginError, Watcher, load
from webviz.files.config import dump
from webviz.files.opening import parse

ROOT = Path(__file__).parents[3]
IMPORT = "from webviz import Display\n"


def refusal(path: Path) -> str:
    """The sentence with which a file is refused."""
    with pytest.raises(PluginError) as excinfo:
        load(path)
    assert "\n" not in str(excinfo.value)
    return str(excinfo.value)


def test_the_example_of_the_readme_is_the_one_tested_here() -> None:
    page = (ROOT / "displays/docs/python/README.md").read_text()
    section = page.split("## A display of your own")[1]
    code = section.split("```python\n")[1].split("```")[0]
    assert code == Path(__file__).with_name("polygon.py").read_text()


def test_a_display_of_a_file_is_one_like_any_other(plugin: Plugin) -> None:
    cls = plugin.load()
    assert registry.display_types()["Area"] is cls
    text = "version: 1\ndisplays:\n- type: Area\n  topic: /fence\n  color: [1, 2, 3]\n"
    config = parse(text, "x.yaml")
    assert type(config.displays[0]) is cls
    again: Any = parse(dump(config), "x.yaml").displays[0]
    assert (again.topic.name, again.color) == ("/fence", (1, 2, 3))


def test_every_display_that_the_file_itself_defines_counts(plugin: Plugin) -> None:
    plugin.path.write_text(
        "from __future__ import annotations\n"
        "from webviz_displays.grid import Grid\n"
        f"{IMPORT}\n"
        "class _Base(Display):\n    width: float = 1.0\n\n"
        "class Fence(_Base):\n    height: float = 2.0\n\n"
        "class Zone(_Base):\n    pass\n"
    )
    assert set(load(plugin.path)) == {"Fence", "Zone"}


def test_a_missing_file_is_an_error(tmp_path: Path) -> None:
    path = tmp_path / "none.py"
    assert refusal(path) == f"Cannot read {path}: No such file or directory."
    assert refusal(tmp_path) == f"Cannot read {tmp_path}: Is a directory."


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("x = 1\ndef (:\n", ":2 is not valid Python: invalid syntax."),
        ("x = (\n", ":1 is not valid Python: '(' was never closed."),
        ("x = 1\0\n", " is not valid Python: "),
        ("\n\nimport nowhere_at_all\n", ":3 does not load: ModuleNotFoundError: No module named"),
        ("def f():\n    raise ValueError\nf()\n", ":2 does not load: ValueError."),
        ("import sys\nsys.exit('bye')\n", ":2 does not load: SystemExit: bye."),
        ("raise KeyboardInterrupt\n", ":1 does not load: KeyboardInterrupt."),
        ("class E(BaseException): pass\nraise E('x')\n", ":2 does not load: E: x."),
        ("class E(Exception):\n    __str__ = 3\nraise E\n", ":3 does not load: E."),
        ("raise ValueError('a\\n\\x1b[2Jb')\n", ":1 does not load: ValueError: a ?[2Jb."),
        (f"x = {'-' * 100_000}1\n", " is not valid Python: it is nested too deeply."),
        (f"x = {'1+' * 100_000}1\n", " is not valid Python: it is nested too deeply."),
        (
            "x = 1\n",
            " has no plug-in. Define a subclass of Display, Tool, Panel or Check ",
        ),
        ("from webviz_displays.grid import Grid\n", " has no plug-in. "),
        (
            f"{IMPORT}class Grid(Display): pass\n",
            " cannot be used: an installed package has a display named Grid. Rename the class.",
        ),
        (
            f"from __future__ import annotations\n{IMPORT}class A(Display):\n    b: Nothing = 1\n",
            " does not load: NameError: name 'Nothing' is not defined.",
        ),
        (
            f"{IMPORT}class A(Display):\n    b: Nothing = 1\n",
            ":3 does not load: NameError: name 'Nothing' is not defined.",
        ),
        (
            f"{IMPORT}class A(Display):\n    count: int = 'three'\n",
            " does not load: ValidationError: Expected `int`, got `str` - at `$.count`.",
        ),
    ],
)
def test_a_mistake_is_one_sentence_with_its_line(plugin: Plugin, text: str, reason: str) -> None:
    plugin.path.write_text(text)
    types = registry.display_types()
    assert refusal(plugin.path).startswith(f"{plugin.path}{reason}")
    assert registry.display_types() == types


def test_a_refused_file_leaves_the_module_of_the_last_good_one(plugin: Plugin) -> None:
    cls = plugin.load()
    plugin.edit(("class Area(Display)", "class Grid(Display)"))
    refusal(plugin.path)
    assert sys.modules[cls.__module__].Area is cls


def test_two_files_cannot_have_a_display_of_one_name(plugin: Plugin, tmp_path: Path) -> None:
    plugin.load()
    other = tmp_path / "other.py"
    other.write_text(plugin.path.read_text())
    sentence = refusal(other)
    assert sentence.startswith(f"{other} cannot be used: {plugin.path} has a display named Area")


def test_a_save_is_noticed_once(plugin: Plugin) -> None:
    watcher = Watcher([plugin.path])
    assert watcher.changed() == []
    plugin.edit(("25, 255, 0", "25, 255, 128"))
    assert watcher.changed() == [plugin.path]
    assert watcher.changed() == []


def test_a_save_within_the_grain_of_the_clock_is_noticed_by_its_size(plugin: Plugin) -> None:
    watcher = Watcher([plugin.path])
    time = plugin.path.stat().st_mtime_ns
    plugin.edit(("25, 255, 0", "25, 255, 128"))
    os.utime(plugin.path, ns=(time, time))
    assert watcher.changed() == [plugin.path]


def test_a_save_by_a_new_file_and_a_removal_are_noticed(plugin: Plugin, tmp_path: Path) -> None:
    watcher = Watcher([plugin.path])
    fresh = tmp_path / "fresh"
    fresh.write_text(plugin.path.read_text())
    fresh.replace(plugin.path)
    assert watcher.changed() == [plugin.path]
    plugin.path.unlink()
    assert watcher.changed() == [plugin.path]
    plugin.path.write_text("")
    assert watcher.changed() == [plugin.path]

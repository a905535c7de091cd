"""Features are declared by one line each, and none is needed by the others."""

from __future__ import annotations

import re
import subprocess
import sys
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest
from bench import Benches

import webviz
from webviz.api.roles import Role
from webviz.engine import feature
from webviz.engine.commands import Command, Sender
from webviz.engine.feature import Feature, command, store
from webviz.engine.parts import PartContext
from webviz.engine.parts.declaring import commands_of, stores_of
from webviz.engine.store import PageStore
from webviz.server.access import rules

PACKAGE = Path(webviz.__file__).parent
FOLDERS = sorted(path.parent.name for path in (PACKAGE / "features").glob("*/__init__.py"))
NEEDED_BY = {"recording": ("black_box",)}
"""Features that cannot do without another one."""
START = """
import sys
from pathlib import Path
from webviz import Error, Viewer, commands
from webviz.shell.testing.source import HandFedSource
viewer = Viewer(source=HandFedSource(), port=0)
try:
    print({name: status.text for name, status in viewer.state.statuses.items()})
    for name in sys.argv[1:]:
        try:
            getattr(commands, name)
        except Error as error:
            print(error)
    try:
        viewer.last_findings()
    except Error as error:
        print(error)
    if "UseTool" in sys.argv:
        try:
            viewer.tool("2D Goal Pose").send(0.0, 0.0)
        except Error as error:
            print(error)
finally:
    viewer.close()
"""


class CountStore(PageStore, frozen=True):
    """A number."""

    count: int


class Counting(Feature):
    """Counts."""

    count = 0

    @command(Role.OPERATOR)
    def count_up(self, sender: Sender, by: int = 1) -> str:
        """Count."""
        self.count += by
        return f"{sender.browser}: {self.count}"

    @command(None)
    def start_over(self) -> None:
        """Begin at 0."""

    @store(Role.OWNER, is_private=True)
    def counted(self, argument: str) -> CountStore:
        """Return the number."""
        return CountStore(self.count)


def test_every_folder_is_declared() -> None:
    assert sorted(feature.features()) == FOLDERS
    assert not feature.broken_features()


def test_a_command_follows_from_the_signature_of_a_method() -> None:
    declared = commands_of(Counting)["CountUp"]
    assert issubclass(declared.type, Command)
    assert declared.role is Role.OPERATOR
    assert declared.type.__struct_fields__ == ("by",)
    assert declared.type.__doc__ == "Count."
    counting = object.__new__(Counting)
    obey = counting.handles[declared.type]
    assert obey(declared.type(**{"by": 2}), Sender(7)) == "7: 2"
    assert obey(declared.type(), Sender(7)) == "7: 3"
    assert commands_of(Counting)["StartOver"].role is None


def test_a_store_has_a_role() -> None:
    declared = stores_of(Counting)["counted"]
    assert (declared.role, declared.is_private) == (Role.OWNER, True)


def test_a_command_without_a_role_is_refused_to_everybody(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(feature, "commands", lambda: commands_of(Counting))
    monkeypatch.setattr(feature, "stores", lambda: stores_of(Counting))
    names = {kind.__name__: role for kind, role in rules.commands.__wrapped__().items()}
    assert names["CountUp"] is Role.OPERATOR
    assert "StartOver" not in names
    assert rules.role_to_watch("counted") is Role.OWNER


class Pausing(Feature):
    """Takes the name of a command that there is."""

    @command(Role.WATCHER)
    def pause(self) -> None:
        """Pause."""


class Failing(Feature):
    """Cannot be made."""

    name = "Failing"

    def __init__(self, context: PartContext) -> None:
        raise RuntimeError("no luck")


def entry_points(*names: str) -> list[EntryPoint]:
    """Declare classes of this module as features."""
    return [EntryPoint(name, f"{__name__}:{name}", feature.GROUP) for name in names]


def test_one_that_is_not_sound_leaves_the_others(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, __name__, sys.modules[Counting.__module__])
    points = entry_points("Counting", "Pausing", "Missing")
    monkeypatch.setattr(feature, "installed", lambda group: points)
    feature.loaded.cache_clear()
    try:
        sound, broken = feature.features(), feature.broken_features()
    finally:
        feature.loaded.cache_clear()
    assert sound == {"Counting": Counting}
    assert broken["Pausing"].endswith("does not load: ValueError: Pause exists already")
    assert "AttributeError" in broken["Missing"]


def test_one_that_cannot_be_made_leaves_the_others(
    bench: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    available = {"failing": Failing, **feature.features()}
    monkeypatch.setattr("webviz.engine.loop.loop.features", lambda: available)
    b = bench(strict=False)
    assert sum(isinstance(part, Feature) for part in b.viewer.parts) == len(available) - 1
    assert "no luck" in b.viewer.state().statuses["Failing"].text


@pytest.mark.parametrize("name", FOLDERS)
def test_a_viewer_without_a_feature_starts_and_reports_it(name: str, tmp_path: Path) -> None:
    inner = tmp_path / "webviz"
    inner.mkdir()
    for path in PACKAGE.iterdir():
        if path.name != "features":
            (inner / path.name).symlink_to(path)
    (inner / "features").mkdir()
    for path in (PACKAGE / "features").iterdir():
        if path.name != name:
            (inner / "features" / path.name).symlink_to(path)
    own = list(commands_of(feature.features()[name]))
    completed = subprocess.run(
        [sys.executable, "-c", START, *own],
        cwd=tmp_path,
        env={"PYTHONPATH": str(tmp_path), "PATH": "", "HOME": str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert completed.returncode == 0, completed.stderr
    missing = re.findall(r"(\w+) is missing: webviz\.features\.(?=\1:)", completed.stdout)
    assert sorted(missing) == sorted({name, *NEEDED_BY.get(name, ())})
    lost_features = ", ".join(sorted({name, *NEEDED_BY.get(name, ())}))
    commands = [*own, *(["UseTool"] if "UseTool" in own else [])]
    texts = [f"There is no {each} without {lost_features}. Reinstall webviz." for each in commands]
    assert re.findall(r"^There is no .*", completed.stdout, re.MULTILINE) == texts
    assert ("This viewer has no Doctor. Reinstall webviz." in completed.stdout) == (
        name == "doctor"
    )

"""Types of a workspace that is not built, from its .msg files."""

from __future__ import annotations

import itertools
from pathlib import Path

import pytest

from webviz.data.messages import DefinitionError, UnknownTypeError, decode, encode, type_exists

numbers = itertools.count()


@pytest.fixture
def package() -> str:
    """A name that no other test has taught."""
    return f"unbuilt_{next(numbers)}_msgs"


def write(folder: Path, **texts: str) -> None:
    """Write a package with .msg files."""
    (folder / "msg").mkdir(parents=True)
    (folder / "package.xml").write_text(f"<package><name>{folder.name}</name></package>")
    for name, text in texts.items():
        (folder / "msg" / f"{name}.msg").write_text(text)


@pytest.mark.parametrize("place", ["", "src", "src/repository", "src/repository/part"])
def test_a_type_is_read_from_the_workspace_that_one_is_in(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, package: str, place: str
) -> None:
    write(tmp_path / place / package, Wheel="float64 speed\n", Cart="Wheel[] wheels\nbool on\n")
    monkeypatch.chdir(tmp_path)
    name = f"{package}/msg/Cart"
    cart = decode(name, encode(name, {"wheels": [{"speed": 2.5}], "on": True}))
    assert (cart.wheels[0].speed, cart.on) == (2.5, True)


def test_a_type_is_read_from_the_current_package_and_built_workspaces(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, package: str
) -> None:
    write(tmp_path / "ws/src" / package, Cart=f"{package}_other/Wheel wheel\n")
    write(tmp_path / "ws/src" / f"{package}_other", Wheel="float64 speed\n")
    monkeypatch.chdir(tmp_path / "ws/src" / package)
    with pytest.raises(DefinitionError, match=f"{package}_other/msg/Wheel"):
        encode(f"{package}/msg/Cart", {})
    monkeypatch.setenv("COLCON_PREFIX_PATH", str(tmp_path / "ws/install"))
    assert encode(f"{package}/msg/Cart", {})


def test_a_folder_without_package_xml_is_ignored(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, package: str
) -> None:
    write(tmp_path / package, Wheel="float64 speed\n", Bad="float64\n")
    monkeypatch.chdir(tmp_path)
    with pytest.raises(DefinitionError, match="Bad is not valid"):
        encode(f"{package}/msg/Bad", {})
    (tmp_path / package / "package.xml").unlink()
    with pytest.raises(UnknownTypeError):
        encode(f"{package}/msg/Wheel", {})
    assert not type_exists(f"{package}/msg/Wheel")

"""URIs to files, with packages of our own making."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from webviz_urdf import ResolveError, Resolver


def package(folder: Path, name: str, file: str = "meshes/a.stl") -> Path:
    (folder / file).parent.mkdir(parents=True, exist_ok=True)
    (folder / file).write_text(name)
    (folder / "package.xml").write_text(f"<package><name>{name}</name></package>")
    return folder


def test_a_package_on_the_ament_prefix_path_is_found(tmp_path: Path) -> None:
    for prefix in ("one", "two"):
        package(tmp_path / prefix / "share" / f"pkg_{prefix}", f"pkg_{prefix}")
    resolver = Resolver(ament_prefix_path=f"{tmp_path / 'one'}:{tmp_path / 'two'}")
    result = resolver.resolve("package://pkg_two/meshes/a.stl")
    assert result == tmp_path / "two/share/pkg_two/meshes/a.stl"


def test_the_environment_gives_the_prefix_path_by_default(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    package(tmp_path / "share/pkg", "pkg")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    assert Resolver().resolve("package://pkg/meshes/a.stl").is_file()


def test_a_package_below_a_given_root_is_found_by_its_package_xml(tmp_path: Path) -> None:
    folder = package(tmp_path / "src/repository/some_folder", "pkg")
    resolver = Resolver([tmp_path], ament_prefix_path="")
    assert resolver.resolve("package://pkg/meshes/a.stl") == folder / "meshes/a.stl"


def test_a_given_root_wins_over_the_installed_package(tmp_path: Path) -> None:
    package(tmp_path / "prefix/share/pkg", "installed")
    package(tmp_path / "src/pkg", "pkg")
    resolver = Resolver([tmp_path / "src"], ament_prefix_path=str(tmp_path / "prefix"))
    assert resolver.resolve("package://pkg/meshes/a.stl").read_text() == "pkg"


def test_a_file_that_one_copy_of_a_package_lacks_is_taken_from_the_next(tmp_path: Path) -> None:
    package(tmp_path / "src/pkg", "pkg")
    package(tmp_path / "prefix/share/pkg", "pkg", file="meshes/b.stl")
    resolver = Resolver([tmp_path / "src"], ament_prefix_path=str(tmp_path / "prefix"))
    assert resolver.resolve("package://pkg/meshes/b.stl").is_file()


@pytest.mark.parametrize("root", ["pkg", "."])
def test_a_folder_named_like_the_package_serves_without_a_package_xml(
    tmp_path: Path, root: str
) -> None:
    package(tmp_path / "pkg", "pkg")
    (tmp_path / "pkg/package.xml").unlink()
    resolver = Resolver([tmp_path / root], ament_prefix_path="")
    assert resolver.resolve("package://pkg/meshes/a.stl").is_file()


def test_build_folders_are_not_searched(tmp_path: Path) -> None:
    package(tmp_path / "build/pkg", "pkg")
    with pytest.raises(ResolveError, match="'pkg' is neither"):
        Resolver([tmp_path], ament_prefix_path="").resolve("package://pkg/meshes/a.stl")


def test_a_description_in_a_file_finds_its_own_and_neighbouring_packages(tmp_path: Path) -> None:
    package(tmp_path / "src/robot", "robot_pkg")
    package(tmp_path / "src/hand", "hand")
    resolver = Resolver(ament_prefix_path="").relative_to(tmp_path / "src/robot/urdf")
    assert resolver.resolve("package://robot_pkg/meshes/a.stl").is_file()
    assert resolver.resolve("package://hand/meshes/a.stl").is_file()


def test_a_third_slash_before_the_package_is_forgiven(tmp_path: Path) -> None:
    package(tmp_path / "pkg", "pkg")
    resolver = Resolver([tmp_path], ament_prefix_path="")
    assert resolver.resolve("package:///pkg/meshes/a.stl").is_file()


@pytest.mark.parametrize(
    "path", ["../secret", "meshes/../../secret", "/secret", "%2e%2e/secret", "../pkg_two/meshes"]
)
def test_a_package_path_may_not_leave_its_package(tmp_path: Path, path: str) -> None:
    package(tmp_path / "pkg", "pkg")
    (tmp_path / "secret").write_text("secret")
    with pytest.raises(ResolveError, match="leaves its package"):
        Resolver([tmp_path], ament_prefix_path="").resolve(f"package://pkg/{path}")


@pytest.mark.parametrize("uri", ["package://../secret", "package://./secret", "package://.."])
def test_dots_are_not_a_package(tmp_path: Path, uri: str) -> None:
    (tmp_path / "share").mkdir()
    (tmp_path / "secret").write_text("secret")
    with pytest.raises(ResolveError, match="neither on AMENT_PREFIX_PATH"):
        Resolver([tmp_path / "share"], ament_prefix_path=str(tmp_path)).resolve(uri)


def test_symbolic_links_of_a_symlink_install_are_followed(tmp_path: Path) -> None:
    source = package(tmp_path / "src/pkg", "pkg")
    share = tmp_path / "install/share"
    share.mkdir(parents=True)
    (share / "pkg").mkdir()
    (share / "pkg/meshes").symlink_to(source / "meshes")
    resolver = Resolver(ament_prefix_path=str(tmp_path / "install"))
    assert resolver.resolve("package://pkg/meshes/a.stl").is_file()


@pytest.mark.parametrize("name", ["{}/secret", "file://{}/secret", "file://{}/pkg/../secret"])
def test_a_file_outside_of_the_roots_is_refused_with_the_remedy(tmp_path: Path, name: str) -> None:
    package(tmp_path / "pkg", "pkg")
    (tmp_path / "secret").write_text("secret")
    resolver = Resolver([tmp_path / "pkg"], ament_prefix_path="")
    with pytest.raises(ResolveError, match=f"--mesh-root {tmp_path} to allow it") as excinfo:
        resolver.resolve(name.format(tmp_path))
    (tmp_path / "secret").unlink()
    with pytest.raises(ResolveError) as again:
        resolver.resolve(name.format(tmp_path))
    assert str(excinfo.value) == str(again.value)  # whether it exists is not said


@pytest.mark.parametrize("name", ["package://pkg/link", "{}/pkg/link", "{}/pkg/folder/secret"])
def test_a_symbolic_link_out_of_a_package_is_refused(tmp_path: Path, name: str) -> None:
    package(tmp_path / "pkg", "pkg")
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere/secret").write_text("secret")
    (tmp_path / "pkg/link").symlink_to(tmp_path / "elsewhere/secret")
    (tmp_path / "pkg/folder").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(ResolveError, match=r"a link to .*/secret, is outside"):
        Resolver([tmp_path / "pkg"], ament_prefix_path="").resolve(name.format(tmp_path))


def test_files_of_a_known_package_are_opened_and_those_of_a_strange_one_are_not(
    tmp_path: Path,
) -> None:
    package(tmp_path / "src/pkg", "pkg")
    package(tmp_path / "src/strange", "strange")
    package(tmp_path / "prefix/share/pkg", "pkg")
    resolver = Resolver(ament_prefix_path=str(tmp_path / "prefix"))
    assert resolver.resolve(f"file://{tmp_path}/src/pkg/meshes/a.stl").is_file()
    with pytest.raises(ResolveError, match="is outside"):
        resolver.resolve(f"file://{tmp_path}/src/strange/meshes/a.stl")


def test_a_package_path_leads_to_packages_and_to_nothing_else(tmp_path: Path) -> None:
    package(tmp_path / "src/pkg", "pkg")
    (tmp_path / "src/private").mkdir()
    (tmp_path / "src/private/a.stl").touch()
    resolver = Resolver([], ament_prefix_path="", package_paths=[tmp_path / "src"])
    assert resolver.resolve("package://pkg/meshes/a.stl").is_file()
    with pytest.raises(ResolveError, match="'private' is neither"):
        resolver.resolve("package://private/a.stl")
    with pytest.raises(ResolveError, match="is outside"):
        resolver.resolve(str(tmp_path / "src/private/a.stl"))


def test_the_environment_gives_the_mesh_roots_by_default(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "a.stl").touch()
    monkeypatch.setenv("WEBVIZ_MESH_ROOT", f"/nowhere:{tmp_path}")
    assert Resolver().resolve(str(tmp_path / "a.stl")).is_file()


def test_a_fifo_is_neither_a_mesh_nor_the_description_of_a_package(tmp_path: Path) -> None:
    package(tmp_path / "pkg", "pkg")
    os.mkfifo(tmp_path / "pkg/meshes/pipe.stl")
    (tmp_path / "odd").mkdir()
    os.mkfifo(tmp_path / "odd/package.xml")
    with pytest.raises(ResolveError, match="does not exist"):
        Resolver([tmp_path], ament_prefix_path="").resolve("package://pkg/meshes/pipe.stl")


def test_file_uris_and_absolute_paths_name_files_of_mesh_roots(tmp_path: Path) -> None:
    file = tmp_path / "with space.stl"
    file.touch()
    resolver = Resolver([tmp_path], ament_prefix_path="")
    assert resolver.resolve(str(file)) == file
    assert resolver.resolve(f"file://{file}") == file
    assert resolver.resolve(file.as_uri()) == file  # %20
    assert resolver.resolve(f"file://localhost{file}") == file


def test_relative_paths_begin_at_the_description_or_nowhere(tmp_path: Path) -> None:
    (tmp_path / "a.stl").touch()
    (tmp_path / "urdf").mkdir()
    resolver = Resolver([tmp_path], ament_prefix_path="")
    assert resolver.relative_to(tmp_path / "urdf").resolve("../a.stl").is_file()
    with pytest.raises(ResolveError, match="from a topic"):
        resolver.resolve("a.stl")


@pytest.mark.parametrize(
    ("uri", "words"),
    [
        ("http://127.0.0.1:9/a.stl", "is on a network"),
        ("https://example.org/a.stl", "is on a network"),
        ("model://a/b.dae", "'model://a/b.dae' is unsupported"),
        ("", "empty"),
        ("package://nowhere/a.stl", "'nowhere' is neither on AMENT_PREFIX_PATH"),
        ("/nowhere/a.stl", "is outside all ROS packages and mesh roots. Start webviz with"),
        ("/", "is outside"),
        ("/" + "x" * 5000, "not a usable path"),
        ("file://[/a", "not a usable path"),
    ],
)
def test_a_missing_file_is_refused_in_one_sentence(uri: str, words: str) -> None:
    with pytest.raises(ResolveError) as excinfo:
        Resolver(ament_prefix_path="").resolve(uri)
    assert words in str(excinfo.value)
    assert "\n" not in str(excinfo.value)

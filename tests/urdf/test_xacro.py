"""Xacro files run Python: only where that is allowed, with little time, memory and rights."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from webviz_urdf import RobotDescriptionError, load_file
from webviz_urdf import expand as expanding

ROBOT = '<robot name="r"><link name="l"/></robot>'


@pytest.fixture
def path(tmp_path: Path) -> Path:
    path = tmp_path / "r.urdf.xacro"
    path.write_text(
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        '<xacro:property name="n" value="expanded"/><link name="${n}"/></robot>'
    )
    return path


@pytest.fixture
def running(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[str], None]:
    """Take a program for the package xacro, which is what a xacro file may run."""
    monkeypatch.setenv(expanding.ALLOWED_BY, "1")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))

    def run(body: str) -> None:
        program = "import os\nclass Text(str):\n    def toxml(self): return self\n"
        lines = "".join(f"    {line}\n" for line in body.splitlines())
        (tmp_path / "xacro.py").write_text(f"{program}def process_file(path):\n{lines}")

    return run


def test_a_xacro_file_is_refused_unless_it_is_allowed(
    path: Path, running: Callable[[str], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    running("open(path + '.ran', 'w'); return Text()")
    monkeypatch.delenv(expanding.ALLOWED_BY)
    with pytest.raises(RobotDescriptionError, match=r"start webviz with WEBVIZ_XACRO=1"):
        load_file(path)
    assert not path.with_name(f"{path.name}.ran").exists()


def test_an_allowed_xacro_file_is_expanded(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("xacro", reason="needs xacro: pip install xacro")
    monkeypatch.setenv(expanding.ALLOWED_BY, "1")
    assert load_file(path).root == "expanded"


def test_without_xacro_there_is_a_remedy(path: Path, running: Callable[[str], None]) -> None:
    running("")
    (path.parent / "xacro.py").write_text("raise ImportError\n")
    with pytest.raises(RobotDescriptionError, match="pip install xacro"):
        load_file(path)


def test_a_xacro_file_sees_no_token_and_writes_no_file(
    path: Path, running: Callable[[str], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("WEBVIZ_TOKEN_OWN", "a secret")
    marker_file = path.with_name("written")
    running(
        f"file = os.open({str(marker_file)!r}, os.O_WRONLY | os.O_CREAT)\n"
        "try:\n    os.write(file, b'x')\nexcept OSError as error:\n"
        f"    return Text({ROBOT!r} if 'a secret' not in str(os.environ) else '')\n"
    )
    assert load_file(path).root == "l"
    assert not marker_file.stat().st_size


@pytest.mark.parametrize(
    ("body", "reason"),
    [
        ("while True: pass", "takes longer than 1 s"),
        ("import time; time.sleep(99)", "takes longer than 1 s"),
        ("print('x' * 3_000_000)\nreturn Text()", "expands to more than 1 MB"),
        ("return Text('x' * (2 << 30))", "cannot expand"),
        ("os._exit(7)", "ended with status 7"),
        ("raise ValueError('odd\\nvalue.')", "cannot expand .*: odd value.$"),
    ],
)
def test_a_xacro_file_is_bounded(
    path: Path,
    running: Callable[[str], None],
    monkeypatch: pytest.MonkeyPatch,
    body: str,
    reason: str,
) -> None:
    late = "longer" in reason
    monkeypatch.setattr(expanding, "TIME_S", 1 if late else 20)
    monkeypatch.setattr(expanding, "MAX_BYTES", 1 << 20)
    running(body)
    with pytest.raises(RobotDescriptionError, match=reason) as excinfo:
        load_file(path)
    assert "\n" not in str(excinfo.value)


@pytest.mark.parametrize("name", ["/proc/kmsg", "/proc/self/mem", "/dev/zero", "/proc/version"])
def test_files_of_the_kernel_are_not_descriptions(name: str) -> None:
    if not Path(name).exists():
        pytest.skip(f"{name} is missing")
    with pytest.raises(RobotDescriptionError, match="cannot be read: "):
        load_file(name)


def test_a_path_with_a_null_byte_is_refused_by_a_sentence() -> None:
    with pytest.raises(RobotDescriptionError, match=r"is not a usable path: .*embedded null"):
        load_file("/tmp/a\0b.urdf")

"""Files that a user may be given: descriptions of robots, meshes, configs and bags."""

from __future__ import annotations

import functools
import json
import re
import subprocess
import tempfile
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from random import Random
from typing import Any

import trimesh
from bags import strings
from PIL import Image
from rosbags.rosbag2 import StoragePlugin
from trimesh.exchange.dae import export_collada

from tests.attack.attack import Attack, Case, Outcome, Violation, mutated, piped

READ_S = 60.0
"""Time in seconds for one small file, on a busy machine."""
URDF = """\
<robot name="r"><material name="m"><color rgba="1 0 0 .5"/></material>
<link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>
</inertial><visual><origin xyz="1 2 3" rpy=".1 .2 .3"/><geometry><box size="1 2 3"/></geometry>
<material name="m"/></visual><collision><geometry><sphere radius="1"/></geometry></collision></link>
<link name="b"><visual><geometry><cylinder radius="1" length="2"/></geometry></visual></link>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/><mimic joint="j" multiplier="2"/></joint>
</robot>
"""
YAML = """\
version: 1
fixed_frame: map
view: {distance: 14, pitch: 1.0, focal_point: [4, 3, 0]}
displays:
- type: Group
  name: Front
  displays:
  - {type: LaserScan, topic: {name: /scan, reliability: best_effort}, size: 0.05}
- {type: Grid, color: [1, 2, 3], offset: [0, 0, 1e3]}
"""
RVIZ = """\
Panels:
  - Class: rviz_common/Displays
Visualization Manager:
  Displays:
    - {Class: rviz_default_plugins/Grid, Name: Grid, Cell Size: 1, Color: 160; 160; 164}
    - Class: rviz_default_plugins/LaserScan
      Topic: {Value: /scan, Depth: 5, Reliability Policy: Best Effort}
  Global Options: {Fixed Frame: map, Background Color: 48; 48; 48}
  Views: {Current: {Class: rviz_default_plugins/Orbit, Distance: 10}}
"""


@functools.cache
def corpus() -> dict[str, bytes]:
    """A good file of each kind, by name."""
    result = {"robot.urdf": URDF.encode(), "a.yaml": YAML.encode(), "a.rviz": RVIZ.encode()}
    box = trimesh.creation.box((1, 2, 3))
    for suffix in ("stl", "ply", "obj", "glb"):
        data = box.export(file_type=suffix)
        result[f"box.{suffix}"] = data if isinstance(data, bytes) else str(data).encode()
    result["box.dae"] = _timeless(export_collada(box))
    with tempfile.TemporaryDirectory() as folder:
        picture = Path(folder) / "a.png"
        Image.new("RGB", (4, 4)).save(picture)
        result["texture.png"] = picture.read_bytes()
        for storage in (StoragePlugin.MCAP, StoragePlugin.SQLITE3):
            bag = strings(0, 1, 2).write(Path(folder) / storage.name, storage)
            (file,) = (each for each in bag.iterdir() if each.suffix != ".yaml")
            result[f"bag{file.suffix}"] = file.read_bytes()
    return result


def _timeless(collada: bytes) -> bytes:
    """A file without time and random names, so that a seed gives the same attack again."""
    names = dict.fromkeys(re.findall(rb"[0-9a-f]{32}", collada))
    for number, name in enumerate(names):
        collada = collada.replace(name, b"name%d" % number)
    return re.sub(rb"<(created|modified)>[^<]*", rb"<\1>", collada)


class FileReader:
    """A process that reads files, one after another, and is started again if it ends.

    Args:
        module: of this package; it takes names, and answers in JSON.
    """

    def __init__(self, module: str) -> None:
        self._module = module
        self._process: subprocess.Popen[str] | None = None

    def start(self) -> subprocess.Popen[str]:
        """Start the process, if it does not run."""
        self._process = self._process or piped(self._module)
        return self._process

    def read(self, path: Path) -> Mapping[str, Any]:
        """Have a file read.

        Raises:
            Violation: that takes too long, or ends the process.
        """
        process = self.start()
        assert process.stdin is not None
        assert process.stdout is not None
        timer = threading.Timer(READ_S, process.kill)
        timer.start()
        try:
            process.stdin.write(f"{path}\n")
            process.stdin.flush()
            line = process.stdout.readline()
        except BrokenPipeError:
            line = ""
        finally:
            is_late = not timer.is_alive()
            timer.cancel()
        if not line:
            self.close()
            how = f"takes longer than {READ_S:g} s" if is_late else "ends the process"
            raise Violation(f"reading {path.name} {how}")
        return json.loads(line)

    def close(self) -> None:
        """End the process."""
        if self._process is not None:
            self._process.kill()
            self._process.communicate()
        self._process = None


@functools.cache
def reader_of(module: str) -> FileReader:
    """Return the reader that all attacks with a module share: each takes a second to start."""
    return FileReader(module)


class FileAttack(Attack):
    """Reads files in a process of its own, as the viewer reads them.

    Args:
        kind: of the attack.
        draw: makes the case of a source; the name of its file says how it is read.
        folder: for the files.
        reader: module of the process that reads them.
    """

    def __init__(
        self, kind: str, draw: Callable[[Random], Case], folder: Path, reader: str = "reader"
    ) -> None:
        self.kind = kind
        self._draw = draw
        self._folder = folder
        self._reader = reader_of(reader)

    def start(self) -> None:
        self._reader.start()

    def draw(self, random: Random) -> Case:
        return self._draw(random)

    def strike(self, case: Case) -> Outcome:
        path = self._folder / case.name
        path.write_bytes(case.data)
        result = self._reader.read(path)
        if result["broken"]:
            raise Violation(result["broken"])
        return Outcome.REFUSED if result["refused"] else Outcome.SURVIVED

    def close(self) -> None:
        self._reader.close()


def draw(random: Random) -> Case:
    """Change one of the good files."""
    good = corpus()
    name = random.choice(sorted(good))
    data = good[name]
    if name.endswith((".urdf", ".yaml", ".rviz", ".dae", ".obj")) and random.random() < 0.5:
        return Case(name, _with_odd_words(random, data.decode()))
    return Case(name, mutated(random, data))


ODD = (
    "",
    "nan",
    "-inf",
    "1e308",
    "-1",
    "0",
    "99999999999999999999",
    "&x;",
    "a b c",
    "\x7f",
    "*a",
    "[[",
)


def _with_odd_words(random: Random, text: str) -> bytes:
    """A text of which some words are others."""
    words = text.split(" ")
    for _ in range(random.randint(1, 4)):
        index = random.randrange(len(words))
        start, quote, rest = words[index].partition('"')
        words[index] = f"{start}{quote}{random.choice(ODD)}{quote if rest else ''}"
    return " ".join(words).encode()

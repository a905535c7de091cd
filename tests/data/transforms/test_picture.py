"""The tree of frames as a picture."""

from __future__ import annotations

import re
from itertools import pairwise
from pathlib import Path
from xml.etree import ElementTree

import pytest
from bags import Bag
from hypothesis import given
from hypothesis import strategies as st

from tests.data.transforms.conftest import HandFedBuffer
from webviz.data.transforms import TransformBuffer, diagnose
from webviz.data.transforms.layout import lay_out
from webviz.data.transforms.picture import MAX_PROBLEMS, draw_tree
from webviz.shell.cli import main

S = 1_000_000_000
SVG = "{http://www.w3.org/2000/svg}"
NAMES = st.sampled_from([f"f{n}" for n in range(8)])


def faulty(buffer: TransformBuffer, now_s: float = 0.0) -> set[str]:
    """The names in red boxes."""
    root = ElementTree.fromstring(draw_tree(diagnose(buffer, round(now_s * S)), "Frames").svg)
    return {
        text.text or ""
        for group in root.iter(f"{SVG}g")
        if "fault" in group.get("class", "")
        for text in group.iter(f"{SVG}text")
        if text.get("class") == "name"
    }


def red_edges(buffer: TransformBuffer) -> int:
    """The number of red edges."""
    root = ElementTree.fromstring(draw_tree(diagnose(buffer), "Frames").svg)
    groups = [group for group in root.iter(f"{SVG}g") if "fault" in group.get("class", "")]
    return sum(len(group.findall(f"{SVG}path")) for group in groups)


@given(st.lists(st.tuples(NAMES, NAMES), max_size=12))
def test_every_frame_has_a_place_of_its_own(links: list[tuple[str, str]]) -> None:
    buffer = TransformBuffer()
    for parent, child in links:
        buffer.set_transform(parent, child, S, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    diagnosis = diagnose(buffer)
    layout = lay_out(diagnosis)
    assert {*layout.places} == {*diagnosis.names}
    columns: dict[int, list[float]] = {}
    for place in layout.places.values():
        columns.setdefault(place.column, []).append(place.row)
    for rows in columns.values():
        assert all(above + 1 <= below for above, below in pairwise(sorted(rows)))
        assert 0 <= min(rows) <= max(rows) <= layout.rows - 1
    below = {edge.child for edge in layout.edges if not edge.is_extra}
    assert {frame for frame, place in layout.places.items() if place.column} == below
    for edge in layout.edges:
        parent, child = layout.places[edge.parent], layout.places[edge.child]
        assert edge.is_extra or child.column == parent.column + 1
    picture = draw_tree(diagnosis, "Frames")
    root = ElementTree.fromstring(picture.svg)
    for text in root.iter(f"{SVG}text"):
        assert 0.0 < float(text.get("x", 0)) < picture.width
        assert 0.0 < float(text.get("y", 0)) < picture.height
    assert len([*root.iter(f"{SVG}path")]) == len(layout.edges) >= len(diagnosis.frames)


def test_edges_lead_from_the_right_of_a_parent_to_the_left_of_its_child(
    buffer: HandFedBuffer,
) -> None:
    buffer.put("map", "base", is_static=True)
    for child in ("arm", "laser", "camera"):
        buffer.put("base", child, is_static=True)
    root = ElementTree.fromstring(draw_tree(diagnose(buffer), "Frames").svg)
    boxes = [each.attrib for each in root.iter(f"{SVG}rect") if "x" in each.attrib]
    sides = [(float(box["x"]), float(box["y"]) + float(box["height"]) / 2) for box in boxes]
    rights = {(x + float(box["width"]), y) for (x, y), box in zip(sides, boxes, strict=True)}
    for path in root.iter(f"{SVG}path"):
        numbers = [float(number) for number in re.findall(r"[-\d.]+", path.attrib["d"])]
        assert (*numbers[:2],) in rights
        assert (*numbers[-2:],) in sides


def test_a_tree_without_faults_has_nothing_red(buffer: HandFedBuffer) -> None:
    for number in range(20):
        buffer.put("map", "odom", 1.0 + number / 20)
    buffer.put("odom", "base", is_static=True)
    assert not faulty(buffer, 2.0)
    assert "no faults" in draw_tree(diagnose(buffer), "Frames").svg
    assert faulty(buffer, 30.0) == {"odom"}, "it has stopped"


def test_faults_are_red(buffer: HandFedBuffer) -> None:
    for parent, child in (("a", "b"), ("b", "a")):
        buffer.put(parent, child)
    assert red_edges(buffer) == 1, "the one that closes the loop"
    buffer.put("world", "drone")
    buffer.put("map", "odom")
    assert faulty(buffer) == {"world", "map"}, "roots that nothing connects"


def test_problems_are_lines_below_the_boxes_and_counted_beyond_a_limit(
    buffer: HandFedBuffer,
) -> None:
    for number in range(MAX_PROBLEMS + 2):  # frames that stopped long ago
        for tenth in range(10):
            buffer.put("map", f"arm{number}", 1.0 + tenth / 10)
    diagnosis = diagnose(buffer, 30 * S)
    picture = draw_tree(diagnosis, "Frames", ["A note."])
    root = ElementTree.fromstring(picture.svg)
    lowest = max(float(each.attrib["y"]) for each in root.iter(f"{SVG}rect") if "y" in each.attrib)
    lines = {text.text: float(text.attrib["y"]) for text in root.findall(f"{SVG}text")}
    texts = [*diagnosis.problems[:MAX_PROBLEMS], "And 2 more.", "A note."]
    assert list(lines)[2:] == texts
    heights = [lowest, *(lines[text] for text in texts), picture.height]
    assert all(above < below for above, below in pairwise(heights))


def test_a_second_parent_has_a_red_edge(buffer: HandFedBuffer) -> None:
    buffer.put("world", "map", is_static=True)
    buffer.put("world", "odom", is_static=True)
    for number in range(6):
        buffer.put("map" if number % 2 else "odom", "base", 1.0 + number / 10, float(number))
    assert faulty(buffer, 1.5) == {"base"}
    assert red_edges(buffer) == 2


@pytest.mark.parametrize(
    "name",
    [
        "</text><script>alert(1)</script>",
        '"><svg onload="alert(1)">',
        "&lt;",
        "\x00\x1b[31m\ud800\n",
    ],
)
def test_names_are_never_markup(buffer: HandFedBuffer, name: str) -> None:
    buffer.put("map", name, is_static=True)
    root = ElementTree.fromstring(draw_tree(diagnose(buffer), name).svg.encode())
    assert {each.tag.removeprefix(SVG) for each in root.iter()} == {
        *("svg", "style", "rect", "text", "title", "g", "path")
    }
    assert not any(key.startswith("on") for each in root.iter() for key in each.keys())  # noqa: SIM118


def test_long_names_keep_their_ends(buffer: HandFedBuffer) -> None:
    buffer.put("map", f"begin_{'x' * 100_000}_end", is_static=True)
    picture = draw_tree(diagnose(buffer), "Frames")
    assert picture.width < 1000
    assert "begin_xxx" in picture.svg
    assert "_end</text>" in picture.svg


def test_a_bag_is_drawn_at_a_time(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bag = Bag()
    bag.transform(0.0, "base", "laser", static=True)
    for number in range(600):
        if number < 100:
            bag.transform(number / 10, "map", "odom")
        bag.transform(number / 10, "odom", "base")
    run, output = bag.write(tmp_path / "run"), tmp_path / "frames.svg"
    arguments = ["frames", "--bag", str(run)]
    assert main([*arguments, "--at", "5", "-o", str(output)]) == 0
    texts = [each.text for each in ElementTree.parse(output).iter(f"{SVG}text")]
    assert "Frames of run at 5.0 s" in texts
    assert [t for t in texts if t and t.startswith("10.0 Hz, ") and t.endswith(" ms old")]
    assert {"map", "odom", "base", "laser", "static"} <= {*texts}
    capsys.readouterr()
    assert main(arguments) == 3
    tree = capsys.readouterr().out
    assert tree.startswith("map\n└─ odom  [10.0 Hz, 50 s old, from /tf]  !\n")
    assert '"odom" has stopped' in tree


def test_mistakes_are_one_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["frames", "-o", str(tmp_path / "frames.pdf")]) == 2
    assert "Use .svg or .png." in capsys.readouterr().err
    assert main(["frames", "--at", "3"]) == 2
    assert "Add --bag." in capsys.readouterr().err


def test_damage_of_a_bag_is_reported(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bag = Bag()
    for number in range(100):
        bag.transform(number / 10, "odom", "base")
    (file,) = bag.write(tmp_path / "run").glob("*.mcap")
    whole = file.read_bytes()
    file.write_bytes(whole[: len(whole) // 2])
    main(["frames", "--bag", str(file)])
    output = capsys.readouterr()
    assert output.out.startswith("odom\n└─ base")
    assert str(file) in output.err

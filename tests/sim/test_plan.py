"""Worlds from SVG plans."""

import time
from pathlib import Path

import numpy as np
import pytest

from webviz_sim.planner import Planner
from webviz_sim.pose import Pose2D
from webviz_sim.world import WorldError, load_world

# 4 m x 2 m in millimetres: 80 x 40 cells.
SIZE = 'width="4m" viewBox="0 0 4000 2000"'


@pytest.fixture
def load(tmp_path):
    """Load a plan of some shapes."""

    def make(shapes, size=SIZE, before=""):
        path = tmp_path / "plan.svg"
        path.write_text(f'{before}<svg xmlns="http://www.w3.org/2000/svg" {size}>{shapes}</svg>')
        return load_world(path)

    return make


def occupied(world):
    """Ranges (left, bottom, right, top) in metres of all that is occupied."""
    rows, columns = np.nonzero(world.occupied)
    edges = [columns.min(), rows.min(), columns.max() + 1, rows.max() + 1]
    return pytest.approx([edge * world.resolution for edge in edges], abs=0.06)


@pytest.mark.parametrize(
    "shape",
    [
        '<line x1="1000" y1="500" x2="2000" y2="500" stroke="black" stroke-width="200"/>',
        '<rect x="1000" y="400" width="1000" height="200"/>',
        '<polyline style="fill:none; stroke:#222; stroke-width:200" points="1000,500 2000,500"/>',
        '<polygon points="1000 400, 2000 400, 2000 600, 1000 600"/>',
        '<path d="M 1000 400 h 1000 v 200 h -1000 z"/>',
        '<path style="fill:none;stroke:black;stroke-width:200px" d="M 1000,500 L 2000,500"/>',
        '<path d="M 1000 400 C 1300 400 1700 400 2000 400 L 2000 600 1000 600"/>',
        '<ellipse cx="1500" cy="500" rx="500" ry="100"/>',
        '<g transform="translate(1000 400) scale(10)"><rect width="100" height="20"/></g>',
        '<g transform="rotate(90, 1500, 500)"><rect x="1400" y="0" width="200" height="1000"/></g>',
        '<g stroke="black" stroke-width="0.2" transform="matrix(1000 0 0 1000 0 0)">'
        '<line x1="1" y1="0.5" x2="2" y2="0.5"/></g>',
    ],
)
def test_a_wall_is_where_its_shape_is_and_y_points_up(load, shape):
    world = load(shape)
    assert world.cells.shape == (40, 80)
    assert occupied(world) == [1.0, 1.4, 2.0, 1.6]
    assert world.cells[0, 0] == 0
    assert world.origin == Pose2D()


@pytest.mark.parametrize(
    "size",
    [
        'width="400cm" height="200cm" viewBox="0 0 4000 2000"',
        'height="2000mm" viewBox="-10 -10 4000 2000"',
        'width="4 m" viewBox="0,0,40,20"',
    ],
)
def test_width_or_height_and_viewbox_give_the_scale(load, size):
    assert load('<rect width="1" height="1"/>', size).cells.shape == (40, 80)


def test_later_shapes_cover_earlier_ones_and_grey_is_unknown(load):
    world = load(
        '<rect width="2000" height="2000"/><rect width="1000" height="2000" fill="white"/>'
        '<rect x="3000" width="1000" height="2000" fill="#909090"/>'
    )
    assert [world.cells[20, column] for column in (10, 30, 50, 70)] == [0, 100, 0, -1]


def test_holes_follow_the_rule_of_the_fill(load):
    inner = {"same": "M500 500 h1000 v1000 h-1000 z", "against": "M500 500 v1000 h1000 v-1000 z"}
    outer = "M0 0 h2000 v2000 h-2000 z"
    middle = {
        (name, rule): load(f'<path fill-rule="{rule}" d="{outer} {path}"/>').cells[20, 20]
        for name, path in inner.items()
        for rule in ("nonzero", "evenodd")
    }
    assert middle == {
        ("same", "nonzero"): 100,
        ("same", "evenodd"): 0,
        ("against", "nonzero"): 0,
        ("against", "evenodd"): 0,
    }


def test_thin_strokes_stop_a_robot_and_what_is_not_painted_does_not(load):
    world = load(
        '<line x1="2000" y1="0" x2="2000" y2="2000" stroke="black" stroke-width="1"/>'
        '<g display="none"><rect width="1000" height="1000"/></g><text>kitchen</text>'
        '<rect width="900" height="900" visibility="hidden"/><defs><rect width="900"/></defs>'
        '<rect width="900" height="900" fill="none"/><rect width="9" height="9" opacity="0"/>'
    )
    assert occupied(world) == [2.0, 0.0, 2.05, 2.0]
    assert Planner(world).plan(Pose2D(1.0, 1.0), Pose2D(3.0, 1.0)) is None


@pytest.mark.parametrize(
    ("shapes", "message"),
    [
        ('<use href="#a"/>', "<use> in line 1 is unsupported"),
        ("<style>rect {fill: red}</style>", "<style> in line 1 is unsupported"),
        ('<rect fill="url(#a)"/>', r"unsupported colour url\(#a\)"),
        ('<rect width="2em"/>', "expected a number, not '2em'"),
        ('<rect width="nan"/>', "expected a number, not 'nan'"),
        ('<rect x="1e308" width="1e308" height="9"/>', "far outside of the viewBox"),
        ('<rect transform="scale(1e200) scale(1e200)" width="1"/>', "far outside of the viewBox"),
        ('<rect transform="scale(inf)"/>', r"invalid transform scale\(inf\)"),
        ('<rect transform="turn(4)"/>', r"invalid transform turn\(4\)"),
        ('<rect stroke-width="thick"/>', "expected a number, at least 0, not 'thick'"),
        ('<polyline points="1 2 3"/>', "points must be pairs"),
        ('<path d="M 0 0 L x"/>', "Invalid path element"),
        ('<path d="M1e400 0 L 1 1 z"/>', "far outside of the viewBox"),
        ("<rect", "it is not XML"),
    ],
)
def test_what_cannot_be_drawn_is_refused_in_one_sentence(load, shapes, message):
    with pytest.raises(WorldError, match=rf"^Invalid plan .*plan.svg: .*{message}.*\.$"):
        load(shapes)


@pytest.mark.parametrize(
    ("size", "message"),
    [
        ("", "viewBox must be four numbers"),
        ('width="4m" viewBox="0 0 4"', "viewBox must be four numbers"),
        ('viewBox="0 0 4 2"', "width must be a length, such as 12m"),
        ('width="400" viewBox="0 0 4 2"', "width must be a length in m, cm, mm, in, ft"),
        ('width="100%" viewBox="0 0 4 2"', "width must be a length in .*, not 100%"),
        ('width="4m" height="4m" viewBox="0 0 4 2"', "do not have the shape of the viewBox"),
        ('width="4km" viewBox="0 0 4 2"', "width must be a length in m"),
        ('width="4000m" viewBox="0 0 4 2"', "it is 4000 m x 2000 m large, more than 10000 m²"),
        ('width="1e300m" viewBox="0 0 1e-300 1"', "it is inf m x inf m large"),
    ],
)
def test_a_plan_without_a_usable_scale_is_refused(load, size, message):
    with pytest.raises(WorldError, match=rf"^Invalid plan .*{message}"):
        load("", size)


LAUGHS = '<!DOCTYPE svg [<!ENTITY a "lol"><!ENTITY b "&a;&a;&a;&a;">]>'


@pytest.mark.parametrize(
    ("shapes", "before", "message"),
    [
        ("<text>&b;</text>", LAUGHS, "it declares XML entities"),
        ("<rect/>" * 150_000, "", "larger than 1 MB"),
        (f'<path d="{"M0 0h100v50z" * 1000}"/>', "", "too long to draw"),
        ('<rect width="100" height="50"/>' * 1000, "", "too long to draw"),
        (
            f'<polyline stroke="red" stroke-width="20" points="{"0 0 9 9 " * 999}"/>',
            "",
            "too long to draw",
        ),
        ('<line x2="100" stroke="red" stroke-width="1e300"/>', "", "too long to draw"),
        (f"{'<g>' * 400}{'</g>' * 400}", "", "it is not XML"),
    ],
)
def test_a_bomb_is_refused_soon(load, shapes, before, message):
    began = time.process_time()
    with pytest.raises(WorldError, match=message):
        load(shapes, 'width="100m" viewBox="0 0 100 50"', before)
    assert time.process_time() - began < 5.0


def test_a_missing_plan_is_refused_in_one_sentence(tmp_path):
    with pytest.raises(WorldError, match=r"^Cannot read the plan .*: No such file .*\.$"):
        load_world(tmp_path / "none.svg")


def test_the_plan_of_the_docs_has_room_for_a_robot(tmp_path):
    page = Path(__file__).parents[2] / "displays/docs/ros/robots.md"
    plan = tmp_path / "plan.svg"
    plan.write_text(page.read_text().partition("```xml\n")[2].partition("```")[0])
    world = load_world(plan)
    assert world.cells.shape == (160, 240)
    assert len(Planner(world).spread(Pose2D(2.0, 2.0), count=12)) == 12

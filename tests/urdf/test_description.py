"""URDF text to a robot, and every way in which the text can be wrong."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from robots import link_poses
from small_robots import as_trimesh, load

from webviz.api.nodes import Mesh
from webviz_urdf import Resolver, RobotDescriptionError, load_file, load_robot

FETCH = Path(__file__).parents[3] / "shared/data/urdf/fetch_unbound_prefix.urdf"
BOX = "<geometry><box size='1 2 3'/></geometry>"
ARM = f"""<?xml version="1.0" encoding="utf-8"?>
<robot name="arm">
  <material name="blue"><color rgba="0 0 1 0.5"/></material>
  <link name="base"><visual>{BOX}<material name="blue"/></visual></link>
  <link name="tip">
    <inertial><origin xyz="0 0 0.1"/><mass value="2"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
    <visual name="a">{BOX}</visual><visual name="a">{BOX}</visual><collision>{BOX}</collision>
  </link>
  <joint name="turn" type="revolute"><parent link="base"/><child link="tip"/>
    <origin xyz="0 0 1" rpy="0 0 1.5"/><axis xyz="0 0 2"/>
    <limit lower="-1" upper="1e16" effort="1" velocity="1"/></joint>
</robot>"""


def test_links_joints_inertials_and_limits_are_read() -> None:
    robot = load(ARM)
    assert (robot.name, robot.root, list(robot.links)) == ("arm", "base", ["base", "tip"])
    joint = robot.joints["turn"]
    assert (joint.type, joint.parent, joint.child) == ("revolute", "base", "tip")
    assert joint.axis == (0.0, 0.0, 1.0)
    assert joint.limits == (-1.0, 1e16)
    assert joint.origin.position == (0.0, 0.0, 1.0)
    inertial = robot.links["tip"].inertial
    assert inertial is not None
    assert (inertial.mass, inertial.com.position) == (2.0, (0.0, 0.0, 0.1))
    assert not robot.missing
    assert not robot.warnings


def test_shapes_of_one_name_get_names_of_their_own() -> None:
    visuals = "".join(f"<visual name='{name}'>{BOX}</visual>" for name in ("a_2", "a", "a"))
    robot = load(f"<robot name='r'><link name='l'>{visuals}</link></robot>")
    assert [shape.name for shape in robot.links["l"].visuals] == ["a_2", "a", "a_2_2"]


def test_collisions_are_loaded_only_on_request() -> None:
    robot = load_robot(ARM, Resolver(ament_prefix_path=""), collisions=False)
    assert robot.links["tip"].collisions == ()
    assert len(robot.links["tip"].visuals) == 2


def test_progress_counts_every_shape_up_to_the_total() -> None:
    calls = []
    load_robot(
        ARM, Resolver(ament_prefix_path=""), lambda count, total, link: calls.append((count, total))
    )
    assert calls == [(0, 4), (1, 4), (2, 4), (3, 4), (4, 4)]


def test_a_robot_without_a_name_loads_with_a_warning() -> None:
    robot = load("<robot><link name='l'/></robot>")
    assert robot.name == "robot"
    assert robot.warnings == ("The robot has no name.",)


def test_names_with_unexpanded_placeholders_are_names_like_any_other() -> None:
    assert (
        load("<robot name='r'><link name='${namespace}base'/></robot>").root == "${namespace}base"
    )


def test_comments_and_foreign_elements_anywhere_are_ignored() -> None:
    robot = load(
        "<!-- c --><robot name='r' xmlns:g='http://g'><!-- c --><gazebo><link name='l'/></gazebo>"
        "<link name='l'><visual><geometry><!-- c --><sphere radius='1'/></geometry></visual>"
        "<g:visual/></link><transmission><joint name='j'/></transmission></robot>"
    )
    assert len(robot.links["l"].visuals) == 1
    assert not robot.joints


def test_elements_with_an_undeclared_prefix_are_ignored_and_other_faults_are_not() -> None:
    robot = load(
        "<robot name='r' a:b='c'><sensor:camera name='rgb'><link name='no'/></sensor:camera>"
        f"<link name='l'><visual x:y='z'>{BOX}</visual><xacro:visual/></link></robot>"
    )
    assert list(robot.links) == ["l"]
    assert len(robot.links["l"].visuals) == 1
    assert not robot.warnings
    for text in (
        "<robot name='r'><a:b><link name='l'/></robot>",
        "<a:robot><link name='l'/></a:robot>",
    ):
        with pytest.raises(RobotDescriptionError, match="is not XML"):
            load(text)


@pytest.mark.skipif(not FETCH.exists(), reason=f"{FETCH.name} is absent")
def test_a_real_robot_with_an_undeclared_prefix_is_read() -> None:
    robot = load(FETCH.read_text())
    assert (robot.name, len(robot.links), len(robot.joints)) == ("fetch", 25, 24)


def test_text_after_a_nul_is_ignored() -> None:
    assert load(ARM + "\0</robot>").name == "arm"


@pytest.mark.parametrize("extra", ["\n\n", "\ufeff"])
def test_space_or_a_byte_order_mark_before_the_declaration_is_tolerated(extra: str) -> None:
    assert load(extra + ARM).name == "arm"


def test_a_visual_without_a_known_geometry_is_missing_and_the_rest_is_shown() -> None:
    robot = load(
        f"<robot name='r'><link name='l'><visual>{BOX}</visual><visual/>"
        "<visual><geometry/></visual><visual><geometry><torus r='1'/></geometry></visual>"
        "<visual><geometry><mesh/></geometry></visual>"
        "<visual><geometry><box size='-1 1 1'/></geometry></visual></link></robot>"
    )
    assert len(robot.links["l"].visuals) == 1
    reasons = [missing.reason for missing in robot.missing]
    assert [missing.link for missing in robot.missing] == ["l"] * 5
    for word in ("no <geometry>", "nothing", "<torus>", "without a file name", "negative"):
        assert any(word in reason for reason in reasons), word


def test_primitives_have_their_size_and_point_outwards() -> None:
    robot = load(
        "<robot name='r'><link name='l'><visual><geometry><box size='1 2 3'/></geometry></visual>"
        "<visual><geometry><cylinder radius='1' length='3'/></geometry></visual>"
        "<visual><geometry><sphere radius='2'/></geometry></visual></link></robot>"
    )
    meshes = [as_trimesh(shape.node) for shape in robot.links["l"].visuals]
    assert [mesh.extents.tolist() for mesh in meshes[:2]] == [[1, 2, 3], [2, 2, 3]]
    volumes = [mesh.volume for mesh in meshes]
    assert volumes == pytest.approx([6.0, 9.42, 33.5], rel=0.02)


WRONG = {
    "": "empty",
    "hello": "not XML",
    "<robot name='r'>": "line 1",
    "<sdf/>": "<sdf>, not <robot>",
    "<robot name='r'/>": "no <link>",
    "<robot xmlns:xacro='http://ros.org/wiki/xacro'><xacro:a/></robot>": "xacro file",
    "<robot><link/></robot>": "Line 1: <link> has no 'name'",
    "<robot><link name='a'/><link name='a'/></robot>": "Two links are named 'a'",
    "<robot><link name='a'/><link name='b'/></robot>": "'a', 'b' have no parent",
    "<robot><link name='a'><visual><origin xyz='1 2'/></visual></link></robot>": "xyz='1 2'",
    "<robot>\n<link name='a'><visual><origin xyz='1 2 x'/></visual></link></robot>": "Line 2:",
    "<robot><link name='a'><visual><origin xyz='1 nan 2'/></visual></link></robot>": "not finite",
    "<robot><link name='a'><visual><geometry><box/></geometry></visual></link></robot>": "'size'",
    "<robot><link name='$(x)'><inertial><mass value='$(env M)'/></inertial></link></robot>": "env",
}
JOINTS = [
    ("ab", "<joint/>", "<joint> has no 'name'"),
    ("ab", "<joint name='j' type='fixed'/>", "'j' has no <parent>"),
    ("ab", "<joint name='j' type='fixed'><parent link='a'/><child/></joint>", "no 'link'"),
    ("ab", ("hinge", "j", "a", "b"), "type 'hinge'"),
    ("ab", ("fixed", "j", "a", "x"), "the child 'x', which is not a link"),
    ("ab", ("fixed", "j", "b", "b"), "loop through 'b'"),
    ("abc", ("fixed", "j", "b", "c", "fixed", "k", "c", "b"), "loop through 'b', 'c'"),
    ("ab", ("fixed", "j", "a", "b", "fixed", "k", "b", "a"), "loop through 'a', 'b'"),
    ("abc", ("fixed", "j", "a", "b", "fixed", "j", "a", "c"), "Two joints are named 'j'"),
    ("abc", ("fixed", "j", "a", "b", "fixed", "k", "c", "b"), "child of two joints, 'j' and 'k'"),
]


def tree(links: str, joints: str | tuple[str, ...]) -> str:
    """A robot of links with names of one letter; joints as text or as type, name, parent, child."""
    if not isinstance(joints, str):
        quadruples = zip(*[iter(joints)] * 4, strict=True)
        joints = "".join(
            f"<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>"
            "</joint>"
            for kind, name, parent, child in quadruples
        )
    names = "".join(f"<link name='{link}'/>" for link in links)
    return f"<robot name='r'>{names}{joints}</robot>"


@pytest.mark.parametrize(
    ("text", "words"),
    [*WRONG.items(), *((tree(links, joints), words) for links, joints, words in JOINTS)],
)
def test_a_wrong_description_is_refused_in_one_sentence_that_names_the_place(
    text: str, words: str
) -> None:
    with pytest.raises(RobotDescriptionError) as excinfo:
        load(text)
    assert words in str(excinfo.value)
    assert "\n" not in str(excinfo.value)
    assert str(excinfo.value).endswith(".")


def entities(count: int, where: str) -> str:
    definitions = "".join(
        f"<!ENTITY e{i} '{f'&e{i - 1};' * 10 if i else 'ha'}'>" for i in range(count)
    )
    use = {"attribute": f"name='&e{count - 1};'", "text": "name='r'"}[where]
    text = f"&e{count - 1};" if where == "text" else ""
    return f"<!DOCTYPE robot [{definitions}]><robot {use}><link name='l'/>{text}</robot>"


@pytest.mark.parametrize("where", ["attribute", "text"])
@pytest.mark.parametrize("count", [1, 12])
def test_entities_are_refused_before_they_grow(where: str, count: int) -> None:
    with pytest.raises(RobotDescriptionError):
        load(entities(count, where))


@pytest.mark.parametrize(
    "declaration",
    ["<!ENTITY x SYSTEM '{uri}'>", "<!ENTITY % x SYSTEM '{uri}'> %x;"],
)
def test_external_entities_are_refused_and_their_files_not_read(
    tmp_path: Path, declaration: str
) -> None:
    secret = tmp_path / "secret"
    secret.write_text("<!ENTITY leaked 'leaked'>")
    dtd = declaration.format(uri=secret.as_uri())
    with pytest.raises(RobotDescriptionError) as excinfo:
        load(f"<!DOCTYPE robot [{dtd}]><robot name='r'><link name='l'/>&x;</robot>")
    assert "leaked" not in str(excinfo.value)


def test_an_external_dtd_is_not_read(tmp_path: Path) -> None:
    dtd = tmp_path / "robot.dtd"
    dtd.write_text("<!ATTLIST robot name CDATA 'from the dtd'>")
    robot = load(f"<!DOCTYPE robot SYSTEM '{dtd.as_uri()}'><robot><link name='l'/></robot>")
    assert robot.name == "robot"


TOKENS = re.split(r'("[^"]*"|<[^>]*>)', ARM)
JUNK = st.sampled_from(
    ['""', '"nan"', '"1e400"', '"-1"', '"a b"', "<", ">", "&x;", "<!--", "<![CDATA[", "\x00",
     "\ud800", "</link>", "<link name='q'/>", "<joint>", "<geometry>", "é", "-inf"]
)  # fmt: skip


@settings(max_examples=400, deadline=None)
@given(st.lists(st.tuples(st.integers(0, len(TOKENS) - 1), JUNK | st.text(max_size=8)), min_size=1))
def test_any_damage_to_a_description_is_read_or_refused_in_one_line(
    damage: list[tuple[int, str]],
) -> None:
    tokens = list(TOKENS)
    for place, junk in damage:
        tokens[place] = junk
    text = "".join(tokens)
    robot = refusal = None
    try:
        robot = load_robot(text, Resolver(ament_prefix_path=""))
    except RobotDescriptionError as error:
        refusal = str(error)
    if robot is None:
        assert refusal
        assert "\n" not in refusal
    else:
        assert link_poses(robot).keys() == robot.links.keys()
        nodes = [shape.node for link in robot.links.values() for shape in link.visuals]
        assert all(isinstance(node, Mesh) for node in nodes)


@given(st.text())
def test_any_text_at_all_is_read_or_refused(text: str) -> None:
    with pytest.raises(RobotDescriptionError):
        load_robot(text, Resolver(ament_prefix_path=""))


def test_a_file_finds_meshes_beside_it(tmp_path: Path) -> None:
    (tmp_path / "m.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    path = tmp_path / "r.urdf"
    mesh = "<visual><geometry><mesh filename='m.obj'/></geometry></visual>"
    path.write_text(f"\ufeff<robot name='r'><link name='l'>{mesh}</link></robot>", "utf-8")
    (shape,) = load_file(path, Resolver([tmp_path])).links["l"].visuals
    assert as_trimesh(shape.node).extents.tolist() == [1, 1, 0]


def test_a_file_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(RobotDescriptionError, match=r"gone\.urdf cannot be read"):
        load_file(tmp_path / "gone.urdf")

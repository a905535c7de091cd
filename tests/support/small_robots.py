"""Small robots and meshes, and a reader that shares no code with what is tested."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import trimesh

from webviz.api.nodes import Glb, Mesh
from webviz_urdf import Resolver, Robot, load_robot

CUBE_DAE = """<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit name="u" meter="{unit}"/><up_axis>{up}</up_axis></asset>
  {images}
  <library_effects>{effects}</library_effects>
  <library_materials>
    <material id="m"><instance_effect url="#e"/></material>
  </library_materials>
  <library_geometries><geometry id="g"><mesh>
    <source id="p"><float_array id="pa" count="12">0 0 0 1 0 0 0 2 0 0 0 3</float_array>
      <technique_common><accessor source="#pa" count="4" stride="3">
        <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
      </accessor></technique_common></source>
    <source id="t"><float_array id="ta" count="8">0 0 1 0 0 1 1 1</float_array>
      <technique_common><accessor source="#ta" count="4" stride="2">
        <param name="S" type="float"/><param name="T" type="float"/>
      </accessor></technique_common></source>
    <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
    <triangles material="s" count="4"><input semantic="VERTEX" source="#v" offset="0"/>
      <input semantic="TEXCOORD" source="#t" offset="1" set="0"/>
      <p>0 0 2 2 1 1 0 0 1 1 3 3 0 0 3 3 2 2 1 1 2 2 3 3</p></triangles>
  </mesh></geometry></library_geometries>
  <library_visual_scenes><visual_scene id="vs"><node id="n">
    <instance_geometry url="#g">{binding}</instance_geometry>
  </node></visual_scene></library_visual_scenes>
  <scene><instance_visual_scene url="#vs"/></scene>
</COLLADA>"""
GREEN = (
    '<effect id="e"><profile_COMMON><technique sid="c"><phong><diffuse>'
    "<color>0 1 0 1</color></diffuse></phong></technique></profile_COMMON></effect>"
)
TEXTURED = (
    '<effect id="e"><profile_COMMON>'
    '<newparam sid="sf"><surface type="2D"><init_from>i</init_from></surface></newparam>'
    '<newparam sid="sa"><sampler2D><source>sf</source></sampler2D></newparam>'
    '<technique sid="c"><phong><diffuse><texture texture="sa" texcoord="UV"/></diffuse></phong>'
    "</technique></profile_COMMON></effect>"
)
BINDING = (
    "<bind_material><technique_common>"
    '<instance_material symbol="s" target="#m"/></technique_common></bind_material>'
)


def tetrahedron_dae(
    unit: str = "1", up: str = "Z_UP", effects: str = GREEN, image: str = "", bound: bool = True
) -> str:
    """Return the COLLADA text of a tetrahedron, 1, 2 and 3 units long along x, y and z."""
    images = f'<library_images><image id="i"><init_from>{image}</init_from></image>'
    return CUBE_DAE.format(
        unit=unit,
        up=up,
        effects=effects,
        images=images + "</library_images>" if image else "",
        binding=BINDING if bound else "",
    )


def load(text: str, *roots: Path) -> Robot:
    """Load URDF text with no files but those of the given mesh roots."""
    return load_robot(text, Resolver(roots, ament_prefix_path=""))


def one_mesh(path: Path, mesh: str = "", material: str = "") -> Robot:
    """Load a robot of one link with one mesh, which may be any text of a URDF `<mesh>`."""
    return load(
        f'<robot name="r"><link name="l"><visual><geometry><mesh filename="{path}" {mesh}/>'
        f"</geometry>{material}</visual></link></robot>",
        path.parent,
    )


def only_node(robot: Robot) -> Mesh | Glb:
    """Return the node of a robot's only visual."""
    assert not robot.missing
    (shape,) = [shape for link in robot.links.values() for shape in link.visuals]
    return shape.node


def only_mesh(robot: Robot) -> Mesh:
    """Return the node of a robot's only visual, a mesh of one colour."""
    node = only_node(robot)
    assert isinstance(node, Mesh)
    return node


def only_glb(robot: Robot) -> Glb:
    """Return the node of a robot's only visual, with materials of its own."""
    node = only_node(robot)
    assert isinstance(node, Glb)
    return node


def as_trimesh(node: Mesh | Glb) -> trimesh.Trimesh:
    """Return a node as one trimesh; a GLB through trimesh's own reader."""
    if isinstance(node, Mesh):
        return trimesh.Trimesh(node.vertices, node.faces, process=False)
    scene = trimesh.load_scene(io.BytesIO(node.data), "glb", process=False)
    placed = [scene.graph[node] for node in scene.graph.nodes_geometry]
    meshes = [scene.geometry[name] for _, name in placed]
    joints = [
        trimesh.transform_points(mesh.vertices, pose)
        for mesh, (pose, _) in zip(meshes, placed, strict=True)
    ]
    offsets = np.cumsum([0] + [len(vertices) for vertices in joints[:-1]])
    faces = [mesh.faces + n for mesh, n in zip(meshes, offsets, strict=True)]
    return trimesh.Trimesh(np.concatenate(joints), np.concatenate(faces), process=False)

"""URDF materials of visuals, by urdfdom's and RViz's rules.

Names are global: the robot's own materials come first, then those defined inside links, in the
order of the text; the first definition of a name wins, also over a visual's own colour
(urdfdom's `assignMaterial`). A visual without a material, or with an undefined one, is drawn in
RViz's ShadedRed; the latter gives a warning, while urdfdom refuses the whole robot.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import yourdfpy

Rgba = tuple[float, float, float, float]
SHADED_RED: Rgba = (1.0, 0.0, 0.0, 1.0)


@dataclass(frozen=True)
class Material:
    """A material of URDF.

    Args:
        rgba: 0 to 1, sRGB.
        texture: URI of an image, "" without one.
        warning: a sentence about a fault of the material, "" without one.
    """

    rgba: Rgba = SHADED_RED
    texture: str = ""
    warning: str = field(default="", compare=False)


DEFAULT = Material()


class Materials:
    """The materials of a robot by name.

    Args:
        model: the robot; its links in the order of the text.
    """

    def __init__(self, model: yourdfpy.Robot) -> None:
        self._by_name: dict[str, Material] = {}
        self._conflicting: set[str] = set()
        self.warnings: list[str] = []
        for material in model.materials:
            self._define(material, "the robot")
        for link in model.links:
            for visual in link.visuals:
                self._define(visual.material, f"link '{link.name}'")

    def of(self, visual: yourdfpy.Visual, link: str) -> Material:
        """Return the material of a visual of the link named `link`."""
        material = visual.material
        if material is None:
            return DEFAULT
        if material.name in self._by_name:
            return self._by_name[material.name]
        return _definition(material) or Material(
            warning=f"Material '{material.name or ''}' of link '{link}' is not defined. The "
            "default red is used."
        )

    def of_collisions(self, link: yourdfpy.Link) -> Material:
        """Return the material of a link's collisions: in RViz that of its first visual."""
        return self.of(link.visuals[0], link.name) if link.visuals else DEFAULT

    def _define(self, material: yourdfpy.Material | None, where: str) -> None:
        definition = material and _definition(material)
        if material is None or definition is None or not material.name:
            return
        known = self._by_name.setdefault(material.name, definition)
        if known != definition and material.name not in self._conflicting:
            self._conflicting.add(material.name)
            self.warnings.append(
                f"Material '{material.name}' is redefined differently in {where}; "
                "the first definition is used."
            )


def _definition(material: yourdfpy.Material) -> Material | None:
    """Return the content of a material, None if it is only a name."""
    texture = (material.texture and material.texture.filename) or ""
    if material.color is not None:
        r, g, b, a = (min(max(float(v), 0.0), 1.0) for v in material.color.rgba)
        return Material((r, g, b, a), texture)
    return Material((1.0, 1.0, 1.0, 1.0), texture) if texture else None

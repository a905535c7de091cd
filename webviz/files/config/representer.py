"""How text is written as YAML so that it comes back."""

from __future__ import annotations

from typing import Any

from ruamel.yaml.nodes import ScalarNode
from ruamel.yaml.representer import SafeRepresenter

_BREAKS = "\x85\u2028\u2029"
"""Ends of lines to older YAML, which ruamel writes as they are and reads as spaces."""


class Representer(SafeRepresenter):
    """ruamel's, but it quotes what would come back as something else."""

    def represent_str(self, data: Any) -> ScalarNode:
        """Text, in quotes that hold ends of lines where it has any."""
        style = '"' if any(mark in data for mark in _BREAKS) else None
        return self.represent_scalar("tag:yaml.org,2002:str", data, style)


Representer.add_representer(str, Representer.represent_str)

"""Writing text as YAML that reads back unchanged."""

from __future__ import annotations

from typing import Any

from ruamel.yaml.nodes import ScalarNode
from ruamel.yaml.representer import SafeRepresenter

_BREAKS = "\x85\u2028\u2029"
"""Line ends in older YAML, which ruamel writes unquoted and reads as spaces."""


class Representer(SafeRepresenter):
    """ruamel's representer, which also quotes text that would read back as another value."""

    def represent_str(self, data: Any) -> ScalarNode:
        """Text, double-quoted if it contains line ends."""
        style = '"' if any(mark in data for mark in _BREAKS) else None
        return self.represent_scalar("tag:yaml.org,2002:str", data, style)


Representer.add_representer(str, Representer.represent_str)

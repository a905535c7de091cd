"""Modules of the page as a release has them: packed into one by esbuild, beside themselves.

A pack is used only while it matches the installed modules, so that an edited module takes effect
without packing. Modules of plug-ins import those in the pack by their names.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from pathlib import Path

import msgspec

NAME = "packed.js"
"""Name of the pack among the modules of a page."""
MAP = f"/webviz/{NAME}.map"
"""Path of its source map, below the page."""


class Pack(msgspec.Struct, frozen=True):
    """A pack as `tests/release/packing.py` writes it.

    Args:
        digest: of the modules in it, see `digest`.
        code: the pack, a module that exports `modules`, all by their names.
        map: its source map, without the sources.
        exports: names that each module exports, by its own.
    """

    digest: str
    code: str
    map: str
    exports: dict[str, list[str]]

    def modules(self, others: Mapping[str, str]) -> dict[str, str]:
        """Return the modules of a page: the pack, those that lead into it, and those not in it.

        Args:
            others: all modules of a page by their names.
        """
        leading = {name: _leading(name, names) for name, names in self.exports.items()}
        return {**others, **leading, NAME: self.code}

    def source_map(self, sources: Mapping[str, str]) -> bytes:
        """Return the source map with the sources, which developer tools show."""
        decoded = json.loads(self.map)
        decoded["sourcesContent"] = [sources.get(name) for name in decoded["sources"]]
        return json.dumps(decoded).encode()


def digest(modules: Mapping[str, str]) -> str:
    """Return the SHA-256 of modules by their names."""
    return hashlib.sha256(json.dumps(sorted(modules.items())).encode()).hexdigest()


def pack_of(modules: Mapping[str, str], file: Path) -> Pack | None:
    """Return the pack in a file, or None without one or if a module is not as in it."""
    try:
        pack = msgspec.json.decode(file.read_bytes(), type=Pack)
    except FileNotFoundError:
        return None
    own = {name: modules[name] for name in pack.exports if name in modules}
    return pack if digest(own) == pack.digest else None


def _leading(name: str, exported: list[str]) -> str:
    """Return a module that exports what one in the pack does."""
    lines = [f'import {{ modules }} from "webviz/{NAME}";', f'const own = modules["{name}"];']
    for each in exported:
        begin = "export default" if each == "default" else f"export const {each} ="
        lines.append(f"{begin} own.{each};")
    return "\n".join(lines)

"""Robot descriptions whose meshes are not found."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation


class MissingMeshes(Check):
    """Meshes are missing.

    The robot description names meshes that are not on this machine.

    Why:
        The robot is drawn without these parts, or not at all, although its links are placed.

    Repair:
        Install the package of the description and source its workspace, or name its folder with
        `--mesh-root`.
    """

    id = "DATA011"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such display."""
        for display in observation.displays:
            status = display.problem("Meshes")
            if status is not None:
                yield self.found(
                    f"{display.display.name} lacks meshes on this machine.",
                    "Source the workspace of the description, or name its folder with --mesh-root.",
                    subject=display.display.name,
                    evidence={"status": status.text[:200]},
                    explains=display.symptom("Meshes"),
                )

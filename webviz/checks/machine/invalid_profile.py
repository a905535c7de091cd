"""Files of the middleware that cannot be read."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation

INLINE = "CYCLONEDDS_URI"
"""A variable that may hold the XML itself."""


class InvalidProfile(Check):
    """Invalid file of the middleware.

    A variable such as FASTRTPS_DEFAULT_PROFILES_FILE or CYCLONEDDS_URI names a file that is missing
    or is not valid XML.

    Why:
        The middleware ignores the file and uses its defaults, or does not start. Both look like a
        fault of the network.

    Repair:
        Correct the file; print the place of the fault with

            xmllint --noout profile.xml
    """

    id = "ENV007"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such file."""
        profiles = observation.environment.profiles if observation.environment else {}
        for path, problem in profiles.items():
            if problem:
                is_file = path != INLINE
                yield self.found(
                    f"{f'The file {path}' if is_file else f'The XML in {path}'} for the middleware "
                    f"is invalid: {problem}.",
                    "Correct the file, or remove the variable that names it."
                    if is_file
                    else "Correct or remove the variable.",
                    subject=path,
                    evidence={"path": path, "problem": problem},
                    command=f"xmllint --noout {path}" if is_file else f"printenv {path}",
                )

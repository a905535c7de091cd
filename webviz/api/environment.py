"""This machine as the checks of the doctor see it: variables, network and shared memory."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, kw_only=True)
class Environment:
    """This machine at one moment.

    Args:
        variables: of the environment of this program.
    """

    variables: Mapping[str, str] = field(default_factory=dict)

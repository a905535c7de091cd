"""Report of the cases tried and their outcomes."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from tests.attack.attack import Case, Outcome


@dataclass(frozen=True)
class Breach:
    """A case that broke a promise."""

    kind: str
    number: int | str
    """Number of the case, or its name in the corpus."""
    promise: str
    case: Case | None = None

    def __str__(self) -> str:
        name = f" ({self.case.name}, {len(self.case.data)} bytes)" if self.case else ""
        return f"{self.kind} {self.number}{name}: {self.promise}"


@dataclass
class Report:
    """Counts by kind, and all breaches."""

    seed: int
    counts: dict[str, Counter[Outcome]] = field(default_factory=dict)
    breaches: list[Breach] = field(default_factory=list)
    slowest_s: float = 0.0
    """The longest time the viewer took to answer a bystander."""
    memory_mb: float = 0.0
    """The most memory that the viewer and its processes had."""

    def add(self, kind: str, outcome: Outcome) -> None:
        """Count a case."""
        self.counts.setdefault(kind, Counter())[outcome] += 1

    def __str__(self) -> str:
        lines = [
            f"seed {self.seed}; slowest answer {self.slowest_s:.2f} s; "
            f"memory {self.memory_mb:.0f} MB",
            f"{'kind':12}{'tried':>8}{'refused':>9}{'survived':>10}{'done':>7}{'broken':>8}",
        ]
        broken = Counter(breach.kind for breach in self.breaches)
        for kind in sorted({*self.counts, *broken}):
            result = self.counts.get(kind, Counter())
            tried = result.total() + broken[kind]
            lines.append(
                f"{kind:12}{tried:8}{result[Outcome.REFUSED]:9}{result[Outcome.SURVIVED]:10}"
                f"{result[Outcome.DONE]:7}{broken[kind]:8}"
            )
        return "\n".join([*lines, *map(str, self.breaches)])

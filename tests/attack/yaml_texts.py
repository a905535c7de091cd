"""YAML of others: QoS profiles and metadata of bags, maps and files of parameters, configs."""

from __future__ import annotations

from random import Random

from tests.attack.attack import Case, mutated
from tests.attack.files import RVIZ, YAML

TEXTS = {
    "a.qos": """\
- history: 3
  depth: 10
  reliability: best_effort
  durability: transient_local
  deadline: {sec: 9223372036, nsec: 854775807}
  avoid_ros_namespace_conventions: false
""",
    "a.metadata": """\
rosbag2_bagfile_information:
  version: 9
  storage_identifier: mcap
  relative_file_paths: [bag_0.mcap]
  compression_format: ""
  compression_mode: ""
  topics_with_message_count:
    - {topic_metadata: {name: /a, type: std_msgs/msg/String}, message_count: 3}
""",
    "a.map": """\
image: a.png
resolution: 0.05
origin: [0.0, 0.0, 0.0]
occupied_thresh: 0.65
free_thresh: 0.25
negate: 0
mode: trinary
""",
    "a.params": "/**:\n  ros__parameters:\n    rate: 10.0\n    names: [a, b]\n",
    "a.yaml": YAML,
    "a.rviz": RVIZ,
}
"""A good text of each kind, by the name of its file."""
SCALARS = (
    "9" * 5000,
    "0x" + "f" * 5000,
    "-.inf",
    "1e99999",
    "2001-13-45",
    "2001-01-01",
    "!!binary aGk=",
    "!!set {a, b}",
    "!!python/object/apply:os.system [echo]",
    "!a b",
    "'\\ud800'",
    '"\\ud800"',
    "<<",
    "*none",
    "{? [a] : b}",
    "{a: 1, a: 2}",
    "x" * 100_000,
)
ROOTS = ("", "%YAML 1.1\n---\n", "---\n", "%TAG ! tag:x,2000:\n---\n")


def draw(random: Random) -> Case:
    """Reads texts that unfold without end, nest without end, or have odd values."""
    name = random.choice(sorted(TEXTS))
    lines = TEXTS[name].splitlines()
    head, value = _hostile(random)
    keys = [i for i, line in enumerate(lines) if ": " in line and "{" not in line]
    index = random.choice(keys)
    lines[index] = f"{lines[index].partition(': ')[0]}: {value}"
    if random.random() < 0.2:
        lines = [f"- {value}"]
    # The anchors come first, at a key that no reader knows.
    if head and name == "a.qos":
        head = [f"- {line}" for line in head]
    text = "\n".join([*head, *lines])
    data = (random.choice(ROOTS) if random.random() < 0.2 else "").encode() + text.encode()
    return Case(name, mutated(random, data) if random.random() < 0.2 else data)


def _hostile(random: Random) -> tuple[list[str], str]:
    """Lines that define anchors, and a value."""
    match random.randrange(4):
        case 0:
            return [], random.choice(SCALARS)
        case 1:
            depth = random.choice((20, 100, 5000))
            opening, closing = random.choice((("[", "]"), ("{a: ", "}"), ("- ", "")))
            return [], opening * depth + random.choice(("", closing * depth))
        case 2:
            return [], f"&a [{', '.join(['*a'] * random.choice((1, 10)))}]"
        case _:
            return _aliases(random)


def _aliases(random: Random) -> tuple[list[str], str]:
    levels, width = random.randint(1, 12), random.choice((2, 10, 40))
    text = random.choice(("x", "x" * 1000, "7" * 900))
    kind = random.choice(("list", "mapping", "merge"))
    lines = [f"x0: &l0 {{a: {text}}}"]
    for level in range(1, levels + 1):
        aliases = ", ".join([f"*l{level - 1}"] * width)
        pairs = ", ".join(f"k{i}: *l{level - 1}" for i in range(width))
        texts = {"list": f"[{aliases}]", "mapping": f"{{{pairs}}}", "merge": f"{{<<: [{aliases}]}}"}
        lines.append(f"x{level}: &l{level} {texts[kind]}")
    return lines, f"*l{levels}"

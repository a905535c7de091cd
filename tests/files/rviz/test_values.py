"""Values and topics of .rviz files."""

import pytest

from webviz.api.declared import Topic
from webviz.api.ports import Input
from webviz.files.rviz import topics
from webviz.files.rviz.values import Unfit, read

UPDATES = Input("map_msgs/msg/OccupancyGridUpdate", suffix="_updates")


def test_a_whole_number_is_not_rounded() -> None:
    assert (read("2", int), read("2.0", int)) == (2, 2)
    with pytest.raises(Unfit, match=r"expected a whole number, got 2\.5"):
        read("2.5", int)


@pytest.mark.parametrize("raw", [None, {"Value": None}, {"Child": 1}, [1]])
@pytest.mark.parametrize("kind", [bool, int, float, str])
def test_a_property_without_a_value_is_unfit(raw: object, kind: type) -> None:
    with pytest.raises(Unfit, match="it has no value"):
        read(raw, kind)


@pytest.mark.parametrize(
    ("own", "first", "output"),
    [("", "/map", "/map_updates"), ("/own", "/map", "/own"), ("", "", "")],
)
def test_a_topic_beside_the_first_is_written_with_its_name(
    own: str, first: str, output: str
) -> None:
    tree = topics.write(Topic(own), UPDATES, Topic(first))
    assert isinstance(tree, dict)
    assert tree["Value"] == output

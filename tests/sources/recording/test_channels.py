"""Types and profiles of the topics of a recording."""

from __future__ import annotations

from webviz.sources import Offer, Publisher
from webviz.sources.recording.channels import Channels

STRING = "std_msgs/msg/String"


def test_a_topic_whose_publishers_disagree_on_the_type_has_no_channel() -> None:
    types = "nav_msgs/msg/Path", STRING
    one, two = (
        Offer(tuple(Publisher("/a", type_, "reliable", "volatile") for type_ in types[:count]))
        for count in (1, 2)
    )
    channels = Channels(lambda: {"/one": one, "/two": two})
    channel = channels.find("/one")
    assert channel is not None
    assert channel.type == "nav_msgs/msg/Path"
    assert channels.find("/two") is None


def test_a_topic_whose_publishers_ended_keeps_its_type() -> None:
    offers = {"/a": Offer((Publisher("/a", STRING, "best_effort", "volatile"),))}
    channels = Channels(lambda: offers)
    channels.look()
    offers = {"/a": Offer(())}  # subscribed to, by another program
    channels.look()
    channel = channels.find("/a")
    assert channel is not None
    assert channel.type == STRING
    assert "best_effort" in channel.profiles
    assert Channels(lambda: offers).find("/a") is None

"""Number of texts a scene sends."""

from __future__ import annotations

import numpy as np
import pytest
from viser import LabelHandle
from viser_internals import scene_handles

from webviz.api.nodes import Labels
from webviz.scene import ViserScene
from webviz.scene.label_budget import AT_ONCE, LabelBudget


def labels(texts: list[str], x: float = 0.0) -> Labels:
    return Labels(np.full((len(texts), 3), x, np.float32), tuple(texts), 0.1)


def label_texts(scene: ViserScene) -> list[str]:
    """The texts that browsers have been sent and keep."""
    handles = scene_handles(scene.link.server)
    return sorted(each.text for each in handles if isinstance(each, LabelHandle))


def settle(scene: ViserScene) -> None:
    scene.flush()
    while scene.link.label_budget.is_unfinished:
        scene.flush()


def test_many_texts_are_added_over_several_flushes(scene: ViserScene) -> None:
    woken: list[bool] = []
    scene.link.deferred.wake = lambda: woken.append(True)
    texts = [f"{number:04}" for number in range(2 * AT_ONCE + 1)]
    scene.upsert("m", "texts", labels(texts))
    scene.flush()
    assert label_texts(scene) == texts[:AT_ONCE]
    assert woken == [True]
    scene.flush()
    scene.flush()
    assert label_texts(scene) == texts
    assert woken == [True, True]


def test_texts_of_several_nodes_are_limited_and_room_is_given_back(
    scene: ViserScene, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.scene.label_budget.MAX_LABELS", 3)
    monkeypatch.setattr(scene.link, "label_budget", LabelBudget())
    scene.upsert("a", "texts", labels(["1", "2"]))
    scene.upsert("b", "texts", labels(["3", "4", "5"]))
    settle(scene)
    assert label_texts(scene) == ["1", "2", "3"]
    scene.upsert("a", "texts", labels(["1"]))
    settle(scene)
    settle(scene)
    assert label_texts(scene) == ["1", "3", "4"]
    scene.remove_group("a")
    settle(scene)
    assert label_texts(scene) == ["3", "4", "5"]
    scene.remove("b", "texts")
    scene.upsert("c", "texts", labels(["6", "7", "8", "9"]))
    settle(scene)
    assert label_texts(scene) == ["6", "7", "8"]


def test_the_characters_of_all_texts_are_limited(
    scene: ViserScene, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.scene.label_budget.MAX_CHARACTERS", 10)
    monkeypatch.setattr(scene.link, "label_budget", LabelBudget())
    scene.upsert("a", "texts", labels(["12345", "123456"]))
    settle(scene)
    assert label_texts(scene) == ["12345"]
    scene.upsert("a", "texts", labels(["1234", "123456"]))
    settle(scene)
    assert len(label_texts(scene)) == 2
    scene.upsert("a", "texts", labels(["12345", "123456"]))
    settle(scene)
    assert label_texts(scene) == ["12345"]
    scene.upsert("a", "texts", labels([]))
    settle(scene)
    assert label_texts(scene) == []
    scene.upsert("a", "texts", labels(["1234567890"]))
    settle(scene)
    assert label_texts(scene) == ["1234567890"]

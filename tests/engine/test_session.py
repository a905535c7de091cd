"""Actions on a viewer: files, copies, moves, settings, and their outcomes."""

from __future__ import annotations

import fcntl
import os
import time
from pathlib import Path

import pytest
from bench import Bench, Benches

from webviz.api.declared import Topic, to_values
from webviz.api.group import DisplayGroup
from webviz.api.views import Orbit
from webviz.commands import (
    AddDisplay,
    AddPanel,
    DuplicateDisplay,
    Export,
    Load,
    MoveDisplay,
    Open,
    Refresh,
    ResetDisplay,
    Save,
    SaveImage,
    SaveView,
    SetBackground,
    SetFrameRate,
    SetProperty,
    SetToolProperty,
    WriteDisplays,
)
from webviz.engine.commands import Command, Sender
from webviz.engine.requests import MAX_FILES, MAX_REQUESTS
from webviz.engine.state import ConfigFile, State
from webviz.files.config import Branch, Unreadable, document
from webviz.files.opening import load, parse
from webviz_displays.axes import Axes
from webviz_displays.grid import Grid
from webviz_displays.laser_scan import LaserScan
from webviz_displays.path import Path as PathDisplay
from webviz_displays.text import Text


def do(b: Bench, command: Command) -> State:
    """Run a command and return the state that panels show."""
    return b.do(command)


def names(state: State) -> list[str]:
    """The list of displays, indented as in the panel."""
    return ["  " * row.depth + row.name for row in state.rows]


def offers(b: Bench, *names: str) -> bool:
    """Return whether the config files of the folder become these."""
    return any(do(b, Refresh()).file.others == names or time.sleep(0.01) for _ in range(1000))


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder in which webviz was started."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


# Files


def test_a_config_is_saved_under_a_name_and_then_again_without(
    folder: Path, bench: Benches
) -> None:
    b = bench(Axes(name="A"))
    assert b.ask(Save("lab.yaml")) == "Saved lab.yaml."
    assert b.states[-1].file.path == str(folder / "lab.yaml")
    do(b, SetProperty("display1", "length", 2.5))
    do(b, Save())
    assert "length: 2.5" in (folder / "lab.yaml").read_text()


def test_saving_as_rviz_names_unsupported_parts(folder: Path, bench: Benches) -> None:
    b = bench(Axes(name="A"))
    do(b, AddPanel("Plot"))
    answer = b.ask(Save("lab.rviz"))
    assert answer.startswith("Saved lab.rviz. ")
    assert answer.endswith(" Plot: Plot: skipped, because RViz has no such panel.")


def test_a_config_without_a_file_needs_a_name(folder: Path, bench: Benches) -> None:
    assert bench(Axes(name="A")).refusal(Save()) == ("This config has no file yet. Choose a name.")


def test_unsaved_changes_are_marked_until_saved_or_undone(folder: Path, bench: Benches) -> None:
    b = bench(Axes(name="A"))
    assert not do(b, Refresh()).file.is_changed
    assert do(b, SetProperty("display1", "length", 2.5)).file.is_changed
    assert not do(b, SetProperty("display1", "length", 1.0)).file.is_changed
    assert do(b, SetBackground((1, 2, 3))).file.is_changed
    assert not do(b, Save("a.yaml")).file.is_changed


def test_opening_another_file_replaces_the_config(folder: Path, bench: Benches) -> None:
    b = bench(Axes(name="A"))
    do(b, Save("a.yaml"))
    (folder / "b.yaml").write_text("fixed_frame: odom\ndisplays:\n- {type: Axes, name: B}\n")
    b.transform("map", "base", 0, static=True)
    assert b.scene.groups
    assert b.ask(Open("b.yaml")) == "Opened b.yaml."
    state = b.states[-1]
    assert (state.fixed_frame, names(state)) == ("odom", ["B"])
    file = ConfigFile(str(folder / "b.yaml"), False, str(folder), state.file.others)
    assert state.file == file
    assert not any(group.startswith("display1") for group in b.scene.groups)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (None, "No such file"),
        ("a FIFO", "it is not a regular file"),
        ("a: [", "is not valid YAML"),
        ("version: 99", "update webviz"),
        ("fixed_fram: x", "did you mean `fixed_frame`?"),
    ],
)
def test_a_file_that_cannot_be_opened_changes_nothing(
    folder: Path, bench: Benches, text: str | None, sentence: str
) -> None:
    b = bench(Axes(name="A"))
    if text == "a FIFO":
        os.mkfifo(folder / "bad.yaml")
    elif text is not None:
        (folder / "bad.yaml").write_text(text)
    assert sentence in b.refusal(Open("bad.yaml"))
    state = b.states[-1]
    assert (names(state), state.file.path) == (["A"], "")


def test_the_frame_loop_goes_on_while_files_wait_for_the_disk(folder: Path, bench: Benches) -> None:
    (folder / "b.yaml").write_text("displays:\n- {type: Axes, name: B}\n")
    b = bench(Axes(name="A"))
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX)  # for which saving waits
        saving, opening = b.viewer.enqueue(Save("a.yaml")), b.viewer.enqueue(Open("b.yaml"))
        assert do(b, SetBackground((1, 2, 3))).settings.background == (1, 2, 3)
        assert not saving.done()
        assert not opening.done()
    finally:
        os.close(descriptor)
    b.until_done(opening)
    assert saving.result() == "Saved a.yaml."
    assert b.states[-1].file.path == str(folder / "b.yaml")
    assert names(b.states[-1]) == ["B"]
    saved_config = load(folder / "a.yaml")
    assert saved_config.settings.background != (1, 2, 3)  # as it was at the time of Save


def test_the_end_waits_for_a_file_that_is_being_written(folder: Path, bench: Benches) -> None:
    b = bench(Axes(name="A"))
    saving, later = b.viewer.enqueue(Save("a.yaml")), b.viewer.enqueue(Save("b.yaml"))
    b.turn()
    b.viewer.close()
    assert saving.result(timeout=0) == "Saved a.yaml."
    assert str(later.exception(timeout=0)) == "The viewer has ended."
    assert [path.name for path in folder.iterdir()] == ["a.yaml"]


def test_files_that_wait_are_not_more_than_a_few(bench: Benches) -> None:
    b = bench()
    exports = [b.viewer.enqueue(Export(lambda _: None)) for _ in range(MAX_FILES + 2)]
    b.turn()
    assert str(exports[-1].exception(timeout=0)) == "Too many files at once. Try again later."
    b.until_done(exports[-2])
    assert [each.result() for each in exports[:-1]] == [""] * (MAX_FILES + 1)


def test_each_browser_waits_with_one_file(bench: Benches) -> None:
    b, page = bench(), Sender(browser=1, priority=1)
    exports = [b.viewer.enqueue(Export(lambda _: None), page) for _ in range(4)]
    other = b.viewer.enqueue(Export(lambda _: None), Sender(browser=2, priority=1))
    b.turn()
    for late in exports[2:]:
        assert str(late.exception(timeout=0)) == "Too many files at once. Try again later."
    b.until_done(other)
    assert [each.result(timeout=0) for each in exports[:2]] == ["", ""]


def test_files_of_higher_roles_go_first(bench: Benches) -> None:
    b = bench()
    order: list[int] = []
    waiting = [
        b.viewer.enqueue(
            Export(lambda _, browser=browser: order.append(browser)), Sender(browser, 0, priority)
        )
        for browser, priority in ((1, 1), (2, 1), (3, 1), (4, 2), (5, 3), (6, 3))
    ]
    for each in waiting:
        b.until_done(each)
    assert order == [1, 5, 6, 4, 2, 3]  # the first began before the others were known


def test_a_lower_role_leaves_room_in_the_queue(bench: Benches) -> None:
    b = bench()
    refusals: list[int] = []
    for priority in (1, 2, 3):
        pages = [Sender(browser, 0, priority) for browser in range(MAX_REQUESTS)]
        answers = [b.viewer.enqueue(Refresh(), page) for page in pages]
        refusals.append(sum(answer.done() for answer in answers))
    assert refusals == [
        MAX_REQUESTS - MAX_REQUESTS // 3,
        MAX_REQUESTS - MAX_REQUESTS // 3,
        MAX_REQUESTS - MAX_REQUESTS // 3 - 1,
    ]


def test_the_text_of_a_file_from_elsewhere_is_shown_and_counts_as_not_saved(
    folder: Path, bench: Benches
) -> None:
    b = bench()
    state = do(b, Load("displays:\n- {type: Axes, name: Up}\n", "up.yaml"))
    assert (names(state), state.file.path, state.file.is_changed) == (["Up"], "", True)
    rviz = "Visualization Manager: {Displays: [{Class: rviz_default_plugins/Axes, Name: R}]}"
    assert names(do(b, Load(rviz, "x.rviz"))) == ["R"]
    assert not list(folder.iterdir())
    large = "version: 1\n" + "# comment\n" * (2 << 17)
    assert b.refusal(Load(large, "l.yaml")).endswith("it is larger than 2 MB.")


def test_saving_to_a_missing_folder_is_refused(folder: Path, bench: Benches) -> None:
    refusal = bench(Axes(name="A")).refusal(Save("nowhere/lab.yaml"))
    assert "No such file or directory" in refusal


def test_another_file_is_replaced_only_if_that_was_said(folder: Path, bench: Benches) -> None:
    (folder / "b.yaml").write_text("of somebody else")
    b = bench(Axes(name="A"))
    do(b, Save("a.yaml", replace=False))
    do(b, Save("a.yaml", replace=False))  # its own
    refusal = b.refusal(Save("b.yaml", replace=False))
    assert refusal == "b.yaml exists already. Choose another name."
    assert (folder / "b.yaml").read_text() == "of somebody else"
    do(b, Save("b.yaml"))
    assert load(folder / "b.yaml").displays


def test_the_config_files_of_the_folder_are_on_offer(folder: Path, bench: Benches) -> None:
    for name in ("b.rviz", "a.yml", "notes.txt"):
        (folder / name).write_text("")
    b = bench()
    assert offers(b, "a.yml", "b.rviz")
    do(b, Save("c.yaml"))
    assert offers(b, "a.yml", "b.rviz", "c.yaml")


def test_the_last_session_is_kept_in_a_file_of_its_own(tmp_path: Path, bench: Benches) -> None:
    path = tmp_path / "deep" / "last.yaml"
    b = bench(Axes(name="A"), autosave=path)
    do(b, SetProperty("display1", "length", 2.5))
    b.viewer.close()
    [axes] = load(path).displays
    assert isinstance(axes, Axes)
    assert axes.length == 2.5


def test_a_session_keeps_the_list_of_writable_names(tmp_path: Path, bench: Benches) -> None:
    b = bench(publish=None, autosave=tmp_path / "last.yaml")
    do(b, SetToolProperty("2D Goal Pose", "topic.name", "/cmd_vel_raw"))
    b.viewer.close()
    remaining = load(tmp_path / "last.yaml")
    assert any(getattr(tool, "topic", Topic()).name == "/cmd_vel_raw" for tool in remaining.tools)
    assert remaining.settings.publish is not None
    assert "/goal_pose" in remaining.settings.publish
    assert "/cmd_vel_raw" not in remaining.settings.publish


@pytest.mark.skipif(os.geteuid() == 0 and not Path("/dev/full").exists(), reason="no /dev/full")
def test_a_session_that_cannot_be_kept_is_logged(
    bench: Benches, caplog: pytest.LogCaptureFixture
) -> None:
    bench(Axes(name="A"), autosave=Path("/dev/null/last.yaml")).viewer.close()
    assert "The session is not saved" in caplog.text


def test_a_config_is_handed_out_as_text(folder: Path, bench: Benches) -> None:
    b, texts = bench(Axes(name="A")), list[str]()
    do(b, Export(texts.append))
    do(b, Export(texts.append, "a.rviz"))
    assert [type(d) for d in parse(texts[0], "a.yaml").displays] == [Axes]
    assert "Class: rviz_default_plugins/Axes" in texts[1]


def test_an_exported_rviz_file_names_its_unsupported_parts(bench: Benches) -> None:
    b = bench(Axes(name="A"), Text(name="B"))
    answers = {n: b.viewer.enqueue(Export(lambda _: None, n)) for n in ("a.yaml", "a.rviz")}
    b.until_done(answers["a.rviz"])
    assert answers["a.yaml"].result() == ""
    assert answers["a.rviz"].result() == (
        "Settings: publish: not in RViz's format, so it is left out. "
        "B: Text: skipped, because RViz has no such display."
    )


# The list


def test_a_copy_follows_its_original_with_a_unique_name(bench: Benches) -> None:
    b = bench(Axes(name="A", length=3.0), Axes(name="B"))
    assert names(do(b, DuplicateDisplay("display1"))) == ["A", "A 2", "B"]
    state = do(b, DuplicateDisplay("display1"))
    assert names(state) == ["A", "A 3", "A 2", "B"]
    copy = state.rows[1].display
    assert isinstance(copy, Axes)
    assert copy.length == 3.0
    do(b, SetProperty("display1", "length", 1.0))
    assert copy.length == 3.0


def test_a_group_is_copied_with_all_that_is_in_it(bench: Benches) -> None:
    unreadable = Unreadable({"type": "Gone", "list": [1]}, "displays[0]: no such type")
    group = Branch(
        DisplayGroup(name="G"), [Axes(name="A"), Branch(DisplayGroup(name="H"), [unreadable])]
    )
    b = bench(group, Axes(name="B"))
    state = do(b, DuplicateDisplay("display1"))
    assert names(state) == ["G", "  A", "  H", "    Gone", "G 2", "  A", "  H", "    Gone", "B"]


def test_a_reset_display_keeps_its_name_its_switch_and_its_topic(bench: Benches) -> None:
    topic = Topic("/front", reliability="reliable")
    scan = LaserScan(name="Front", enabled=False, topic=topic, size=0.5, decay_time=3.0)
    state = do(bench(scan, DisplayGroup(name="G")), ResetDisplay("display1"))
    row = state.rows[0]
    assert row.display is not None
    assert to_values(row.display) == {
        "name": "Front",
        "enabled": False,
        "topic": "/front",
    }
    assert names(do(bench(DisplayGroup(name="G")), ResetDisplay("display1"))) == ["G"]


def test_displays_are_written_as_a_config_file_has_them(bench: Benches) -> None:
    unreadable = Unreadable({"type": "Gone", "list": [1]}, "displays[0]: no such type")
    group = Branch(DisplayGroup(name="G"), [Axes(name="A", length=3.0), unreadable])
    b = bench(group, Axes(name="B"), Grid(name="Grid"))
    yaml = b.ask(WriteDisplays(("display2", "display5", "display1", "gone")))
    assert yaml == (
        "- type: Group\n  name: G\n  displays:\n  - {type: Axes, length: 3.0, name: A}\n"
        "  - type: Gone\n    list: [1]\n- {type: Grid}\n"
    )


def test_no_more_displays_are_added_than_a_config_may_have(bench: Benches) -> None:
    b = bench(Branch(DisplayGroup(name="G"), [Axes(name=f"A{i}") for i in range(299)]))
    commands = [DuplicateDisplay("display1"), *[AddDisplay("Axes")] * 201]
    answers = [b.viewer.enqueue(command) for command in commands]
    state = do(b, Refresh())
    refusal = str(answers[-1].exception(0))
    assert refusal == "Not added: the limit is 500 displays. Remove some first."
    assert len(state.rows) == 500
    assert "G 2" not in names(state)


def test_displays_are_moved_within_the_list_and_into_and_out_of_groups(bench: Benches) -> None:
    b = bench(Branch(DisplayGroup(name="G"), [Axes(name="A")]), Axes(name="B"), Axes(name="C"))
    g, a, first, c = (row.id for row in b.states[-1].rows)
    assert names(do(b, MoveDisplay(c, before=first))) == ["G", "  A", "C", "B"]
    assert names(do(b, MoveDisplay(first, g, before=a))) == ["G", "  B", "  A", "C"]
    assert names(do(b, MoveDisplay(g))) == ["C", "G", "  B", "  A"]
    assert names(do(b, MoveDisplay(a))) == ["C", "G", "  B", "A"]
    assert names(do(b, MoveDisplay(a, g))) == ["C", "G", "  B", "  A"]


def test_a_group_is_not_moved_into_itself(bench: Benches) -> None:
    b = bench(Branch(DisplayGroup(name="G"), [Branch(DisplayGroup(name="H"), [Axes(name="A")])]))
    g, h, _ = (row.id for row in b.states[-1].rows)
    before = names(b.states[-1])
    for target in (g, h):
        assert names(do(b, MoveDisplay(g, target))) == before
    assert names(do(b, MoveDisplay("gone", g))) == before


def test_a_display_that_is_moved_into_a_group_that_is_off_is_hidden(bench: Benches) -> None:
    b = bench(DisplayGroup(name="Off", enabled=False), Axes(name="A"))
    b.transform("map", "base", 0, static=True)
    b.turn()
    assert list(b.scene.visible())
    do(b, MoveDisplay("display2", "display1"))
    assert not list(b.scene.visible())


# Settings and answers


def test_background_and_frame_rate_are_set(bench: Benches) -> None:
    b = bench()
    settings = do(b, SetBackground((1, 2, 3))).settings
    assert (settings.background, b.scene.background) == ((1, 2, 3), (1, 2, 3))
    assert do(b, SetFrameRate(10.0)).settings.frame_rate == 10.0


@pytest.mark.parametrize(
    ("command", "sentence"),
    [
        (SetFrameRate(0.0), "Not changed: frame_rate: expected >= 1, got 0."),
        (SetProperty("display1", "length", -1.0), "Not changed: length: expected > 0, got -1."),
        (SetProperty("display1", "name", 5), "Not changed: name: expected text, got 5."),
        (SetProperty("display2", "enabled", 5), "Not changed: enabled: expected true or false"),
        (
            SetProperty("display3", "topic.reliability", "maybe"),
            "Not changed: topic.reliability: expected auto, reliable or best_effort, got `maybe`.",
        ),
        (
            AddDisplay("Axes", {"length": -1, "lenth": 1, "radius": "x"}),
            "Not added: length: expected > 0, got -1. lenth: unknown key, did you mean `length`? "
            "radius: expected a number, got `x`.",
        ),
        (SetProperty("display1", "lenth", 1.0), "Not changed: Axes has no property 'lenth'."),
        (AddDisplay("Axis"), "Unknown display type `Axis`: did you mean `Axes`?"),
    ],
)
def test_a_refused_command_changes_nothing(
    bench: Benches,
    command: Command,
    sentence: str,
    caplog: pytest.LogCaptureFixture,
) -> None:
    b = bench(Axes(name="A"), DisplayGroup(name="G"), PathDisplay(name="P"))
    before = b.viewer.config()
    assert b.refusal(command).startswith(sentence)
    assert not caplog.records  # whoever asked is told, and nobody twice
    assert document(b.viewer.config()) == document(before)


def test_commands_after_the_end_are_refused(bench: Benches) -> None:
    b = bench()
    waiting = b.viewer.enqueue(SetFrameRate(10.0))
    b.viewer.close()
    for future in (waiting, b.viewer.enqueue(SetFrameRate(20.0))):
        assert str(future.exception(timeout=0)) == "The viewer has ended."


def test_a_cancelled_command_is_not_carried_out(bench: Benches) -> None:
    b = bench()
    assert b.viewer.enqueue(SetFrameRate(10.0)).cancel()
    b.turn()
    assert b.viewer.settings.frame_rate == 60.0


@pytest.mark.parametrize(
    "path", ["../a.yaml", "/etc/hosts", "sub/a.yaml", ".", "..", ".yaml", "a.sh", "a", "./a.yaml"]
)
def test_a_page_stays_in_the_folder_of_the_config(bench: Benches, folder: Path, path: str) -> None:
    (folder / "sub").mkdir()
    b = bench(Axes(name="A"))
    for command in (Save(path), Open(path)):
        answer = b.viewer.enqueue(command, Sender(browser=1))
        b.until_done(answer)
        assert "Pages open and save config files in" in str(answer.exception())
    assert [each.name for each in folder.rglob("*")] == ["sub"]


BIDI = "\u202e"
INVISIBLE = "The name contains line breaks or other invisible characters. Remove them."
DASH = "The name begins with a dash, which programs take for an option. Remove it."


@pytest.mark.parametrize(
    ("name", "sentence"),
    [
        ("a\nb.yaml", INVISIBLE),
        (f"a{BIDI}b.yaml", INVISIBLE),
        ("-rf.yaml", DASH),
        (f"{'x' * 300}.yaml", f"{'x' * 40}… is not a file name: it is too long."),
        (f"{'é' * 130}.yaml", f"{'é' * 40}… is not a file name: it is too long."),
        (f"{'x' * 240}.yaml", "The name has 245 characters; the limit is 200."),
    ],
)
def test_a_page_gives_no_file_a_name_that_deceives(
    bench: Benches,
    folder: Path,
    name: str,
    sentence: str,
    caplog: pytest.LogCaptureFixture,
) -> None:
    b = bench(Axes(name="A"))
    saving = b.viewer.enqueue(Save(name), Sender(browser=1))
    b.until_done(saving)
    assert str(saving.exception()) == sentence
    opening = b.viewer.enqueue(Open(name), Sender(browser=1))
    b.until_done(opening)
    assert opening.exception() is not None
    assert not caplog.records
    assert not [*folder.iterdir()]


@pytest.mark.parametrize(
    ("command", "sentence"),
    [
        (SaveView("a\nb", view=Orbit()), INVISIBLE),
        (SaveView(BIDI, view=Orbit()), INVISIBLE),
        (SaveView(" ", view=Orbit()), "The name is empty. Enter one."),
        (SaveImage(name="-a.png"), DASH),
        (SaveImage(name="a\nb.png"), INVISIBLE),
    ],
)
def test_a_view_or_picture_has_no_name_that_deceives(
    bench: Benches, command: Command, sentence: str
) -> None:
    assert bench().refusal(command) == sentence


def test_names_of_displays_and_of_files_from_elsewhere_are_made_readable(bench: Benches) -> None:
    b = bench()
    b.do(AddDisplay("Grid", {"name": f"a\nb{BIDI}c\ud800"}))
    assert names(b.states[-1]) == ["a b c "]
    b.do(SetProperty("display1", "name", f"{BIDI}d"))
    assert names(b.states[-1]) == [" d"]
    loaded = b.viewer.enqueue(Load("version: 1\n", f"a\n{BIDI}b.yaml"))
    b.until_done(loaded)
    assert loaded.result() == "Opened a  b.yaml (not yet saved on this machine)."
    long = b.viewer.enqueue(Load("version: 1\n", f"{'n' * 40_000}.yaml"))
    b.until_done(long)
    assert long.result() == f"Opened {'n' * 195}.yaml (not yet saved on this machine)."


@pytest.mark.parametrize(
    "text", ['version: "\\ud800"', 'tools: [{type: GoalPose, name: "\\ud800"}]', '"\\udfff": 1']
)
@pytest.mark.parametrize("suffix", ["yaml", "rviz"])
def test_a_config_with_half_a_letter_is_refused(bench: Benches, text: str, suffix: str) -> None:
    answer = bench().refusal(Load(text, f"x.{suffix}"))
    half = "a text contains half of a surrogate pair, such as \\ud800. Remove it."
    assert answer == f"x.{suffix}:1: {half}"


def test_a_page_follows_no_link_out_of_the_folder_and_opens_no_device(
    bench: Benches, folder: Path, tmp_path_factory: pytest.TempPathFactory
) -> None:
    elsewhere = tmp_path_factory.mktemp("elsewhere") / "secret.yaml"
    elsewhere.write_text("version: 1\n")
    (folder / "out.yaml").symlink_to(elsewhere)
    (folder / "loop.yaml").symlink_to(folder / "loop.yaml")
    (folder / "inside.yaml").write_text("version: 1\n")
    (folder / "in.yaml").symlink_to(folder / "inside.yaml")
    os.mkfifo(folder / "fifo.yaml")
    b, page = bench(Axes(name="A")), Sender(browser=1)

    def answer(command: Command) -> str:
        done = b.viewer.enqueue(command, page)
        b.until_done(done)
        return str(done.exception() or done.result())

    for make in (Save, Open):
        assert "out.yaml is a link to another folder." in answer(make("out.yaml"))
        assert "is not a regular file" in answer(make("fifo.yaml"))
        assert answer(make("loop.yaml")).endswith(".")
        assert answer(make("in.yaml")).startswith(("Saved", "Opened"))
    assert elsewhere.read_text() == "version: 1\n"

"""The figures of the README are those of the benchmarks."""

from side_by_side.report import BENCHMARKS, README, replaced, summary


def test_the_figures_of_the_readme_follow_from_the_table_of_the_benchmarks() -> None:
    text = README.read_text()
    assert text == replaced(text, summary(BENCHMARKS.read_text()))

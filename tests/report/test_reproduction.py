"""The report of `mmsim reproduce` has the counterparts of the thesis's figures, its table, and every experiment to be replayed.

Law: figures 5.2 to 5.44 and Table 5.2 are there, every experiment can be chosen and has plots with data, in at most 15 MB and without a
word on the console. Reference: the numbers of the thesis's figures and of its Table 5.2. No tolerance.
"""

from collections.abc import Iterator
from pathlib import Path

import pytest
from page import Report
from playwright.sync_api import Browser


@pytest.fixture
def reproduction(browsers: dict[str, Browser], folder: Path) -> Iterator[Report]:
    """The report of a reproduction."""
    with Report(browsers["none"], folder / "reproduction" / "report.html") as report:
        yield report


def test_all_figures_and_the_table_are_there(reproduction: Report, folder: Path) -> None:
    assert (folder / "reproduction" / "report.html").stat().st_size <= 15_000_000
    drawn = reproduction.page.evaluate("""() => [...document.querySelectorAll('.picture')]
        .filter((one) => one.querySelector('svg polyline') && one.getBoundingClientRect().height > 100).map((one) => one.id)""")
    assert {f"figure-5.{number}" for number in range(2, 45)} <= set(drawn)
    table = reproduction.page.locator("#table-5-2").inner_text()
    for number in ("10.98", "7.557", "47.31 %", "31.16 %"):
        assert number in table


def test_every_experiment_is_replayed(reproduction: Report) -> None:
    select = reproduction.page.locator("#group")
    experiments = select.locator("option").all_inner_texts()
    assert len(experiments) == 15
    tips = set()
    for experiment in experiments:
        select.select_option(label=experiment)
        reproduction.move("End")
        tips.add(tuple(reproduction.tip()))
        points = reproduction.points()
        assert len(points) >= 5, experiment
        assert min(points) >= 2, experiment
    assert len(tips) >= 10, "the robots end at different places"
    assert reproduction.messages == []

"""Debian's Chromium, without a window, and the reports that `cargo xtask report` made."""

import os
from collections.abc import Iterator
from pathlib import Path

import pytest
from page import Report
from playwright.sync_api import Browser, sync_playwright

FLAGS = {
    # WebGL is there, computed by the processor.
    "software": [],
    # There is none.
    "none": ["--disable-gpu", "--disable-3d-apis"],
}


@pytest.fixture(scope="session")
def folder() -> Path:
    """Where the reports are."""
    return Path(os.environ["REPORT_FOLDER"])


@pytest.fixture(scope="session")
def browsers() -> Iterator[dict[str, Browser]]:
    """Browsers with and without WebGL."""
    with sync_playwright() as playwright:
        started = {
            name: playwright.chromium.launch(
                executable_path=os.environ.get("CHROMIUM", "/usr/bin/chromium"), args=["--no-sandbox", *flags]
            )
            for name, flags in FLAGS.items()
        }
        yield started
        for browser in started.values():
            browser.close()


@pytest.fixture(params=sorted(FLAGS))
def compared(request: pytest.FixtureRequest, browsers: dict[str, Browser], folder: Path) -> Iterator[Report]:
    """The report of two runs, in every browser."""
    with Report(browsers[request.param], folder / "compared" / "report.html") as report:
        yield report


@pytest.fixture
def shown(browsers: dict[str, Browser], folder: Path) -> Iterator[Report]:
    """The same where WebGL is there."""
    with Report(browsers["software"], folder / "compared" / "report.html") as report:
        yield report

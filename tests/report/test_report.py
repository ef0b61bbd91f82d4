"""The report of two runs does what it shows, in a browser with WebGL and in one without.

Laws: it says nothing on the console and fetches nothing; the slider moves the robot, and the robot that is drawn has its tip where the
log has it; every plot has a curve; all of it works by keyboard; what a log says stays text. Why: a report is sent to others.
Reference: the page's own numbers, from the log on one side and from the drawn robot's kinematics on the other. Tolerance: 2 mm, as the
page prints millimetres and keeps signals to a fraction of what they do within two seconds.
"""

import math
import re
from pathlib import Path

from page import Report
from playwright.sync_api import Browser, expect


def test_it_is_silent_and_fetches_nothing(compared: Report) -> None:
    compared.move("End")
    compared.page.locator("#theme").select_option("dark")
    compared.settle()
    assert compared.messages == []
    assert [url for url in compared.requests if not url.startswith(("file:", "data:", "blob:"))] == []


def test_the_slider_moves_the_robot(compared: Report) -> None:
    seen = {}
    for key in ("Home", "PageUp", "PageUp", "ArrowRight", "End"):
        compared.move(key)
        tip, logged = compared.tip(), compared.logged_tip()
        assert math.dist(tip, logged) < 2e-3, f"after {key}"
        seen[tuple(tip)] = compared.scene.screenshot()
    assert len(seen) == 5, "five places"
    assert len(set(seen.values())) == 5, "five pictures"


def test_every_plot_has_data(compared: Report) -> None:
    plots = compared.drawn()
    assert len(plots) >= 30
    for plot in plots:
        assert plot["points"] >= 2
        assert plot["colored"] > 50


def test_webgl_draws_the_same_robot(shown: Report) -> None:
    assert shown.scene.get_attribute("data-renderer") == "canvas", "the processor draws a plain canvas quicker"
    shown.page.get_by_role("button", name="WebGL").click()
    shown.settle()
    assert shown.scene.get_attribute("data-renderer") == "webgl"
    pictures = set()
    for key in ("Home", "PageUp", "End"):
        shown.move(key)
        assert math.dist(shown.tip(), shown.logged_tip()) < 2e-3
        pictures.add(shown.scene.screenshot())
    assert len(pictures) == 3, "three pictures"
    # The browser tells of its own software renderer; the page says nothing.
    assert [message for message in shown.messages if "GL Driver Message" not in message] == []
    shown.page.get_by_role("button", name="WebGL").click()
    assert shown.scene.get_attribute("data-renderer") == "canvas"


def test_it_works_by_keyboard(shown: Report) -> None:
    page = shown.page
    play = page.locator("#play")
    play.press("Enter")
    assert play.get_attribute("aria-label") == "Pause"
    expect(shown.scene).to_have_attribute("data-time", re.compile(r"0\.[2-9]|[1-9]\d*\."))
    play.press("Enter")
    assert play.get_attribute("aria-label") == "Play"
    plot = page.locator(".plot").nth(1)
    whole = page.locator("#plot-list").get_attribute("data-window")
    plot.press("+")
    assert page.locator("#plot-list").get_attribute("data-window") != whole
    plot.press("0")
    assert page.locator("#plot-list").get_attribute("data-window") == whole
    before = sum(plot["colored"] for plot in shown.drawn())
    run = page.locator("#toggles button").first
    run.press(" ")
    shown.settle()
    assert run.get_attribute("aria-pressed") == "false"
    assert sum(plot["colored"] for plot in shown.drawn()) < before
    picture = shown.scene.screenshot()
    shown.scene.press("ArrowLeft")
    shown.settle()
    assert shown.scene.screenshot() != picture, "the view turns"
    unnamed = page.evaluate("""() => [...document.querySelectorAll('button, select, input')].filter(
        (one) => !(one.textContent.trim() || one.getAttribute('aria-label') || one.labels?.length)).length""")
    assert unnamed == 0, "every control has a name"


def test_a_drag_zooms_all_plots_and_a_click_moves_the_replay(shown: Report) -> None:
    page = shown.page
    over = page.locator(".plot .u-over").nth(2)
    over.scroll_into_view_if_needed()
    box = over.bounding_box()
    assert box is not None
    height = box["y"] + box["height"] / 2
    whole = page.locator("#plot-list").get_attribute("data-window")
    page.mouse.move(box["x"] + 0.2 * box["width"], height)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.4 * box["width"], height, steps=4)
    page.mouse.up()
    begin, end = (float(word) for word in (page.locator("#plot-list").get_attribute("data-window") or "").split())
    full = float((whole or "").split()[1])
    assert abs(begin - 0.2 * full) < 0.02 * full
    assert abs(end - 0.4 * full) < 0.02 * full
    page.mouse.click(box["x"] + 0.5 * box["width"], height)
    shown.settle()
    assert abs(float(shown.scene.get_attribute("data-time") or "nan") - 0.3 * full) < 0.02 * full


def test_light_dark_narrow_and_paper(browsers: dict[str, Browser], folder: Path) -> None:
    path = folder / "compared" / "report.html"
    papers = set()
    for scheme in ("light", "dark"):
        with Report(browsers["none"], path, color_scheme=scheme) as report:
            assert report.page.locator("html").get_attribute("data-theme") == scheme
            papers.add(report.page.evaluate("getComputedStyle(document.body).backgroundColor"))
            report.page.set_viewport_size({"width": 360, "height": 700})
            report.settle()
            wide = report.page.evaluate("document.documentElement.scrollWidth")
            assert wide <= 360, "nothing sticks out of a telephone"
            pdf = report.page.pdf(format="A4", print_background=True)
            assert pdf.startswith(b"%PDF")
            assert len(pdf) > 100_000, "with the plots"
            report.page.emulate_media(media="print")
            assert not report.page.locator("#transport").is_visible()
            assert report.page.locator(".plot canvas").first.is_visible()
    assert len(papers) == 2, "two papers"


def test_what_a_log_says_stays_text(browsers: dict[str, Browser], folder: Path) -> None:
    with Report(browsers["none"], folder / "hostile" / "report.html") as report:
        assert report.messages == []
        assert report.page.locator("h1").inner_text() == "<script>alert(1)<!--<img src=x onerror=alert(2)>"
        assert report.page.locator("img").count() == 0


def test_it_is_small(folder: Path) -> None:
    # Two runs of 98 s, one of which chatters; the libraries take 650 kB.
    assert (folder / "compared" / "report.html").stat().st_size < 2_500_000

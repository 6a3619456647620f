"""The report in a real browser: it fits a laptop and a phone, and its filters do what they say."""

import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from cobot_lfd.app.report.content import gather
from cobot_lfd.app.report.write import write_report
from tests.test_app_report import all_of, make_run

if TYPE_CHECKING:
    from playwright.sync_api import Browser

pytestmark = [
    pytest.mark.browser,
    pytest.mark.skipif(shutil.which("chromium") is None, reason="Chromium is not installed"),
]

FLAGS = (
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
)

_SMALLEST_TEXT = """Math.min(...[...document.querySelectorAll("body *")]
    .filter(e => !e.closest("svg") && [...e.childNodes].some(n => n.nodeType == 3 && n.textContent.trim()))
    .map(e => parseFloat(getComputedStyle(e).fontSize)))"""

_CUT_TABLES = """[...document.querySelectorAll(".scroll")]
    .filter(e => e.scrollWidth > e.clientWidth).length"""


@pytest.fixture(scope="module")
def browser() -> Iterator["Browser"]:
    sync_api = pytest.importorskip("playwright.sync_api")
    with sync_api.sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=list(FLAGS))
        yield chromium
        chromium.close()


@pytest.fixture(scope="module")
def page_address(tmp_path_factory: pytest.TempPathFactory) -> str:
    folder = make_run(tmp_path_factory.mktemp("browser") / "run")
    folder.carry_out(all_of)
    file: Path = write_report(gather([folder.path]), folder.path / "report.html")
    return file.as_uri()


@pytest.mark.parametrize(("width", "height"), [(1366, 768), (390, 844)])
def test_the_page_fits_and_asks_for_nothing(
    browser: "Browser", page_address: str, width: int, height: int
) -> None:
    page = browser.new_page(viewport={"width": width, "height": height})
    faults: list[str] = []
    asked: list[str] = []
    page.on("pageerror", lambda error: faults.append(str(error)))
    page.on("request", lambda request: asked.append(request.url))
    page.goto(page_address)
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert width < 600 or page.evaluate(_CUT_TABLES) == 0  # on a phone a wide table can be pushed aside
    assert faults == []
    plots = page.locator("svg[role=img]")
    assert plots.count() == 2
    assert plots.first.get_attribute("aria-label") == "Success over noise of the seen position [mm]"
    boxes = [plot.bounding_box() for plot in plots.all()]
    assert all(box is not None and box["width"] > 0.75 * min(width, 600) for box in boxes)
    assert page.evaluate(_SMALLEST_TEXT) >= 12  # [px]
    assert [address for address in asked if not address.startswith("data:")] == [page_address]


def test_filters_leave_what_fits(browser: "Browser", page_address: str) -> None:
    page = browser.new_page()
    page.goto(page_address)
    shown = page.locator("output")
    assert shown.text_content() == "30 of 30 failures"
    page.select_option("[data-filter=contender]", "good")
    assert shown.text_content() == "8 of 30 failures"
    page.select_option("[data-filter=perturbation]", "none")
    assert shown.text_content() == "2 of 30 failures"
    page.fill("[data-search]", "5010")
    assert shown.text_content() == "1 of 30 failures"
    assert page.locator(".card:visible").count() == 1

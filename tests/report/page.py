"""A report as a reader has it: loaded from disk, everything that it says and asks for noted."""

from __future__ import annotations

from pathlib import Path
from types import TracebackType

from playwright.sync_api import Browser, Locator, expect


class Report:
    """A page with the messages, errors and requests that it made."""

    def __init__(self, browser: Browser, path: Path, **options: object) -> None:
        """Open the file."""
        self.context = browser.new_context(viewport={"width": 1280, "height": 900}, **options)
        self.page = self.context.new_page()
        self.messages: list[str] = []
        self.requests: list[str] = []
        self.page.on("console", lambda message: self.messages.append(f"{message.type}: {message.text}"))
        self.page.on("pageerror", lambda error: self.messages.append(str(error)))
        self.page.on("dialog", lambda dialog: (self.messages.append(dialog.message), dialog.dismiss()))
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.goto(path.as_uri())
        expect(self.page.locator("html")).to_have_attribute("data-ready", "true")
        self.settle()

    def __enter__(self) -> Report:
        """Give the page."""
        return self

    def __exit__(self, kind: type | None, error: BaseException | None, trace: TracebackType | None) -> None:
        """Close it."""
        self.context.close()

    def settle(self) -> None:
        """Wait until what was asked for is drawn."""
        self.page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")

    @property
    def scene(self) -> Locator:
        """The scene of the replay."""
        return self.page.locator("#scene")

    def tip(self) -> list[float]:
        """The tip of the first robot by the drawn robot's kinematics."""
        return [float(word) for word in (self.scene.get_attribute("data-tip") or "").split()]

    def logged_tip(self) -> list[float]:
        """The tip of the first run as logged."""
        text = self.page.locator("#readout .card").first.locator("dd").last.inner_text()
        return [float(word) for word in text.removesuffix(" m").split(",")]

    def move(self, key: str) -> None:
        """Press a key on the slider."""
        self.page.locator("#time").press(key)
        self.settle()

    def points(self) -> list[int]:
        """Points of each plot's longest curve."""
        return self.page.locator(".plot").evaluate_all("(all) => all.map((one) => Number(one.dataset.points))")

    def drawn(self) -> list[dict[str, float]]:
        """Points of each plot, and pixels of its canvas that are not empty."""
        return self.page.evaluate("""() => [...document.querySelectorAll('.plot')].map((plot) => {
            const canvas = plot.querySelector('canvas');
            const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
            let colored = 0;
            for (let i = 0; i < data.length; i += 4) {
              const [r, g, b, a] = data.subarray(i, i + 4);
              if (a > 128 && Math.max(r, g, b) - Math.min(r, g, b) > 60) colored += 1;
            }
            return { points: Number(plot.dataset.points), colored };
        })""")

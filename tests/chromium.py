"""Chromium without a window, driven by selenium: pages are opened as files, or from a server of this machine alone."""

import base64
import io
import json
import os
import re
import shutil
import time
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import numpy as np

PACKAGES = ("chromium", "chromium-driver")
"""What Debian calls the browser and its driver."""
MISSING = (
    f"pages are not tested in a browser, since Chromium or its driver is missing: apt-get install {' '.join(PACKAGES)}"
)
DESKTOP, PHONE = (1280, 900), (390, 844)
"""Width and height of the visible part of a page [CSS pixels]."""
_ARGUMENTS = (
    *("--headless", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-sync"),
    *("--disable-component-update", "--disable-default-apps", "--disable-extensions", "--force-device-scale-factor=1"),
    *("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--hide-scrollbars"),
    *("--proxy-server=127.0.0.1:9", "--proxy-bypass-list=127.0.0.1"),  # of this machine alone somebody answers
    *("--disable-gpu-compositing", "--disable-gpu-rasterization"),  # of a GPU that is imitated, models alone need one
)
NO_WEBGL = ("--disable-3d-apis",)


def programs() -> tuple[str, str] | None:
    """Return the paths of Chromium and of its driver; None where one of them is not installed."""
    browser, driver = shutil.which("chromium"), shutil.which("chromedriver")
    return (browser, driver) if browser and driver else None


class Browser:
    """A Chromium that is running."""

    def __init__(self, driver: Any) -> None:
        self.driver = driver

    def open(self, page: Path | str, size: tuple[int, int] = DESKTOP) -> None:
        """Open a page, a file or an address, in a viewport of a size; what the browser said before is forgotten."""
        self.leave()
        width, height = size
        metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": size == PHONE}
        self.command("Emulation.setDeviceMetricsOverride", **metrics)
        self.command("Emulation.setTouchEmulationEnabled", enabled=size == PHONE)
        self.messages(), self.requests()
        self.driver.get(page if isinstance(page, str) else page.as_uri())

    def leave(self) -> None:
        """Leave the page, which asks for nothing any more: a server that has ended is asked for again and again."""
        self.driver.get("about:blank")

    def command(self, name: str, **parameters: Any) -> dict[str, Any]:
        """Give a command of the DevTools protocol."""
        found: dict[str, Any] = self.driver.execute_cdp_cmd(name, parameters)
        return found

    def run(self, script: str, *arguments: Any) -> Any:
        """Run the body of a function in the page and return its result."""
        return self.driver.execute_script(script, *arguments)

    def wait(self, script: str, seconds: float = 60.0) -> Any:
        """Wait until an expression of the page is true, and return it; what takes long is asked for less often."""
        asked = time.monotonic()
        while not (found := self.run(f"return {script}")):
            waited = time.monotonic() - asked
            assert waited < seconds, f"in {seconds} s it was never true: {script}"
            time.sleep(0.02 + 0.1 * min(waited, 2.0))
        return found

    def element(self, selector: str) -> Any:
        """Return the first element of a CSS selector."""
        return self.driver.find_element("css selector", selector)

    def keys(self, selector: str, keys: str) -> None:
        """Press keys in the first element of a CSS selector; find it once more where the page has drawn it anew."""
        from selenium.common.exceptions import StaleElementReferenceException

        for _ in range(5):
            with suppress(StaleElementReferenceException):
                self.element(selector).send_keys(keys)
                return
        raise AssertionError(f"{selector} is drawn anew again and again")

    def elements(self, selector: str) -> list[Any]:
        """Return all elements of a CSS selector."""
        return list(self.driver.find_elements("css selector", selector))

    def messages(self) -> list[str]:
        """Return what the console has shown since this was last asked, but for the speed of an imitated GPU."""
        told = [entry["message"] for entry in self.driver.get_log("browser")]
        return [message for message in told if "GL Driver Message (OpenGL, Performance" not in message]

    def requests(self) -> list[str]:
        """Return the addresses that the page has asked for since this was last asked, but for data in the page."""
        events = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        asked = [e["params"]["request"]["url"] for e in events if e["method"] == "Network.requestWillBeSent"]
        return [address for address in asked if not address.startswith("data:")]

    def pdf(self) -> bytes:
        """Print the page on A4."""
        size = {"paperWidth": 210.0 / 25.4, "paperHeight": 297.0 / 25.4}
        return base64.b64decode(self.command("Page.printToPDF", printBackground=True, **size)["data"])


def pixels(element: Any) -> np.ndarray:
    """Return what an element looks like, (rows, columns, 3)."""
    from PIL import Image

    with Image.open(io.BytesIO(element.screenshot_as_png)) as image:
        return np.asarray(image.convert("RGB"), dtype=int)


def changed(before: np.ndarray, after: np.ndarray) -> float:
    """Return the share of pixels that differ visibly."""
    return float(np.mean(np.abs(before - after).max(axis=2) > 24))


def sheets(pdf: bytes) -> int:
    """Return the number of pages of a PDF that Chromium wrote."""
    return len(re.findall(rb"/Type\s*/Page\b", pdf))


def texts(pdf: bytes) -> list[str]:
    """Return what stands on each page of a PDF that Chromium wrote, in the order in which it is drawn."""
    found = {int(number): body for number, body in re.findall(rb"(?s)\n(\d+) 0 obj\n(.*?)\nendobj", pdf)}

    def stream(number: int) -> str:
        head, _, content = found[number].partition(b"stream\n")
        return (zlib.decompressobj().decompress(content) if b"FlateDecode" in head else content).decode("latin-1")

    def signs(font: int) -> dict[int, str]:
        cmap = stream(int(re.search(rb"/ToUnicode (\d+)", found[font])[1]))
        one = {int(glyph, 16): chr(int(sign, 16)) for glyph, sign in re.findall(r"^<(\w+)> <(\w+)>$", cmap, re.M)}
        for first, last, sign in re.findall(r"^<(\w+)> <(\w+)> <(\w+)>$", cmap, re.M):
            one |= {k: chr(int(sign, 16) + k - int(first, 16)) for k in range(int(first, 16), int(last, 16) + 1)}
        return one

    def page(body: bytes) -> str:
        fonts = {name.decode(): signs(int(number)) for name, number in re.findall(rb"/(F\d+) (\d+) 0 R", body)}
        told, font = "", dict[int, str]()
        content = stream(int(re.search(rb"/Contents (\d+)", body)[1]))
        for name, glyphs in re.findall(r"/(F\d+) [\d.]+ Tf|<(\w+)> Tj", content):
            font = fonts[name] if name else font
            told += "".join(font.get(int(glyphs[k : k + 4], 16), "?") for k in range(0, len(glyphs), 4))
        return told

    return [page(body) for body in found.values() if re.search(rb"/Type\s*/Page\b", body)]


@contextmanager
def chromium(profile: Path, *arguments: str) -> Iterator[Browser]:
    """Start Chromium with an empty profile; it ends with the block."""
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service

    found = programs()
    assert found is not None
    options = webdriver.ChromeOptions()
    options.binary_location, driver_path = found
    root = ("--no-sandbox",) if os.name == "posix" and os.geteuid() == 0 else ()
    for argument in (*_ARGUMENTS, *root, f"--user-data-dir={profile}", *arguments):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(options=options, service=Service(driver_path))
    try:
        yield Browser(driver)
    finally:
        driver.quit()

"""What the owl wing's report weighs, and how soon a reader can turn its models; writes benchmarks/results/page.json.

python benchmarks/page.py [--case owl-wing-static] [--fidelity solid] [--repeats 5] [--report FILE]

The page is opened as a file by a Chromium that has just started, without a window and without a graphics card:
swiftshader draws on the processor. The clock is the page's own, from the beginning of its navigation until its models
near the visible part are drawn: at that of the linkage and at that of the first link. The first opening is left out,
since it reads the browser itself from the disk.
"""

import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

from record import save

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests"))

from chromium import MISSING, Browser, chromium, programs  # noqa: E402

WATCH = """
new MutationObserver((_, watch) => {
  if (!document.documentElement?.dataset.turnable) return;
  window.turnableAfter = performance.now();
  watch.disconnect();
}).observe(document, { attributes: true, attributeFilter: ["data-turnable"], subtree: true });
"""


def written(case: str, fidelity: str, folder: Path) -> Path:
    """Check a case and return its report."""
    command = [sys.executable, "-m", "alula", "check", case, "--fresh", "--fidelity", fidelity, "--output", str(folder)]
    ended = subprocess.run(command, cwd=ROOT, env=os.environ | {"PYTHONPATH": str(ROOT)}, check=False)
    if ended.returncode not in (0, 1, 3):
        raise SystemExit(f"the check ended with status {ended.returncode}")
    return folder / "report.html"


def weights(page: Path) -> dict[str, int]:
    """Bytes of a page and of what it consists of."""
    text = page.read_text(encoding="utf-8")
    blocks = {
        "pictures": r"data:image/[^\"]*",
        "models": r"<script type=\"application/json\".*?</script>",
        "script": r"<script>.*?</script>",
    }
    parts = {name: sum(len(m.encode()) for m in re.findall(found, text, re.S)) for name, found in blocks.items()}
    whole = page.stat().st_size
    return {"page": whole, **parts, "text": whole - sum(parts.values())}


def opened(page: Path, place: str) -> float:
    """Milliseconds until the models near a place of the page can be turned, in a browser that was just started."""
    with tempfile.TemporaryDirectory() as profile, chromium(Path(profile)) as browser:
        browser.command("Page.addScriptToEvaluateOnNewDocument", source=WATCH)
        browser.driver.get(page.as_uri() + place)
        after = float(browser.wait("window.turnableAfter"))
        state = browser.run("return document.documentElement.dataset.turnable")
        if state != "ready" or not drawn(browser):
            raise SystemExit(f"{page.name}{place}: no model is drawn ({state})")
    return after


def drawn(browser: Browser) -> bool:
    """Return whether some model of the page can be turned."""
    return bool(browser.elements('figure[data-turnable="ready"] canvas'))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--case", default="owl-wing-static")
    parser.add_argument("--fidelity", default="solid")
    parser.add_argument("--repeats", type=int, default=5)
    parser.add_argument("--report", type=Path, help="a report that is there already")
    options = parser.parse_args()
    if programs() is None:
        raise SystemExit(MISSING)
    with tempfile.TemporaryDirectory() as folder:
        page = options.report or written(options.case, options.fidelity, Path(folder) / "out")
        record: dict[str, Any] = {"case": options.case, "fidelity": options.fidelity, "bytes": weights(page)}
        first = re.search(r'<article id="(link-[^"]+)"', page.read_text(encoding="utf-8"))
        record["opened"] = []
        for where, place in (("at the linkage", "#model"), ("at the first link", f"#{first[1]}" if first else "")):
            times = [opened(page, place) for _ in range(options.repeats + 1)][1:]
            record["opened"].append({"where": where, "ms": [round(ms, 1) for ms in times]})
            print(f"turnable {where}: {statistics.median(times):.0f} ms", flush=True)
    print(json.dumps(record["bytes"]), flush=True)
    save("page", record)


if __name__ == "__main__":
    main()

"""The check by solids in the background: how far each link is, its model, the verdict; stopped at once; kept."""

import asyncio
import json
import os
import sys
import time
from pathlib import Path

import arm_case
import pytest

from alula.fea.check.run import check_case
from alula.geometry.base.errors import CaseError
from alula.geometry.keeping.kept import keeping
from alula.reports.turnable.link import link_model
from alula.reports.workbench.live import solids
from alula.reports.workbench.live.answers import case_of
from alula.reports.workbench.live.solids import Solids
from alula.reports.workbench.live.verdicts import verdict_of

TEXT = arm_case.ARM.format(part=arm_case.BAR, fillet=1.0, force=-1.0, minimum=3.0, thickness=3.0)
TEXT += "[solid]\nmesh_size = 2.0\n"


class Page:
    """What is told, and how to wait for it."""

    def __init__(self):
        self.told, self.news = [], asyncio.Event()

    def tell(self, event, data):
        self.told.append((event, json.loads(json.dumps(data, allow_nan=False))))
        self.news.set()

    async def until(self, test):
        while not (found := [data for event, data in self.told if event == "solids" and test(data)]):
            self.news.clear()
            await asyncio.wait_for(self.news.wait(), 60)
        return found[-1]

    @property
    def verdicts(self):
        return [data for event, data in self.told if event == "verdict"]


def story(tell):
    """Run a story of a page and its solids."""

    async def whole():
        page = Page()
        answering = Solids(page.tell, Path())
        try:
            await tell(page, answering)
        finally:
            await answering.close()

    asyncio.run(whole())


def states(page, link):
    found = [data["links"][link]["state"] for event, data in page.told if event == "solids" and link in data["links"]]
    return [state for state, before in zip(found, ["", *found], strict=False) if state != before]


def test_links_models_and_verdict_are_those_of_the_check(tmp_path, monkeypatch):
    """What ``alula check`` has solved is found, and told as it is there."""
    monkeypatch.setenv("ALULA_CACHE", str(tmp_path))
    with keeping():
        result = check_case(case_of(TEXT, "arm.toml"), name="arm.toml", fidelity="solid", threads=1)
    expected = json.loads(json.dumps(verdict_of(result, "solids", 0.0)))
    model = link_model("arm", result.load_cases["tip"].links["arm"], result.case.links["arm"].points)

    async def told(page, answering):
        answering.start(3, TEXT, "arm.toml")
        end = await page.until(lambda data: data["state"] != "running")
        assert (end["state"], end["revision"]) == ("done", 3)
        assert end["links"]["arm"]["model"]
        assert states(page, "arm") == ["waiting", "solving", "kept"]
        assert answering.model("arm") == json.loads(json.dumps(model))
        [verdict] = page.verdicts
        assert (verdict.pop("revision"), verdict | {"ms": 0.0}) == (3, expected | {"ms": 0.0})

    story(told)


CHILD = """
import json, os, subprocess, sys, time
request = json.loads(sys.stdin.readline())
def tell(event, **data):
    print(json.dumps({"event": event, "data": data}), flush=True)
tell("links", names=["one", "two"])
tell("link", name="one", state="solving")
"""
WHOLE = """
tell("link", name="one", state="done")
tell("link", name="two", state="kept")
time.sleep(60)
"""


def test_what_is_done_after_all_links_is_said(monkeypatch):
    child(monkeypatch, WHOLE)

    async def told(page, answering):
        answering.start(1, TEXT, "arm.toml")
        now = await page.until(lambda data: {"done", "kept"} == {one["state"] for one in data["links"].values()})
        said = "Stresses of 2 of 2 links are solved. The linkage as a whole is being judged ..."
        assert (now["state"], now["sentence"]) == ("running", said)

    story(told)


ENDS = {
    "failed": 'tell("failed", sentence="pose: it cannot be assembled")',
    "crashed": 'sys.exit("Fatal: out of luck")',
    "killed": "os.kill(os.getpid(), 9)",
    "nonsense": 'print("no JSON", flush=True); time.sleep(60)',
    "mistaken": 'tell("notice", sentence="MemoryError: no room"); print(json.dumps({"done": True}), flush=True)',
}


def child(monkeypatch, rest):
    monkeypatch.setattr(solids, "module_command", lambda *_: [sys.executable, "-c", CHILD + rest])


@pytest.mark.parametrize(
    ("end", "sentence"),
    [
        ("failed", "pose: it cannot be assembled"),
        ("crashed", "ended by itself (status 1: Fatal: out of luck)"),
        ("killed", "ended by itself (status -9: it left no message)"),
        ("nonsense", "could not be followed"),
        ("mistaken", "MemoryError: no room"),
    ],
)
def test_a_check_that_fails_says_why(monkeypatch, end, sentence):
    child(monkeypatch, ENDS[end])

    async def told(page, answering):
        answering.start(1, TEXT, "arm.toml")
        found = await page.until(lambda data: data["state"] != "running")
        assert found["state"] == "failed"
        assert sentence in found["sentence"]
        assert {link["state"] for link in found["links"].values()} == {"waiting"}
        with pytest.raises(CaseError, match=r"'one': there is no solid"):
            answering.model("one")

    story(told)


STARTS = """
beside = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"])
tell("link", name="one", state="done", model='{"number": 1}')
tell("sentence", sentence=f"{os.getpid()} {beside.pid}")
time.sleep(60)
"""


def alive(process):
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    return Path(f"/proc/{process}/stat").read_text().rsplit(")")[1].split()[0] != "Z"


@pytest.mark.skipif(not sys.platform.startswith("linux"), reason="reads the states of processes from /proc")
@pytest.mark.parametrize("by", ["stop", "start", "close"])
def test_it_is_stopped_at_once_with_all_that_it_started(monkeypatch, by):
    child(monkeypatch, STARTS)

    async def told(page, answering):
        answering.start(1, TEXT, "arm.toml")
        at_work = await page.until(lambda data: data["sentence"][-1].isdigit())
        processes = [int(number) for number in at_work["sentence"].split()[-2:]]
        assert at_work["sentence"].startswith("Stresses of 1 of 2 links are solved. ")
        assert all(map(alive, processes))
        page.told.clear()
        if by == "close":
            await answering.close()
        elif by == "stop":
            answering.stop()
            [(_, data)] = page.told
            assert (data["state"], data["links"]["one"]["state"], data["links"]["two"]["state"]) == (
                "stopped",
                "done",
                "waiting",
            )
            assert answering.model("one") == {"number": 1}
        else:
            answering.start(2, TEXT, "arm.toml")
            again = await page.until(lambda data: data["sentence"][-1].isdigit())
            first, second = (told["links"]["one"]["model"] for told in (at_work, again))
            assert second > first > 0, "the page that shows the model of the older one takes the new one"
            assert {data["revision"] for _, data in page.told} == {2}, "nothing is told of the older one"
        until = time.monotonic() + 10.0
        while any(map(alive, processes)) and time.monotonic() < until:
            await asyncio.sleep(0.01)
        assert not any(map(alive, processes))

    story(told)

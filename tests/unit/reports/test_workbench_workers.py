"""The workbench's processes: the newest text first, older work ends, answers are kept, a process may end by itself."""

import asyncio
import json
import random
import subprocess
import sys
from pathlib import Path

import pytest

from alula.geometry.base.child import environment, module_command
from alula.loads.case.case_file import read_text
from alula.reports.workbench.live import workers
from alula.reports.workbench.live.answers import pose_answer
from alula.reports.workbench.live.verdicts import linear_answer, whole_answer
from alula.reports.workbench.live.workers import Workers

TEXT, NAME = read_text("four-bar")[0], "four-bar"


def turned(angle):
    text = TEXT.replace('angle = "40 deg"', f'angle = "{angle} deg"')
    assert text != TEXT
    return text


def timeless(data):
    return {name: value for name, value in data.items() if name not in ("ms", "revision")}


class Page:
    """What is told, and how to wait for it."""

    def __init__(self):
        self.told, self.news = [], asyncio.Event()

    def tell(self, event, data):
        self.told.append((event, data))
        self.news.set()

    def of(self, event, revision, stage=None):
        return [
            data
            for name, data in self.told
            if name == event and data["revision"] == revision and stage in (None, data.get("stage"))
        ]

    async def until(self, event, revision, stage=None, times=1):
        while len(self.of(event, revision, stage)) < times:
            self.news.clear()
            await asyncio.wait_for(self.news.wait(), 60)
        return self.of(event, revision, stage)[-1]

    async def rest(self, answering):
        while any(line._at_work for line in answering._lines):
            await asyncio.sleep(0.01)


@pytest.fixture(scope="module")
def told():
    """A function that runs a story in the event loop of processes that all stories share: they take long to start."""
    loop, page = asyncio.new_event_loop(), Page()

    async def start():
        return Workers(page.tell, Path("."))

    answering = loop.run_until_complete(start())
    yield lambda story: loop.run_until_complete(story(answering, page))
    loop.run_until_complete(answering.close())
    loop.close()


def test_a_drag_is_answered_newest_first_and_undo_at_once(told):
    async def story(answering, page):
        answering.ask(1, TEXT, NAME)
        await page.until("motion", 1)
        await page.until("verdict", 1, "whole", times=2)
        await page.rest(answering)
        for revision in range(2, 42):
            answering.ask(revision, turned(40 + revision), NAME)
            await asyncio.sleep(0.002)
        last = await page.until("verdict", 41, "whole", times=2)
        assert len({data["revision"] for event, data in page.told if event == "drawn"}) < 40
        assert not any(page.of("verdict", revision, "whole") for revision in range(2, 41))
        assert timeless(last) == timeless(whole_answer(turned(81), NAME))
        assert page.of("drawn", 41)[-1]["forces"] == pose_answer(turned(81), NAME)["forces"]
        asked = len(page.told)
        answering.ask(42, TEXT, NAME)
        assert timeless(await page.until("verdict", 42, "whole")) == timeless(page.of("verdict", 1, "whole")[-1])
        kinds = [event for event, data in page.told[asked:] if data["revision"] == 42]
        assert sorted(kinds) == ["drawn", "motion", "verdict", "verdict"]

    told(story)


def test_what_was_interrupted_leaves_nothing_behind(told):
    """A process that is interrupted at random moments answers as one that never was, to the last bit."""
    chance = random.Random(7)

    async def story(answering, page):
        for revision in range(101, 121):
            answering.ask(revision, turned(40.5 + revision % 20), NAME)
            await page.until("verdict", revision, "linear")
            await asyncio.sleep(chance.uniform(0.0, 0.2))
        assert sum(bool(page.of("verdict", revision, "whole")) for revision in range(101, 121)) < 15
        answering.ask(150, turned(77), NAME)
        found = await page.until("verdict", 150, "whole", times=2)
        assert timeless(found) == timeless(whole_answer(turned(77), NAME))
        assert not [data for event, data in page.told if event == "notice"]

    told(story)


def test_a_problem_is_told_and_the_next_text_is_answered(told):
    async def story(answering, page):
        answering.ask(200, TEXT.replace("schema_version = 1", "schema_version = 0"), NAME)
        assert (await page.until("problem", 200))["sentence"].startswith("schema_version")
        answering.ask(201, TEXT, NAME)
        assert (await page.until("drawn", 201))["problem"] is None

    told(story)


def test_a_process_that_ends_by_itself_is_told_and_started_anew(told):
    async def story(answering, page):
        _, verdicts = answering._lines
        answering.ask(300, turned(49), NAME)
        await page.until("verdict", 300, "linear")
        verdicts._child.kill()
        assert "ended by itself" in (await page.until("notice", 300))["sentence"]
        answering.ask(301, turned(50), NAME)
        assert timeless(await page.until("verdict", 301, "linear")) == timeless(linear_answer(turned(50), NAME))

    told(story)


@pytest.mark.parametrize("fault", ["no start", "no answer", "no page"])
def test_whatever_goes_wrong_is_told_and_the_next_text_is_answered(fault, monkeypatch):
    async def story():
        page, start = Page(), asyncio.create_subprocess_exec
        monkeypatch.setattr(workers, "ROLES", {"answers": ("pose",)})

        async def failing(*command, **more):
            if fault == "no start":
                raise OSError("no process can be started")
            return await start(*(("echo", "no answer") if fault == "no answer" else command), **more)

        def tell(event, data):
            if fault == "no page" and event != "notice":
                raise KeyError("a mistake")
            page.tell(event, data)

        with monkeypatch.context() as broken:
            broken.setattr(asyncio, "create_subprocess_exec", failing)
            answering = Workers(tell, Path())
            answering.ask(1, TEXT, NAME)
            assert "was not found" in (await page.until("notice", 1))["sentence"]
        answering.ask(2, TEXT, NAME)
        await page.until("notice" if fault == "no page" else "drawn", 2)
        await answering.close()

    asyncio.run(story())


def test_a_mistake_is_told_the_next_text_is_answered_and_the_end_of_requests_is_its_own():
    requests = [{"stage": "pose", "text": 5, "name": NAME}, {"stage": "pose", "text": TEXT, "name": NAME}]
    command = module_command("alula.reports.workbench.live.workers", "answers")
    pipe = subprocess.PIPE
    with subprocess.Popen(command, env=environment(), stdin=pipe, stdout=pipe, stderr=pipe, text=True) as child:
        for request in requests:
            print(json.dumps(request), file=child.stdin, flush=True)
        answers = [json.loads(child.stdout.readline()) for _ in range(4)]
        child.stdin.close()
        assert child.wait(10) == 1
    assert "the pose of this text was not found: AttributeError" in answers[0]["data"]["sentence"]
    assert [answer.get("event", answer.get("done")) for answer in answers] == ["notice", True, "drawn", True]


def test_changed_files_of_parts_are_not_taken_for_the_same(tmp_path):
    text, file = 'file = "parts/arm.step"', tmp_path / "parts" / "arm.step"
    assert workers._files(tmp_path, text) == []
    file.parent.mkdir()
    file.write_text("one")
    (tmp_path / "other.step").write_text("one")
    first = workers._files(tmp_path, text)
    file.write_text("another")
    assert [name for name, *_ in first] == ["parts/arm.step"]
    assert workers._files(tmp_path, text) != first
    assert workers._files(tmp_path / "gone", text) == []


MASKS = """
import time
from alula.reports.workbench.live.workers import _Service

def masks(text, name, tell):
    tell("begun", {})
    try:
        while True:
            time.sleep(0.01)
    except BaseException:
        raise TypeError("as NumPy says where its comparison is interrupted")

_Service().run({"masks": masks})
"""


def test_a_library_that_tells_an_error_of_its_own_when_it_is_stopped_is_no_mistake():
    pipe = subprocess.PIPE
    with subprocess.Popen(
        [sys.executable, "-c", MASKS], env=environment(), stdin=pipe, stdout=pipe, stderr=pipe, text=True
    ) as child:
        print(json.dumps({"stage": "masks", "text": "", "name": ""}), file=child.stdin, flush=True)
        assert json.loads(child.stdout.readline())["event"] == "begun"
        print(json.dumps({"stop": True}), file=child.stdin, flush=True)
        assert json.loads(child.stdout.readline()) == {"done": False}
        child.stdin.close()

"""A study: what is kept when, how often a point is tried, and who may write."""

import hashlib
import math
import sqlite3
from concurrent.futures import Future
from contextlib import closing, nullcontext
from pathlib import Path

import pytest
import solved
from edited_cases import PLANAR

from alula.fea.common.band import Band
from alula.fea.common.verdict import CheckOutcome, Quantity, Subject, Verdict
from alula.fea.study.engine import CrashError, Engine, local_engine
from alula.fea.study.evaluate import Task, _folder, evaluate
from alula.fea.study.margin import least_margin
from alula.fea.study.numbers import VariantNumber, VariantResult
from alula.fea.study.store import ATTEMPTS, NAME, VERSION, Store
from alula.fea.study.study import Study
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.loads.plans.plan import plan_of
from alula.loads.plans.variants import Variants
from alula.reports.study.rows import number_text
from alula.reports.words.terminal import KEPT

CASE = "owl-wing-static"
DIAMETER = "parts.tube.outer_diameter"
FACTOR = VariantNumber(
    check="strength", subject="AE", load_case="weight", quantity="safety factor", unit="1",
    value=2.0, low=1.5, high=math.inf, limit=1.6, verdict=Verdict.UNDECIDED,
)  # fmt: skip


class Desk:
    """An engine in this process that answers by a function and counts what it was asked."""

    def __init__(self, answer):
        self.answer, self.asked = answer, []

    def submit(self, task):
        diameter = task.tables["parts"]["tube"]["outer_diameter"]
        self.asked.append(diameter)
        future = Future()
        try:
            future.set_result(self.answer(diameter, self.asked.count(diameter)))
        except Exception as error:
            future.set_exception(error)
        return future

    def __call__(self):
        return nullcontext(Engine(submit=self.submit, capacity=lambda: 6))


def variants(values="4 mm, 5 mm, 6 mm", **more):
    """Variants of the owl wing's tube."""
    return Variants(plan_of({"case": CASE, "vary": {DIAMETER: values}} | more), Path())


def passed(diameter, attempt):
    """The answer of a variant that holds."""
    return VariantResult(state="done", verdict=Verdict.PASS, numbers=(FACTOR,), seconds=0.1)


def run(folder, desk, **options):
    """Run a study and return its progress and its rows."""
    with Store.writing(folder) as store:
        done = Study(variants=options.pop("variants", None) or variants(), store=store, **options).run(desk)
        return done, list(store.rows())


def test_the_same_command_computes_what_is_missing_alone(tmp_path):
    """Results stand from run to run, also where the plan has more points now; numbers come back as they went in."""
    first, second = Desk(passed), Desk(passed)
    done, rows = run(tmp_path, first)
    assert (done.computed, done.stood, first.asked) == (3, 0, ["4 mm", "5 mm", "6 mm"])
    assert [(p, v[DIAMETER], a.verdict, a.numbers) for p, v, a, _ in rows][1] == (1, "5 mm", Verdict.PASS, (FACTOR,))
    done, rows = run(tmp_path, second, variants=variants("3 mm, 5 mm, 6 mm"))
    assert (done.computed, done.stood, second.asked) == (1, 2, ["3 mm"])
    assert [v[DIAMETER] for _, v, _, _ in rows] == ["3 mm", "5 mm", "6 mm"]


def test_a_crash_costs_an_attempt_and_three_end_it(tmp_path):
    """Other points go on; the row says why, and only --retry tries it again."""

    def answer(diameter, attempt):
        if diameter == "5 mm" or (diameter == "6 mm" and attempt == 1):
            raise CrashError("its worker was ended by signal 9")
        return passed(diameter, attempt)

    desk = Desk(answer)
    _, rows = run(tmp_path, desk)
    assert desk.asked.count("5 mm") == ATTEMPTS
    assert [(a.state, n) for _, _, a, n in rows] == [("done", 1), ("crashed", ATTEMPTS), ("done", 2)]
    assert "signal 9" in rows[1][2].sentence
    again = Desk(passed)
    run(tmp_path, again)
    assert again.asked == []
    run(tmp_path, again, retry=True)
    assert again.asked == ["5 mm"]


def test_attempts_count_over_runs(tmp_path):
    """A study that is stopped between two attempts does not begin to count anew."""

    def gone(diameter, attempt):
        raise CrashError("crash") if attempt == 1 else CannotRunError("the workers are gone")

    with pytest.raises(CannotRunError):
        run(tmp_path, Desk(gone), variants=variants("5 mm"))

    def crash(diameter, attempt):
        raise CrashError("crash")

    desk = Desk(crash)
    run(tmp_path, desk, variants=variants("5 mm"))
    assert desk.asked == ["5 mm"] * (ATTEMPTS - 1)


def test_equal_points_are_computed_once_and_refused_ones_keep_their_sentence(tmp_path):
    """Two ways to one case share a result; what the case's own rules forbid is a row, not an end."""
    desk = Desk(passed)
    done, rows = run(tmp_path, desk, variants=variants("5 mm, 5.0 mm", set={DIAMETER: "5 mm"}))
    assert len(desk.asked) == 2  # the texts differ, and so do the keys
    table = tmp_path / "points.csv"
    table.write_text(f"{DIAMETER}\n5 mm\n5 mm\n", encoding="utf-8")
    plan = plan_of({"case": CASE, "points": "points.csv"})
    desk = Desk(passed)
    done, rows = run(tmp_path / "table", desk, variants=Variants(plan, tmp_path))
    assert desk.asked == ["5 mm"]
    assert [p for p, *_ in rows] == [0, 1]
    assert (done.computed, done.stood) == (1, 1)


def test_a_finished_point_is_whole_or_not_there_when_the_disk_is_full(tmp_path):
    """SQLite refuses a page: what was finished stands, the study says so, and goes on once there is room."""
    many = tuple(
        VariantNumber(subject=f"{i}", quantity="mass", unit="g", value=1.0, low=1.0, high=1.0) for i in range(2000)
    )

    def large(diameter, attempt):
        return VariantResult(state="done", verdict=Verdict.PASS, numbers=(FACTOR,) if diameter == "4 mm" else many)

    def on_a_small_disk():
        with Store.writing(tmp_path) as store:
            store._db.execute("PRAGMA max_page_count = 20")
            Study(variants=variants(), store=store).run(Desk(large))

    with pytest.raises(CannotRunError, match=r"full.*stand there"):
        on_a_small_disk()
    with Store.reading(tmp_path) as store:
        assert [(p, len(a.numbers)) for p, _, a, _ in store.rows()] == [(0, 1)]
    desk = Desk(large)
    _, rows = run(tmp_path, desk)
    assert desk.asked == ["5 mm", "6 mm"]
    assert [len(a.numbers) for _, _, a, _ in rows] == [1, 2000, 2000]


def test_what_the_system_refuses_while_a_study_runs_is_not_blamed_on_its_folder(tmp_path):
    """A folder that cannot be made is the user's to change; another missing file is not."""
    with pytest.raises(FileNotFoundError, match="a library"), Store.writing(tmp_path):
        raise FileNotFoundError(2, "a library is missing")
    (tmp_path / "file").touch()
    with pytest.raises(CaseError, match="cannot be written"), Store.writing(tmp_path / "file" / "below"):
        pass
    with Store.writing(tmp_path):
        pass


def test_who_may_write(tmp_path):
    """One at a time; no other study, no file of something else, no newer version. Whoever looks may look."""
    run(tmp_path, Desk(passed))
    with Store.writing(tmp_path), Store.reading(tmp_path) as looking:
        assert len(list(looking.rows())) == 3
        with pytest.raises(CaseError, match="another study is writing"), Store.writing(tmp_path):
            pass
    for other in (
        {"analysis": "motion"},
        {"vary": {"parts.tube.fillet_radius": "0.5 mm"}},
        {"case": "owl-wing-closed"},
    ):
        plan = plan_of({"case": CASE, "vary": {DIAMETER: "4 mm"}} | other)
        with pytest.raises(CaseError, match="holds another study"):
            run(tmp_path, Desk(passed), variants=Variants(plan, Path()))
    with closing(sqlite3.connect(tmp_path / NAME)) as db:
        db.execute(f"PRAGMA user_version = {VERSION + 1}")
    with pytest.raises(CaseError, match="newer alula"):
        run(tmp_path, Desk(passed))
    for name, content in (("text", b"no database at all"), ("foreign", None)):
        folder = tmp_path / name
        folder.mkdir()
        if content is None:
            with closing(sqlite3.connect(folder / NAME)) as db:
                db.execute("CREATE TABLE mine (x)")
        else:
            (folder / NAME).write_bytes(content)
        before = (folder / NAME).read_bytes()
        with pytest.raises(CaseError, match="no study of alula"):
            run(folder, Desk(passed))
        assert (folder / NAME).read_bytes() == before


def test_the_view_has_a_column_for_each_entry(tmp_path):
    """What the documentation says pandas reads in one line."""
    run(tmp_path, Desk(passed))
    with closing(sqlite3.connect(tmp_path / NAME)) as db:
        cursor = db.execute("SELECT * FROM variants")
        names = [column[0] for column in cursor.description]
        rows = [dict(zip(names, row, strict=True)) for row in cursor]
    assert [row[DIAMETER] for row in rows] == ["4 mm", "5 mm", "6 mm"]
    assert rows[0]["verdict"] == "pass"
    assert rows[0]["least_safety_factor"] == 1.5


def test_a_number_that_has_no_band_keeps_none(tmp_path):
    """The factor of a clamped link by hand was told with a band clear of its limit, and as undecided."""
    by_hand = Band(value=9.6, low=9.5, high=9.6, without="not calibrated")
    outcome = CheckOutcome.of("strength", Subject.link("pylon"), "stance", Quantity.SAFETY_FACTOR, by_hand, 2.0)
    unknown = VariantNumber.of(outcome)
    assert number_text(unknown) == f"safety factor of pylon 9.60 (no band) (≥{KEPT}2)"
    assert least_margin(VariantResult(state="done", numbers=(unknown,))) == (4.8, 0.0, math.inf)
    run(tmp_path, Desk(lambda diameter, _: VariantResult(state="done", numbers=(FACTOR, unknown))))
    with closing(sqlite3.connect(tmp_path / NAME)) as db:
        assert set(db.execute("SELECT least_safety_factor FROM variants")) == {(None,)}


def test_a_key_depends_on_all_that_the_answer_depends_on():
    """Another value, analysis, fidelity, accuracy or version is another variant; the order of entries is not."""
    task = Task(tables={"a": 1, "b": "2 mm"})
    assert task.key() == Task(tables={"b": "2 mm", "a": 1}).key()
    others = [Task(tables={"a": 1, "b": "3 mm"})]
    others += [Task(tables=task.tables, **{name: "x"}) for name in ("analysis", "fidelity", "accuracy")]
    others.append(Task(tables=task.tables, weighs=True))
    assert len({task.key(), *(other.key() for other in others)}) == 6


def test_a_part_whose_content_changed_on_its_way_is_not_computed():
    """The name of a part's file is the digest of its content; a name that leads elsewhere is none."""
    content = b"ISO-10303-21;"
    digest = hashlib.sha256(content).hexdigest()
    good = _folder(((f"{digest}.step", content),))
    assert (Path(good) / f"{digest}.step").read_bytes() == content
    for name, found in ((f"{digest}.step", content + b" "), (f"{digest}.step/../../part.step", content)):
        answer = evaluate(Task(tables={}), {name: found})
        assert (answer.state, "changed on its way" in answer.sentence) == ("crashed", True)


def test_workers_compute_what_a_check_computes(tmp_path):
    """A real worker's numbers are those of the check in this process; what the case's rules refuse comes back so."""
    found = variants("1 mm, 5 mm", fidelity="beam", set={"layer_spacing": "0 mm"})
    with local_engine(1, {}, folder=tmp_path) as engine, Store.writing(tmp_path / "s") as store:
        Study(variants=found, store=store).run(lambda: nullcontext(engine))
        refused, done = (answer for _, _, answer, _ in store.rows())
    assert refused.state == "refused"
    assert "inner_diameter" in refused.sentence
    expected = [check for case in solved.by_hand(CASE, PLANAR).load_cases.values() for check in case.checks]
    checked = [f for f in done.numbers if f.check]
    assert [(f.check, f.subject, f.verdict) for f in checked] == [
        (c.name, str(c.subject), c.verdict if c.applies else None) for c in expected
    ]
    assert [f.value for f in checked] == pytest.approx([c.value.value for c in expected], rel=1e-12, nan_ok=True)


def test_a_file_of_an_older_version_is_brought_up_to_date_or_stays_as_it_is(tmp_path, monkeypatch):
    """Steps from version to version, all or none of them in one go; results stand, and nothing is computed again."""
    run(tmp_path, Desk(passed))
    monkeypatch.setattr("alula.fea.study.store.VERSION", VERSION + 2)
    added = {
        VERSION: "ALTER TABLE results ADD COLUMN first TEXT",
        VERSION + 1: "ALTER TABLE nothing ADD COLUMN second TEXT",
    }
    monkeypatch.setattr("alula.fea.study.store._UPGRADES", added)
    with pytest.raises(CannotRunError, match="nothing"):
        run(tmp_path, Desk(passed))
    added[VERSION + 1] = "ALTER TABLE results ADD COLUMN second TEXT"
    desk = Desk(passed)
    _, rows = run(tmp_path, desk)
    assert desk.asked == []
    assert [answer.numbers for _, _, answer, _ in rows] == [(FACTOR,)] * 3
    with closing(sqlite3.connect(tmp_path / NAME)) as db:
        assert db.execute("PRAGMA user_version").fetchone() == (VERSION + 2,)
        assert {"first", "second"} <= {row[1] for row in db.execute("PRAGMA table_info(results)")}

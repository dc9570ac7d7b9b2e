"""The workbench's server: who may ask it, what it may touch, and what becomes of changes."""

import json
import os
import socket
import time
from pathlib import Path

import pytest
import served

from alula.fea.standing.case_statics import solve_case_statics
from alula.geometry.base.errors import CaseError
from alula.geometry.base.units import parse
from alula.geometry.keeping.kept import kept as marked
from alula.loads.case.case_file import read_case, read_tables, read_text
from alula.reports.workbench import session
from alula.reports.workbench.app import LARGEST_REQUEST, serve
from alula.reports.workbench.live import solids
from alula.reports.workbench.live.answers import pose_answer

TITLE = {"op": "set", "path": ["title"]}


@pytest.fixture(autouse=True)
def cache(tmp_path_factory, monkeypatch):
    """A cache folder of the test's own."""
    folder = tmp_path_factory.mktemp("cache") / "alula"
    monkeypatch.setenv("ALULA_CACHE", str(folder))
    return folder


@pytest.fixture
def case(tmp_path):
    """A case file, with line ends and a mark as Windows has them, and another file beside its folder."""
    folder = tmp_path / "cases"
    folder.mkdir()
    (tmp_path / "secret.toml").write_text("secret = 1", encoding="utf-8")
    file = folder / "mine.toml"
    file.write_bytes(b"\xef\xbb\xbf" + read_text("four-bar")[0].replace("\n", "\r\n").encode())
    return file


@pytest.fixture
def bench(case):
    with served.serving_of(case, case.parent) as bench:
        yield bench


def retitled(bench, title, revision=0, gesture=""):
    return bench.post("edit", revision=revision, operations=[{**TITLE, "value": title}], gesture=gesture)


def sentence(answer):
    """Return the sentence of a refusal, which is one."""
    status, found = answer
    assert status in (403, 404, 409, 422)
    assert set(found) == {"sentence"}
    assert "\n" not in found["sentence"]
    return found["sentence"]


def eventually(true):
    deadline = time.monotonic() + 10.0
    while not true():
        assert time.monotonic() < deadline
        time.sleep(0.02)


# Who may ask.


def test_it_listens_at_this_machine_alone(bench):
    [bound] = bench.server.servers[0].sockets
    assert bound.getsockname()[0] == "127.0.0.1"
    assert len(bench.token) >= 32


@pytest.mark.parametrize("host", ["evil.example", "127.0.0.1", "127.0.0.1:1", "evil.example:{port}", ""])
def test_another_host_is_refused(bench, host):
    status, headers, _ = bench.ask("GET", "", Host=host.format(port=bench.port))
    assert status == 403
    assert "'none'" in headers["content-security-policy"]


def test_two_hosts_are_refused(bench):
    with socket.create_connection(("127.0.0.1", bench.port)) as line:
        own = f"127.0.0.1:{bench.port}"
        line.sendall(f"GET /{bench.token}/ HTTP/1.1\r\nHost: {own}\r\nHost: evil.example\r\n\r\n".encode())
        assert line.recv(4096).split()[1] in (b"400", b"403")


@pytest.mark.parametrize("method", ["GET", "POST"])
@pytest.mark.parametrize("origin", ["http://evil.example", "null", "https://{host}", "http://127.0.0.1:1"])
def test_another_origin_is_refused(bench, method, origin):
    own = {"Origin": origin.format(host=f"127.0.0.1:{bench.port}"), "Content_Type": "application/json"}
    assert bench.ask(method, "undo" if method == "POST" else "schema", b"{}", **own)[0] == 403


def test_a_post_without_origin_is_refused(bench):
    assert bench.ask("POST", "undo", b"{}", Content_Type="application/json")[0] == 403
    assert bench.post("undo")[0] == 200


@pytest.mark.parametrize(
    "path", ["/", "/{token}", "/{token}x/", "/{half}/", "/x/schema", "//schema", "/{token}%2Fschema"]
)
def test_another_token_finds_nothing(bench, path):
    path = path.format(token=bench.token, half=bench.token[:-1])
    for method in ("GET", "POST", "OPTIONS", "HEAD"):
        status, headers, found = bench.raw(method, path, Origin=bench.origin)
        assert status == 404 or path.endswith("%2Fschema")
        assert bench.token not in found.decode() + str(headers["content-security-policy"]).replace(own(bench), "")


def own(bench):
    return f"{bench.origin}/{bench.token}/page/"


def test_no_other_origin_may_read(bench):
    for method, path in (("GET", "schema"), ("OPTIONS", "edit"), ("GET", "events"), ("POST", "undo")):
        if path != "events":
            _, headers, _ = bench.ask(method, path, Origin=bench.origin)
            assert not [name for name in headers if name.lower().startswith("access-control")]


def test_each_answer_says_what_a_page_may_do(bench):
    for path in ("", "page/main.js", "schema", "out/case", "nothing", "page/nothing.js"):
        _, headers, _ = bench.ask("GET", path)
        policy = dict(rule.split(" ", 1) for rule in headers["content-security-policy"].split("; "))
        assert policy == {
            "default-src": "'none'", "script-src": own(bench), "style-src": own(bench), "base-uri": "'none'",
            "img-src": "'self' data: blob:", "connect-src": "'self'", "form-action": "'none'",
            "frame-ancestors": "'none'",
        }  # fmt: skip
        assert headers["x-content-type-options"] == "nosniff"
        assert headers["referrer-policy"] == "no-referrer"
        assert headers["cache-control"] == "no-store"


# What it may touch.


@pytest.mark.parametrize(
    "path",
    [
        *("page/..%2Fapp.py", "page/../app.py", "page/%2e%2e/app.py", "page/app.py", "page//etc/passwd", "page/.."),
        *("page/main.js%00", "page/C:%5Cx.js", "page/..%5Cpage%5Cmain.js", "page/", "out/step/..%2F..%2Fsecret"),
        *("../secret.toml", "secret.toml", "out/secret.toml", "model/..%2Fsecret"),
    ],
)
def test_no_path_leads_out_of_the_page(bench, path):
    status, _, found = bench.ask("GET", path)
    assert status in (404, 405, 422)
    assert b"secret = 1" not in found


@pytest.mark.parametrize(
    "name", ["../secret.toml", "/etc/x.toml", "a/b.toml", ".hidden.toml", "mine", "C:x.toml", "", ".toml"]
)
def test_a_case_is_opened_by_its_name_alone(bench, case, name):
    assert "plain name" in sentence(bench.post("open", path=name))
    assert "plain name" in sentence(bench.post("open", starter="four-bar", **{"as": name}))
    assert [file.name for file in case.parent.parent.rglob("*.toml")] == ["secret.toml", "mine.toml"]


def test_a_starter_is_copied_with_its_files_and_over_nothing(bench, case):
    _, _, found = bench.ask("GET", "starters")
    offered = json.loads(found)
    assert offered["files"] == ["mine.toml"]
    assert {"four-bar", "owl-wing-anchor"} < {one["name"] for one in offered["starters"]}
    before = case.read_bytes()
    assert "exists" in sentence(bench.post("open", starter="four-bar", **{"as": "mine.toml"}))
    assert "no built-in case" in sentence(bench.post("open", starter="../mine", **{"as": "new.toml"}))
    assert case.read_bytes() == before
    assert bench.post("open", starter="owl-wing-anchor", **{"as": "new.toml"}) == (200, {"revision": 1})
    assert bench.document()["name"] == "new.toml"
    assert sorted(file.name for file in case.parent.iterdir()) == ["mine.toml", "new.toml", "owl-wing-anchor.step"]


def test_files_whose_names_are_no_plain_text_are_not_offered(bench, case, tmp_path):
    for name in (b"\xff.toml", b"new\nline.toml", b".hidden.toml"):
        Path(os.fsdecode(os.fsencode(case.parent) + b"/" + name)).write_bytes(case.read_bytes())
    assert json.loads(bench.ask("GET", "starters")[2])["files"] == ["mine.toml"]
    odd = Path(os.fsdecode(os.fsencode(tmp_path) + b"/\xff.toml"))
    with pytest.raises(CaseError, match=r"\A'\?\.toml' .* rename it\Z"):
        serve(odd, tmp_path, 0, print)


@pytest.mark.parametrize("file", ["/etc/hostname", "../lever.step", "near/../../lever.step", "link.step"])
def test_no_part_leads_out_of_the_folder(bench, case, file):
    (case.parent / "link.step").symlink_to("/etc/hostname")
    far = f'\n[parts.far]\nshape = "step"\nmaterial = "pla-fdm-xy"\nfile = "{file}"\nbores = {{ O2 = "1", A = "2" }}\n'
    crank = '[links.crank]\r\npart = "bar"'
    text = bench.document()["text"] + far
    assert crank in text
    text = text.replace(crank, '[links.crank]\r\npart = "far"')
    assert bench.post("text", revision=bench.document()["revision"], text=text)[0] == 200
    for route in ("out/report", "out/step/crank"):
        status, _, found = bench.ask("GET", route)
        assert status == 422
        assert "is not in the folder" in json.loads(found)["sentence"]
    assert "is not in the folder" in pose_answer(text, str(case))["problem"]
    said = []
    solids.STAGES[solids.ROLE](text, str(case), lambda event, data: said.append((event, data)), threads=1, memory=None)
    [(event, data)] = said
    assert event == "failed"
    assert "is not in the folder" in data["sentence"]
    operation = {"op": "set", "path": ["parts", "far", "file"], "value": "lever.step"}  # one that may be
    assert bench.post("edit", revision=bench.document()["revision"], operations=[operation])[0] == 200
    assert bench.document()["tables"]["parts"]["far"]["file"] == "lever.step"


def test_a_drawing_starts_from_nothing(tmp_path):
    with served.serving_of(tmp_path / "mine.toml", tmp_path) as bench:
        assert bench.document()["path"] is None
        assert json.loads(bench.ask("GET", "starters")[2])["new"] == "mine.toml"
        assert "no case is open" in sentence(retitled(bench, "x"))
        assert "no case is open" in sentence(bench.post("save"))
        assert bench.post("open", starter="empty", **{"as": "drawn.toml"})[0] == 200
        assert bench.document()["tables"]["joints"] == {}


@pytest.mark.parametrize(
    "body", [b"{", b"[]", b"[" * 100_000, b'{"revision": NaN}', b'"x"', b'{"text": "\\ud800"}', b"\xff"]
)
def test_what_is_no_request_changes_nothing(bench, body):
    headers = {"Origin": bench.origin, "Content_Type": "application/json"}
    for action in ("edit", "text", "save", "open", "draft", "solids"):
        status, _, found = bench.ask("POST", action, body, **headers)
        assert status == 422
        assert "\n" not in json.loads(found)["sentence"]
    assert bench.document()["revision"] == 0


def test_a_text_of_any_kind_is_answered(bench):
    for number, text in enumerate(("x = 0x" + "f" * 5000, "pose = 5", "pose = [1]", "x" + ".x" * 3000 + " = 1")):
        assert bench.post("text", revision=number, text=text, gesture="") == (200, {"revision": number + 1})
        assert bench.document()["text"] == text
        assert bench.post("edit", revision=number + 1, operations=[{"op": "turn", "to": 10**400}])[0] == 422


def test_entries_have_types(bench):
    for wrong in ({"revision": True}, {"revision": "0"}, {"gesture": 1}, {"operations": {}}, {"operations": [1]}):
        assert sentence(bench.post("edit", **({"revision": 0, "operations": [], "gesture": ""} | wrong)))
    headers = {"Origin": bench.origin, "Content_Type": "text/plain"}  # which a form of another page may send
    assert bench.ask("POST", "save", b"{}", **headers)[0] == 422


def test_a_body_beyond_the_limit_is_not_read(bench, monkeypatch):
    headers = {"Origin": bench.origin, "Content_Type": "application/json"}
    status, _, found = bench.ask(
        "POST", "text", b'{"revision": 0, "text": "' + b"x" * LARGEST_REQUEST + b'"}', **headers
    )
    assert status == 422
    assert "limit" in json.loads(found)["sentence"]


def test_pages_are_counted(bench, monkeypatch):
    monkeypatch.setattr(session, "MOST_PAGES", 2)
    with bench.events() as first:
        first.next("document")
        with bench.events() as second:
            second.next("document")
            status, _, found = bench.ask("GET", "events")
            assert status == 409
            assert "close one" in json.loads(found)["sentence"]


def test_the_report_is_of_no_origin_and_takes_what_was_solved_before(bench, cache, monkeypatch):
    from alula.reports.workbench import app

    @marked()
    def solved(text):
        return f"<!DOCTYPE html>{text}"[:15].encode()

    monkeypatch.setattr(app.out, "report", lambda text, *asked: solved(text))
    assert bench.ask("GET", "out/report")[0] == 200
    assert list((cache / "solved").iterdir())
    _, headers, found = bench.ask("GET", "out/report")
    assert found == b"<!DOCTYPE html>"
    policy = headers["content-security-policy"]
    assert "script-src" not in policy  # that is the report's own matter, by hashes
    assert policy.startswith("sandbox allow-scripts")
    assert "allow-same-origin" not in policy
    assert "frame-ancestors 'none'" in policy


# What becomes of changes.


def test_an_edit_is_seen_by_every_page(bench):
    with bench.events() as first, bench.events() as second:
        assert retitled(bench, "by the first") == (200, {"revision": 1})
        for events in (first, second):
            told = events.next("document", revision=1)
            assert 'title = "by the first"\r\n' in told["text"]
            assert told["text"].startswith("\ufeff")
            assert (told["saved"], told["undo"]) == (False, True)
        status, found = retitled(bench, "by the second", revision=0)
        assert status == 409
        assert "meanwhile" in found["sentence"]
        assert bench.post("text", revision=1, text="no TOML", gesture="") == (200, {"revision": 2})
        assert second.next("document", revision=2)["tables"] is None
        assert bench.post("undo", revision=2, gesture="of a pull that changed nothing") == (200, {"revision": 2})
        assert bench.post("undo", revision=2) == (200, {"revision": 3})
        assert bench.post("undo", revision=2)[0] == 409


def test_answers_go_to_the_revision_they_are_of(case):
    made = []

    class Known(served.Quiet):
        def __init__(self, *given):
            super().__init__(*given)
            made.append(self)

        def ask(self, revision, text, name):
            super().ask(revision, text, name)
            for of in (revision, revision - 1):
                self.tell("problem", {"revision": of, "sentence": f"title: of {of}"})
            self.tell("verdict", {"revision": revision, "stage": "linear", "verdict": "fail"})
            self.tell("verdict", {"revision": revision, "stage": "whole", "verdict": "fail"})

    with served.serving_of(case, case.parent, Known) as bench:
        retitled(bench, "x")
        assert made[0].asked[-1][0] == 1
        assert made[0].asked[-1][2] == str(case)
        with bench.events() as late:  # a page that comes late is told all that holds
            told = late.next("document")
            assert told["problem"]["sentence"] == "title: of 1"
            assert told["text"].splitlines()[told["problem"]["line"] - 1] == 'title = "x"'
            assert late.next("verdict", stage="linear")["revision"] == 1
            assert late.next("verdict", stage="whole")["revision"] == 1


def test_saving_keeps_all_but_what_was_changed(bench, case):
    before = case.read_bytes()
    case.chmod(0o640)
    link = case.with_name("link.toml")
    case.rename(case.with_name("real.toml"))
    case.symlink_to("real.toml")
    retitled(bench, "saved")
    assert bench.post("save")[0] == 200
    assert bench.document()["saved"]
    assert case.is_symlink()
    real = case.with_name("real.toml")
    assert real.stat().st_mode & 0o777 == 0o640
    lines = zip(before.split(b"\r\n"), real.read_bytes().split(b"\r\n"), strict=True)
    assert [new for old, new in lines if old != new] == [b'title = "saved"']
    assert not link.exists()
    assert sorted(file.name for file in case.parent.iterdir()) == ["mine.toml", "real.toml"]


def test_changes_are_saved_as_one_goes(bench, case):
    assert bench.post("save", always=True)[0] == 200
    retitled(bench, "by itself")
    eventually(lambda: b'"by itself"' in case.read_bytes())
    assert bench.post("save", always=False)[0] == 200
    retitled(bench, "not by itself", 1)
    time.sleep(0.3)
    assert b"not by itself" not in case.read_bytes()


def test_a_change_on_the_disk_is_taken_over(bench, case):
    with bench.events() as events:
        case.write_bytes(case.read_bytes().replace(b"title = ", b"title = 'other' # "))
        told = events.next("document", revision=1)
        assert "title = 'other'" in told["text"]
        assert (told["saved"], told["disk"], told["undo"]) == (True, None, True)


def test_a_change_on_the_disk_is_offered_where_something_is_unsaved(bench, case):
    theirs = case.read_bytes().replace(b"title = ", b"title = 'theirs' # ")
    with bench.events() as events:
        for answer, held in (("overwrite", b'"for overwrite"'), ("reload", b"'theirs'")):
            retitled(bench, f"for {answer}", bench.document()["revision"])
            events.next("document", saved=False)
            case.write_bytes(theirs)
            events.next("document", disk="changed")
            assert "another program" in sentence(bench.post("save"))
            assert case.read_bytes() == theirs
            assert bench.post(answer)[0] == 200
            told = bench.document()
            assert held in case.read_bytes()
            assert held.decode() in told["text"]
            assert (told["disk"], told["saved"]) == (None, True)


@pytest.mark.parametrize("always", [False, True])
def test_a_change_on_the_disk_while_it_is_saved_is_not_overwritten(bench, case, monkeypatch, always):
    """Another program writes after the last look at the disk, while the new file is being made: its text stays."""
    theirs, write = case.read_bytes().replace(b"title = ", b"title = 'theirs' # "), session.write_file

    def meanwhile(*what):
        case.write_bytes(theirs)
        write(*what)

    if always:
        bench.post("save", always=True)
    with bench.events() as events:
        monkeypatch.setattr(session, "write_file", meanwhile)
        retitled(bench, "mine")
        told = events.next("notice")["sentence"] if always else sentence(bench.post("save"))
        assert "another program has just changed it" in told
        found = events.next("document", disk="changed")
        assert '"mine"' in found["text"]
        assert not found["saved"]
    assert case.read_bytes() == theirs
    assert bench.post("reload")[0] == 200
    assert "'theirs'" in bench.document()["text"]


def test_what_another_program_writes_alike_counts_as_saved(bench, case):
    """Whichever of both wrote it; what stood there before does not come back as theirs."""
    with bench.events() as events:
        retitled(bench, "alike")
        text = events.next("document", saved=False)["text"]
        case.write_bytes(text.encode())
        told = events.next("document", saved=True)
        assert (told["text"], told["disk"]) == (text, None)


def test_a_change_on_the_disk_right_after_it_is_saved_is_seen(bench, case, monkeypatch):
    """Another program writes before the page has looked at what it saved: its text is taken over."""
    write, theirs = session.write_file, case.read_bytes().replace(b"title = ", b"title = 'theirs' # ")

    def written(*what):
        write(*what)
        case.write_bytes(theirs)

    with bench.events() as events:
        monkeypatch.setattr(session, "write_file", written)
        retitled(bench, "mine")
        assert bench.post("save")[0] == 200
        told = events.next("document", revision=2)
        assert "'theirs'" in told["text"]
        assert told["saved"]


def test_a_deleted_file_is_written_anew_on_request_alone(bench, case):
    bench.post("save", always=True)
    with bench.events() as events:
        case.unlink()
        told = events.next("document", disk="deleted")
        assert not told["saved"]
    retitled(bench, "still here")
    time.sleep(0.3)
    assert not case.exists()
    assert bench.post("save")[0] == 200
    assert b"still here" in case.read_bytes()


def test_a_read_only_file_stays_as_it_is(bench, case):
    before = case.read_bytes()
    with bench.events() as events:
        case.chmod(0o444)
        events.next("document", disk="read-only")
    retitled(bench, "x")
    assert "read-only" in sentence(bench.post("save"))
    assert case.read_bytes() == before
    assert 'title = "x"' in bench.document()["text"]


def full_disk(descriptor):
    raise OSError(28, "No space left on device")


def test_a_full_disk_loses_nothing(bench, case, monkeypatch):
    before = case.read_bytes()
    retitled(bench, "x")
    monkeypatch.setattr(os, "fsync", full_disk)
    assert "No space left" in sentence(bench.post("save"))
    assert case.read_bytes() == before
    assert [file.name for file in case.parent.iterdir()] == ["mine.toml"]
    assert not bench.document()["saved"]


def test_what_no_case_could_be_is_not_saved(bench, case):
    before = case.read_bytes()
    for revision, text in enumerate((" ", "x" * (1 << 20) + "y")):
        bench.post("text", revision=revision, text=text, gesture="")
        assert "not" in sentence(bench.post("save"))
        assert case.read_bytes() == before


# Drafts.


def kept(cache):
    return [json.loads(file.read_text())[0] for file in cache.rglob("draft.json")]


def test_what_was_not_saved_is_offered_again(case, cache):
    with served.serving_of(case, case.parent) as bench:
        retitled(bench, "unsaved")
        eventually(lambda: kept(cache))
        assert '"unsaved"' in kept(cache)[0]
        retitled(bench, "at the end", 1)
    assert '"at the end"' in kept(cache)[0]
    for take in (True, False):
        with served.serving_of(case, case.parent) as bench:
            told = bench.document()
            assert abs(told["draft"] - time.time()) < 60.0, "it says from when it is"
            assert bench.post("save")[0] == 200  # of what is shown, which is no answer
            assert kept(cache)
            assert bench.document()["saved"]
            assert bench.post("draft", take=take)[0] == 200
            told = bench.document()
            assert not told["draft"]
            assert ('"at the end"' in told["text"]) is take
            assert sentence(bench.post("draft", take=True))
    assert kept(cache) == []
    assert b"at the end" not in case.read_bytes()


def test_a_draft_goes_when_its_text_is_saved(case, cache):
    with served.serving_of(case, case.parent) as bench:
        retitled(bench, "x")
        eventually(lambda: kept(cache))
        bench.post("save")
        assert kept(cache) == []


@pytest.mark.parametrize("change", ["on the disk", "on the page"])
def test_a_draft_that_is_not_taken_is_set_aside(case, cache, change):
    with served.serving_of(case, case.parent) as bench:
        retitled(bench, "unsaved")
    if change == "on the disk":
        case.write_bytes(case.read_bytes() + b"# later\r\n")
    with served.serving_of(case, case.parent) as bench:
        with bench.events() as events:
            assert (events.next("document")["draft"] is not None) is (change == "on the page")
            retitled(bench, "newer")
            assert "stands in" in events.next("notice")["sentence"]
        [aside] = cache.rglob("*.toml")
        assert b'"unsaved"' in aside.read_bytes()
    assert '"newer"' in kept(cache)[0]


@pytest.mark.parametrize("change", ["deleted", "edited on a full disk"])
def test_an_offered_draft_outlives_what_happens_before_the_answer(case, cache, monkeypatch, change):
    before = case.read_bytes()
    with served.serving_of(case, case.parent) as bench:
        retitled(bench, "unsaved")
    with served.serving_of(case, case.parent) as bench, bench.events() as events:
        assert events.next("document")["draft"]
        if change == "deleted":
            case.unlink()
            events.next("document", disk="deleted")
        else:
            with monkeypatch.context() as full:
                full.setattr(os, "fsync", full_disk)
                retitled(bench, "newer")
                assert "still offered" in events.next("notice")["sentence"]
        time.sleep(0.2)  # some looks at the disk
    assert [text for text in kept(cache) if '"unsaved"' in text]
    case.write_bytes(before)
    with served.serving_of(case, case.parent) as bench:
        assert bench.document()["draft"]


def test_a_new_file_is_not_offered_what_was_not_saved_of_another_one(tmp_path, cache):
    """The deleted one began with the same text and had the same name; what was not saved of it stands aside."""
    mine = tmp_path / "mine.toml"
    for _ in range(2):
        with served.serving_of(mine, tmp_path) as bench:
            assert bench.post("open", starter="empty", **{"as": "mine.toml"})[0] == 200
            told = bench.document()
            assert told["draft"] is None
            bench.post("text", revision=told["revision"], text='title = "unsaved"', gesture="")
        mine.unlink()
        assert kept(cache) == ['title = "unsaved"']
    assert [file.read_text() for file in cache.rglob("*.toml")] == ['title = "unsaved"']


def test_a_second_server_is_told_and_keeps_off(case, cache):
    with served.serving_of(case, case.parent) as first:
        retitled(first, "of the first")
        eventually(lambda: kept(cache))
        with served.serving_of(case, case.parent) as second, second.events() as events:
            assert "another alula" in events.next("notice")["sentence"]
            assert not second.document()["draft"]
            retitled(second, "of the second")
        assert '"of the first"' in kept(cache)[0]


def test_without_a_cache_all_else_works(case, monkeypatch):
    monkeypatch.setenv("ALULA_CACHE", "")
    with served.serving_of(case, case.parent) as bench:
        retitled(bench, "x")
        time.sleep(0.2)
        assert bench.post("save")[0] == 200


def test_a_place_is_told_in_the_pose_that_balances(tmp_path):
    """A point of the pedal that is drawn at another one's place gets that one's entry, since the pose is the same."""
    case = tmp_path / "pedal.toml"
    case.write_text(read_text("spring-pedal")[0], encoding="utf-8")
    link, (point, stated) = "pedal", list(read_tables(str(case))["links"]["pedal"]["points"].items())[-1]
    pose = solve_case_statics(read_case(str(case)), str(case)).pose
    with served.serving_of(case, tmp_path) as bench:
        move = {"op": "move", "link": link, "point": point, "to": list(pose.position(link, point))}
        assert bench.post("edit", revision=0, operations=[move], gesture="")[0] == 200
        told = bench.document()["tables"]["links"][link]["points"][point]
    assert [parse(one, "length") for one in told] == pytest.approx([parse(one, "length") for one in stated], abs=1e-3)


def test_open_streams_do_not_hold_up_the_end(case):
    with served.serving_of(case, case.parent) as bench:
        stream = bench.events()
        stream.__enter__().next("document")
    stream.__exit__(None, None, None)


def test_a_case_is_left_only_when_it_is_saved(bench, case: Path):
    retitled(bench, "x")
    assert "not saved" in sentence(bench.post("open", starter="four-bar", **{"as": "new.toml"}))
    assert not case.with_name("new.toml").exists()
    bench.post("save")
    solids = bench.server.session.solids
    assert solids.asked == []
    assert bench.post("open", starter="four-bar", **{"as": "new.toml"}) == (200, {"revision": 2})
    assert solids.asked == ["stop"]


def test_connections_that_ask_nothing_block_nobody(bench):
    lines = [socket.create_connection(("127.0.0.1", bench.port), timeout=5) for _ in range(100)]
    try:
        for line in lines[::2]:
            line.sendall(b"GET / HTTP/1.1\r\n")  # half a head
        assert bench.ask("GET", "")[0] == 200
        assert lines[1].recv(1) == b"", "the oldest are closed"
        lines[-1].sendall(b"GET /wrong/ HTTP/1.1\r\nHost: 127.0.0.1:%d\r\n\r\n" % bench.port)
        told = b"".join(iter(lambda: lines[-1].recv(4096), b""))
        assert told.startswith(b"HTTP/1.1 404"), "and who may not ask is told so, and holds no connection"
    finally:
        for line in lines:
            line.close()

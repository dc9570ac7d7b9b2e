"""With what a result was made, and of which files."""

import hashlib
import json
import re
from datetime import UTC, datetime

import solved
from imported_case import imported_case
from told import flat, render, result_record

import alula
from alula.loads.case.case_file import read_case
from alula.reports.page.provenance import provenance_section
from alula.reports.renderers.page import Page, as_page
from alula.reports.sections.section import Section

DATE = datetime(2026, 2, 3, 4, 5, 6, tzinfo=UTC)


def sha256(content):
    return hashlib.sha256(content).hexdigest()


def stated(case):
    return provenance_section(case, DATE).data["provenance"]


def told(case):
    [items] = provenance_section(case, DATE).parts
    return {title: flat(text) for title, text in items.items}


def test_files_are_told_as_they_were_read(tmp_path):
    """To the byte, with a byte order mark and the line ends of Windows; what is written later does not count."""
    path = imported_case(tmp_path)
    content = b"\xef\xbb\xbf" + path.read_bytes().replace(b"\n", b"\r\n")
    path.write_bytes(content)
    case = read_case(str(path), ["motion.poses=7"])
    part = (tmp_path / "plate.step").read_bytes()
    path.write_bytes(content + b"# more")
    (tmp_path / "plate.step").write_bytes(b"another")
    record = stated(case)
    assert record["date"] == "2026-02-03T04:05:06+00:00"
    assert (record["case"], record["files"]) == (sha256(content), {"plate.step": sha256(part)})
    assert record["changes"] == {"motion.poses": "7"}
    assert {"numpy", "scikit-fem", "gmsh"} <= set(record["libraries"])
    assert told(case)["Case"] == f"case.toml, SHA-256 {sha256(content)}."
    assert told(case)["Read for it"] == f"plate.step, SHA-256 {sha256(part)}."
    assert told(case)["Changed beside the file"] == "motion.poses = 7."
    (tmp_path / "plate.step").write_bytes(part)
    again = case.with_values({"motion.poses": 9})
    assert (again.digest, again.files) == (case.digest, case.files)
    assert alula.read_case(path).record.digest == sha256(content + b"# more")


def test_a_case_without_a_file_is_known_by_its_tables():
    tables = alula.read_case("four-bar").to_dict()
    case, same, other = (alula.Case.from_dict(one).record for one in (tables, dict(tables), tables | {"title": "x"}))
    assert case.digest == same.digest == sha256(json.dumps(tables, sort_keys=True).encode())
    assert other.digest != case.digest
    assert case.digest in told(case)["Case"]
    copied = read_case("four-bar").model_copy(update={"title": "x"})
    assert stated(copied)["case"] is None
    assert told(copied)["Case"] == "four-bar was changed in Python after it was read."
    assert "To compare" not in told(copied)


def test_the_page_ends_with_it_and_each_sheet_has_it_at_its_foot():
    result = solved.told("owl-wing-static")
    html, record = render(result), result_record(result)["provenance"]
    assert record["date"] == result.date.isoformat(timespec="seconds")
    [foot] = re.findall(r'@bottom-left { content: "([^"]*)"; }', html)
    digest, date = f"SHA-256 {record['case'][:16]}…", f"{result.date:%Y-%m-%d %H:%M} UTC"
    assert foot == f"owl-wing-static · {digest} · {date} · alula {alula.__version__}"
    assert html.index(record["case"]) > html.index("What the verdict does not cover")
    assert record["sources"] in html


def test_no_name_of_a_file_ends_the_style_of_a_page():
    section = Section(key="x", running='a"; } </style><b>\\n.toml')
    html = as_page(Page(title="x", kind="x", heading="x", sections=(section,)))
    assert r'content: "a\22 \3b  \7d  \3c \2f style\3e \3c b\3e \5c n.toml";' in html
    assert "</style><b>" not in html

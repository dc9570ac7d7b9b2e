"""What the documentation refers to exists, and what a person reads is spelled as dictionaries have it."""

import re
from collections import Counter
from functools import cache
from pathlib import Path
from urllib.parse import urlsplit

import prose
import pytest
from programs import ROOT
from spellchecker import SpellChecker

LINK = re.compile(
    r"\[(?:[^\[\]]|\[[^\]]*\])*\]\(<?([^()\s>]*(?:\([^()]*\)[^()\s>]*)*)>?(?: \"[^\"]*\")?\)|^\[[^\]]+\]: (\S+)", re.M
)
URL = re.compile(r"(?<![\w+])(?:https?|ftp|file)://[^\s\"'`<>]*[^\s\"'`<>.,;:)]", re.I)
WORDS = Path(__file__).with_name("words.txt")
"""Words that no dictionary has: terms of the field, British spellings, names. One a line."""


@cache
def anchors(file: Path) -> frozenset[str]:
    """Return the anchors of a Markdown file as GitHub and MyST make them: headings and named places."""
    text = prose.FENCE.sub("", file.read_text(encoding="utf-8"))
    found: Counter[str] = Counter()
    names = set(re.findall(r"^\(([\w-]+)\)=$", text, re.M)) | set(re.findall(r"<a (?:id|name)=\"([^\"]+)\"", text))
    for heading in re.findall(r"^ {0,3}#{1,6} +(.*?)(?: +#+)?$", text, re.M):
        shown = re.sub(r"!?\[([^\]]*)\]\([^)]*\)", r"\1", heading)
        slug = re.sub(r"[^\w\- ]", "", shown.lower()).replace(" ", "-")
        names.add(f"{slug}-{found[slug]}" if found[slug] else slug)
        found[slug] += 1
    return frozenset(names)


def dead_links(file: Path) -> list[str]:
    """Return every relative link of a Markdown file whose file or anchor is not there."""
    text = re.sub(r"`[^`\n]+`", "", prose.without_code(file.read_text(encoding="utf-8")))
    dead = []
    for target in (first or second for first, second in LINK.findall(text)):
        if urlsplit(target).scheme:
            continue
        path, _, anchor = target.partition("#")
        there = (file.parent / path).resolve() if path else file
        if not there.exists() or not there.is_relative_to(ROOT):
            dead.append(f"{target}: no such file")
        elif anchor and anchor not in anchors(there):
            dead.append(f"{target}: no such heading")
    return dead


def malformed(url: str) -> bool:
    """Return True for an address that is no https, or that no browser opens."""
    parts = urlsplit(url)
    host = re.fullmatch(r"(?:[a-z0-9](?:[a-z0-9-]*[a-z0-9])?\.)+[a-z]{2,}", parts.netloc)
    return (
        parts.scheme != "https"
        or host is None
        or re.search(r"[^!-~]|[{}|\\^\[\]]|%(?![0-9A-Fa-f]{2})", url) is not None
    )


def unknown_words(text: str, known: SpellChecker) -> list[tuple[int, str]]:
    """Return the words of a text that neither the dictionary nor our list has, with their lines from 0.

    Acronyms and names with capitals inside are not looked up, nor are tokens with other signs (mm², σ).
    """
    found = []
    for line, token in prose.words(text):
        word = re.sub(r"['’]s?$", "", token).replace("’", "'")
        looked_up = len(word) > 2 and word[1:].islower() and re.fullmatch(r"[A-Za-zÀ-ɏ']+", word)
        if looked_up and word.lower() not in known.word_frequency.dictionary:
            found.append((line, word))
    return found


@cache
def texts() -> list[tuple[Path, int, str]]:
    return list(prose.texts())


@pytest.fixture(scope="module")
def known() -> SpellChecker:
    checker = SpellChecker()
    checker.word_frequency.load_words(WORDS.read_text(encoding="utf-8").split())
    return checker


def test_links_lead_somewhere() -> None:
    assert len(prose.markdown_files()) > 15
    dead = {str(file.relative_to(ROOT)): dead_links(file) for file in prose.markdown_files()}
    assert not {file: links for file, links in dead.items() if links}


def test_files_that_pages_name_are_there() -> None:
    """In running text; NAME stands for any name."""
    path = re.compile(r"`((?:geometry|loads|fea|reports|tests|benchmarks|docs)/[\w/.-]+\.\w+)`")
    named = [(file, name) for file in prose.markdown_files() for name in path.findall(file.read_text(encoding="utf-8"))]
    assert len(named) > 50
    here = [(file, name) for file, name in named if "NAME" not in name and file.name != "CHANGELOG.md"]
    assert not [f"{file.name}: {name}" for file, name in here if not (ROOT / name).exists()]


def test_addresses_are_whole_and_encrypted() -> None:
    found = [(file, url) for file, _, text in texts() for url in URL.findall(text)]
    assert found
    assert not [(str(file.relative_to(ROOT)), url) for file, url in found if malformed(url)]


def test_words_are_spelled_as_in_a_dictionary(known: SpellChecker) -> None:
    places = [
        f"{file.relative_to(ROOT)}:{first + line}: {word}"
        for file, first, text in texts()
        for line, word in unknown_words(text, known)
    ]
    assert not places, "correct these words, or add them to tests/words.txt:\n" + "\n".join(places)


def test_no_word_stands_twice() -> None:
    twice = [
        f"{file.relative_to(ROOT)}: {found[0]}"
        for file, _, text in texts()
        for found in re.finditer(r"\b([a-z]{2,})(?: +|\n *)\1\b(?!-)", prose.NO_WORDS.sub(prose.CUT, text))
    ]
    assert not twice


def test_a_wrong_link_is_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(globals(), "ROOT", tmp_path)
    page = tmp_path / "page.md"
    (tmp_path / "other.md").write_text("# One `two`, three\n\n## A\n\n## A\n\n```\n# none\n```\n", encoding="utf-8")
    page.write_text(
        "[a](other.md#one-two-three) [b](other.md#a-1) ![c](other.md) `[d](x.md)` [e](https://a.org)\n\n"
        "[f](gone.md) [g](other.md#a-2) [h](#none) [i](other.md#none)\n",
        encoding="utf-8",
    )
    wrong = [link.partition(":")[0] for link in dead_links(page)]
    assert wrong == ["gone.md", "other.md#a-2", "#none", "other.md#none"]


@pytest.mark.parametrize(
    ("url", "wrong"),
    [
        ("https://doi.org/10.1016/0045-7825(88)90020-X", False),
        ("https://docs.scipy.org/doc/#a", False),
        ("http://doi.org/10", True),
        ("https://localhost/a", True),
        ("https://a..org/", True),
        ("https://doi.org/a{b}", True),
    ],
)
def test_a_wrong_address_is_found(url: str, wrong: bool) -> None:
    assert malformed(url) == wrong


def test_a_wrong_word_is_found(known: SpellChecker) -> None:
    text = (
        "The link's *equilibium* of `kode`\nhas 3 mm² and MPa; [see](tolerence.md) a tolerence ofthe {CUT} neighbour."
    )
    assert unknown_words(text, known) == [(0, "equilibium"), (1, "tolerence"), (1, "ofthe")]

"""What tests ask of any sheet: its texts, and that they lie on it and beside one another."""

import itertools


def written(sheet):
    return {text.text for text in sheet.texts}


def overlaps(first, second):
    return all(min(first[k + 2], second[k + 2]) - max(first[k], second[k]) > 0.2 for k in (0, 1))


def assert_legible(sheet):
    for text in sheet.texts:
        left, top, right, bottom = text.box
        assert 0.0 <= left < right <= sheet.width, text
        assert 0.0 <= top < bottom <= sheet.height, text
    clashes = [(a.text, b.text) for a, b in itertools.combinations(sheet.texts, 2) if overlaps(a.box, b.box)]
    assert clashes == []

"""What stands below the entries of records is known without their sources."""

import entry_texts


def test_the_texts_are_those_of_the_sources() -> None:
    assert entry_texts.FILE.read_text(encoding="utf-8") == entry_texts.collected(), "make texts renews them"

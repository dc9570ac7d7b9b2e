"""Sentences on runs: studies, tolerances, sizes, second opinions, claims."""

from alula.reports.sentences.catalogue import Sentence

SENTENCES: dict[str, Sentence] = {}

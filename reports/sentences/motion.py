"""Sentences on motions: envelopes, fatigue, natural frequencies, motors."""

from alula.reports.sentences.catalogue import Sentence

SENTENCES: dict[str, Sentence] = {}

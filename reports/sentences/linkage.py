"""Sentences on the linkage as a whole: joint forces, frames, play, pins, displacement, mass, size, clearance."""

from alula.reports.sentences.catalogue import Sentence

SENTENCES: dict[str, Sentence] = {}

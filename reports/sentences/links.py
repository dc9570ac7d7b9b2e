"""Sentences on links by themselves: stress, meshes, solvers, layers, beams, buckling of one link."""

from alula.reports.sentences.catalogue import Sentence

SENTENCES: dict[str, Sentence] = {}

"""The sentences of all reasons, one file a subject: what ``fea`` found is told here and nowhere else."""

from alula.reports.sentences.catalogue import told

__all__ = ["told"]

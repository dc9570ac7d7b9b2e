"""The ways in which a run can end without an answer, each with its exit status."""


class AlulaError(Exception):
    """Base of all errors that alula explains to its user in one sentence."""

    exit_status = 4


class CaseError(AlulaError):
    """The input is wrong: the sentence names the entry, the value, the rule and the remedy."""

    exit_status = 2


class CannotRunError(AlulaError):
    """The input may be right, but the run could not be finished (mesher, memory, disk, library)."""

    exit_status = 4


class CoarseMeshError(CannotRunError):
    """The mesher failed, or its mesh is none of the shape: a finer one may do."""

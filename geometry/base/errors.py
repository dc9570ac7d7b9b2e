"""The ways in which a run can end without an answer, each with its exit status."""

import errno


class AlulaError(Exception):
    """Base of all errors that alula explains to its user in one sentence."""

    exit_status = 4


class CaseError(AlulaError):
    """The input is wrong: the sentence names the entry, the value, the rule and the remedy."""

    exit_status = 2


class CannotRunError(AlulaError):
    """The input may be right, but the run could not be finished (mesher, memory, disk, library)."""

    exit_status = 4


def unwritable(sentence: str, error: OSError) -> AlulaError:
    """Return the error of a place that the user named and that cannot be written.

    Parameters
    ----------
    sentence : str
        What it tells.
    error : OSError
        Of the system.

    Returns
    -------
    AlulaError
        ``CaseError`` where another place would do; ``CannotRunError`` where the disk fails.
    """
    return (CaseError if error.errno in _OF_THE_PLACE else CannotRunError)(sentence)


_OF_THE_PLACE = frozenset(
    (
        errno.ENOENT,
        errno.ENOTDIR,
        errno.EEXIST,
        errno.EISDIR,
        errno.EACCES,
        errno.EPERM,
        errno.EROFS,
        errno.ENAMETOOLONG,
        errno.ELOOP,
    )
)


class CoarseMeshError(CannotRunError):
    """The mesher failed, or its mesh is none of the shape: a finer one may do."""

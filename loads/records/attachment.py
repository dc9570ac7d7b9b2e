"""A point of a link that a spring, a tendon or a load line is fastened to."""

from alula.geometry.base.model import CaseModel, Name


class Attachment(CaseModel):
    """A point of a link, at which something is fastened or led over."""

    link: Name
    """The link."""
    at: Name
    """The point of that link."""

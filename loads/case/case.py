"""The case: its core, and the tables that serve published sources."""

from alula.loads.case.case_rules import check_rules
from alula.loads.case.core import CoreCase
from alula.loads.sources.tables import SourceTables


class Case(SourceTables, CoreCase):
    """A linkage with its pose, drive, parts, loads and checks."""

    def model_post_init(self, context: object) -> None:
        """Check that all names fit together.

        Parameters
        ----------
        context : object
            Of pydantic; not used.

        Raises
        ------
        CaseError
            For the first rule that is broken.
        """
        super().model_post_init(context)
        check_rules(self)
        self.check_tables(self.linkage)

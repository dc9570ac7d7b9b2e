"""The case: its core, and the tables that serve published sources."""

from alula.geometry.base.errors import CaseError
from alula.loads.case.case_rules import check_rules
from alula.loads.case.core import CoreCase
from alula.loads.case.level_case import demanded, with_tests
from alula.loads.sources.tables import SourceTables


class Case(SourceTables, CoreCase):
    """A linkage with its pose, drive, parts, loads and checks."""

    def model_post_init(self, context: object) -> None:
        """Let tests of a level be load cases, and a chosen one all that is asked; check that all names fit together.

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
        if self.level is not None:
            self.__dict__.update(with_tests(self))
        elif not self.load_cases:
            raise CaseError("load_cases: this entry is missing; add it")
        check_rules(self)
        for checks in demanded(self).values():
            self.__dict__["checks"] = {**self.checks, **checks}
        self.check_tables(self.linkage)

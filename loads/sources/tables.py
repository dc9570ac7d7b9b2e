"""The tables of a case file that serve published sources; the core of a case does not know them."""

from collections.abc import Mapping
from typing import Annotated, Any

from pydantic import Field, ValidationError

from alula.geometry.base.errors import CaseError
from alula.geometry.base.model import CaseModel
from alula.geometry.linkage.linkage import Linkage
from alula.geometry.mechanisms.ornithopter import OrnithopterRules
from alula.loads.sources.claim import Claim
from alula.loads.sources.flapping_wing import FlappingWingSpec
from alula.loads.sources.ornithopter import ornithopter_entries
from alula.loads.sources.published_statics import PublishedStatics
from alula.loads.text.explain import require, sentence


class SourceTables(CaseModel):
    """Tables that a case may have besides those of its core; all may be left out."""

    ornithopter: OrnithopterRules | None = None
    """Rules by which ``read_case`` works out the dimensions of the built-in ornithopter or of a copy of it."""
    published_statics: PublishedStatics | None = None
    """A published system of equilibrium equations, to be solved and audited."""
    flapping_wing: FlappingWingSpec | None = None
    """The joints of a flapping wing with one crank and two rockers, whose design figures are to be shown."""
    claims: Annotated[tuple[Claim, ...], Field(max_length=1000)] = ()
    """Published figures about the case, for ``alula claims`` to re-derive."""

    def check_tables(self, linkage: Linkage) -> None:
        """Check that the links and joints that the tables name are there.

        Parameters
        ----------
        linkage : Linkage
            The linkage of the case.

        Raises
        ------
        CaseError
            For the first name that is not.
        """
        for link in self.published_statics.links if self.published_statics else ():
            require("published_statics.links", link, linkage.moving, "is not a moving link")
        if self.flapping_wing is not None:
            self.flapping_wing.wing(linkage)

    @classmethod
    def derived(cls, tables: Mapping[str, Any]) -> dict[str, dict[str, object]]:
        """Work out the entries of a case file that follow from one of these tables.

        Parameters
        ----------
        tables : mapping of str to object
            The case file, not validated.

        Returns
        -------
        dict of str to dict
            Table -> path of an entry -> its value, as the case file states it.

        Raises
        ------
        CaseError
            Where the table is wrong.
        """
        if "ornithopter" not in tables:
            return {}
        try:
            rules = SourceTables.model_validate({"ornithopter": tables["ornithopter"]}).ornithopter
        except ValidationError as error:
            raise CaseError(sentence(error, SourceTables)) from None
        return {} if rules is None else {"ornithopter": ornithopter_entries(rules)}

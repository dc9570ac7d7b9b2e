"""What ``alula.check`` returns."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Literal

from alula.fea.common.band import Band
from alula.fea.common.verdict import CheckOutcome, Verdict
from alula.fea.outcomes.result import CheckResult, LoadCaseResult, SolidResult
from alula.fea.whole.size import size_limits
from alula.geometry.base.errors import CannotRunError, CaseError
from alula.loads.case.heights import layer_of
from alula.reports.check.changes import first_change
from alula.reports.check.whole_check import check_sections
from alula.reports.notebook.shown import ShownPicture, ShownTable, Tabled, pick, summary, table_of
from alula.reports.sections.checks import check_table
from alula.reports.sections.section import Section
from alula.reports.sentences import told
from alula.reports.sentences.verdicts import checks_of, headline, inapplicable

RENAMED = {
    "checks": {
        "low": "value low",
        "high": "value high",
        "unit": "value unit",
        "quantity": "check",
        "sense": "limit sense",
    },
    "links": {
        "low": "safety factor low",
        "high": "safety factor high",
        "worst at x [mm]": "largest at x [mm]",
    },
    "joints": {},
}
"""Names that columns had before -> their names now, for one version."""


@dataclass(frozen=True)
class CheckReport(Tabled):
    """A check of a case, as ``alula check`` makes it.

    Attributes
    ----------
    result : CheckResult
        The record that the numbers come from, with everything else that was found.
    """

    result: CheckResult

    @property
    def verdict(self) -> Verdict:
        """Pass, fail or undecided; equal to the text ``"pass"``, ``"fail"`` or ``"undecided"``."""
        return self.result.verdict

    @property
    def headline(self) -> str:
        """The verdict and its reason in a few sentences."""
        return headline(self._judged)

    @cached_property
    def change(self) -> str:
        """What would change the verdict, with the command that finds a size; empty where nothing is known to."""
        return " ".join(filter(None, first_change(self.sections, said=self.headline)))

    @property
    def warnings(self) -> tuple[str, ...]:
        """One sentence each."""
        return tuple(map(told, self.result.warnings))

    @property
    def load_cases(self) -> tuple[str, ...]:
        """Names of the load cases."""
        return tuple(self.result.load_cases)

    @property
    def safety_factors(self) -> Mapping[str, Band]:
        """Least safety factor of every link over the load cases [1], with its band: ``value``, ``low``, ``high``."""
        return {link: self.result.governing(link).links[link].safety_factor.told for link in self._links}

    @property
    def stresses(self) -> Mapping[str, Band]:
        """Stress that decides the safety factor of every link [MPa]: von Mises, or largest principal if brittle."""
        return {link: self.result.governing(link).links[link].decisive.told for link in self._links}

    @property
    def displacements(self) -> Mapping[str, Band]:
        """Largest displacement of every link from its own pins over the load cases [mm]."""
        cases = self.result.load_cases.values()
        return {
            link: max((case.links[link].displacement_max for case in cases), key=lambda band: band.high).told
            for link in self._links
        }

    @property
    def drive_torques(self) -> Mapping[str, float]:
        """Drive torque of every load case in the undeformed pose, counter-clockwise [N·mm]; empty without a drive."""
        found = self.result.load_cases.items()
        return {name: case.reactions.driving[0] for name, case in found if case.reactions.drive is not None}

    @cached_property
    def sections(self) -> tuple[Section, ...]:
        """All that is told of it, as on the page of ``alula check``."""
        return check_sections(self._told)

    def table(self, of: str = "checks") -> ShownTable:
        """Return a table of the result.

        Parameters
        ----------
        of : str, optional
            ``checks`` with value, band and limit; ``links`` with stress, safety factor and displacement; ``joints``,
            the joint forces in the undeformed pose; or any other table of the page, such as ``pins``, ``gaps``,
            ``ground``, ``masses``, ``frequencies``. All have a row per load case.

        Returns
        -------
        ShownTable
            A sequence of mappings, shown as a table.

        Raises
        ------
        CaseError
            For another table; the error lists those that there are.
        """
        return table_of(self.sections, of, RENAMED.get(of, {}))

    def plot_linkage(self, load_case: str | None = None) -> ShownPicture:
        """Draw the linkage in its pose with the joint forces.

        Parameters
        ----------
        load_case : str, optional
            Its name; the first one when left out.

        Returns
        -------
        ShownPicture

        Raises
        ------
        CaseError
            For a load case that there is not.
        """
        from alula.reports.figures.drawings import linkage_drawing

        name = self.load_cases[0] if load_case is None else load_case
        pick(self.result.load_cases, name, "load case")
        return ShownPicture(linkage_drawing(self.result, name).png())

    def plot_assembly(self) -> ShownPicture:
        """Draw the links in their layers, from above and from the side.

        Returns
        -------
        ShownPicture

        Raises
        ------
        CaseError
            For a case without layers.
        """
        from alula.reports.figures.outlines.assembly import assembly_drawing

        if self.result.clearance is None:
            layer = layer_of(self.result.case.links)
            raise CaseError(f"the case states no layers, so all links lie in one plane; give every link one: {layer}")
        return ShownPicture(assembly_drawing(self.result.clearance).png())

    def plot_box(self) -> ShownPicture:
        """Draw the box about the linkage over its motion, from above and from the side, with the limits of its checks.

        Returns
        -------
        ShownPicture

        Raises
        ------
        CaseError
            For a case without layers and without a check of size.
        """
        from alula.reports.figures.outlines.box import box_drawing

        if self.result.size is None:
            raise CaseError('the box was not found; state layers, or a check with type = "size" and its maximum')
        return ShownPicture(box_drawing(self.result.size, size_limits(self.result.case)).png())

    def plot_clearance(self) -> ShownPicture:
        """Draw the two outlines that touch first over the motion, or come nearest.

        Returns
        -------
        ShownPicture

        Raises
        ------
        CaseError
            For a case without layers, and where nothing lies at one height.
        """
        from alula.reports.figures.outlines.contact import contact_drawing

        if self.result.clearance is None or self.result.clearance.shown is None:
            raise CaseError("no two links lie at one height, so there is no gap to draw; state layers that links share")
        return ShownPicture(contact_drawing(self.result.clearance).png())

    def plot_frequencies(self, what: Literal["campbell", "shapes"] = "campbell") -> ShownPicture:
        """Draw natural frequencies over the motion and the speed of the drive, or the shapes that belong to them.

        Parameters
        ----------
        what : {"campbell", "shapes"}

        Returns
        -------
        ShownPicture
            Of the load case that decides.

        Raises
        ------
        CaseError
            For another picture, and for a case without a check of frequencies.
        """
        from alula.reports.notebook.frequency_report import FrequencyReport

        if self.result.frequencies is None:
            raise CaseError('no check asks for natural frequencies; add one of type = "frequency"')
        report = FrequencyReport(self.result.frequencies)
        return pick({"campbell": report.plot_campbell, "shapes": report.plot_shapes}, what, "picture")()

    def plot_internal_forces(self, link: str) -> ShownPicture:
        """Draw normal force, shear force and bending moment along a link, under the load case that stresses it most.

        Parameters
        ----------
        link : str

        Returns
        -------
        ShownPicture

        Raises
        ------
        CaseError
            For a link that there is not.
        """
        from alula.reports.figures.diagrams import internal_force_diagram

        pick({name: name for name in self._links}, link, "link")
        stations = {point: x for point, (x, _) in self.result.case.links[link].points.items()}
        return ShownPicture(internal_force_diagram(self._case(link, None).links[link].beam, stations).png())

    def plot_build_directions(self, link: str) -> ShownPicture:
        """Draw the safety factor of a printed link's layers for every direction in which it may be built.

        Parameters
        ----------
        link : str
            A link whose part states ``build_direction`` and that was solved as a solid.

        Returns
        -------
        ShownPicture

        Raises
        ------
        CaseError
            For a link without layers, and where nothing is known of them.
        """
        from alula.fea.whole.build_directions import build_directions_of
        from alula.reports.figures.build_map import build_map

        known = {name: one for name, one in build_directions_of(self.result).items() if one.scan is not None}
        return ShownPicture(build_map(pick(known, link, "printed link, solved as a solid,")).png())

    def plot_stress(self, link: str, load_case: str | None = None) -> ShownPicture:
        """Draw the stress of a link on its deformed shape, and around its largest value.

        Parameters
        ----------
        link : str
            A link that was solved as a solid.
        load_case : str, optional
            Its name; the one that stresses the link most when left out.

        Returns
        -------
        ShownPicture

        Raises
        ------
        CaseError
            For a link or load case that there is not, and for a link without a solid model.
        CannotRunError
            Where rendering fails.
        """
        from alula.reports.figures.figures import stress_plots

        pick({name: name for name in self._links}, link, "link")
        found = self._case(link, load_case).links[link]
        if not isinstance(found, SolidResult):
            raise CaseError(
                f'link {link} has no stress field, since {told(found.why)}; check the case with fidelity="solid"'
            )
        plots, warnings = stress_plots({link: found}, {link: self.result.case.links[link].points})
        if link not in plots:
            raise CannotRunError("; ".join(warnings))
        return ShownPicture(plots[link].png())

    def write(self, folder: str | Path, *, progress: Callable[[str], None] = lambda message: None) -> None:
        """Write ``report.html``, ``result.json``, pictures and VTU files into a folder, as ``alula check -o`` does.

        Parameters
        ----------
        folder : str | Path
            The output folder.
        progress : callable, optional
            Receives messages.

        Raises
        ------
        CaseError
            Where files that alula did not write are in the way, and for an empty name.
        CannotRunError
            Where the folder cannot be written.
        """
        from alula.fea.claims.sources import claims_of
        from alula.reports.check.folder import write_report
        from alula.reports.page.output import folder_named

        target = folder_named(folder)
        write_report(self._told, target, claims=claims_of(self.result), progress=progress)

    def __str__(self) -> str:
        checks = checks_of(self.result)
        return "\n\n".join((self.headline, str(_applicable(checks)), *inapplicable(checks)))

    def __repr__(self) -> str:
        return f"<check of {self.result.case.title!r}: {self.verdict}>"

    def _repr_html_(self) -> str:
        checks, title = checks_of(self.result), self.result.case.title
        table, below = _applicable(checks), inapplicable(checks)
        return summary(self.verdict, title, self.headline, table, self.warnings, below)

    @cached_property
    def _judged(self) -> CheckResult:
        """The result with all that its headline tells."""
        from alula.fea.findings.of_check import with_harmonic

        return with_harmonic(self.result)

    @cached_property
    def _told(self) -> CheckResult:
        """The result with all that its pages tell."""
        from alula.fea.findings.of_check import with_findings

        return with_findings(self.result)

    @property
    def _links(self) -> tuple[str, ...]:
        return tuple(next(iter(self.result.load_cases.values())).links)

    def _case(self, link: str, load_case: str | None) -> LoadCaseResult:
        if load_case is None:
            return self.result.governing(link)
        return pick(self.result.load_cases, load_case, "load case")


def _applicable(checks: Sequence[CheckOutcome]) -> ShownTable:
    judged, several = [check for check in checks if check.applies], len({check.load_case for check in checks}) > 1
    return ShownTable.of([check_table(judged, several=several)], RENAMED["checks"])

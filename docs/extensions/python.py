"""The page on the functions for Python, from `alula.__all__` and what those functions return."""

import alula

_RETURNED = (
    "loads.case.case.Case",
    "reports.notebook.check_report.CheckReport",
    "reports.notebook.motion_report.MotionReport",
    "reports.notebook.envelope_report.EnvelopeReport",
    "reports.notebook.study_report.StudyReport",
    "reports.notebook.claims_report.ClaimsReport",
    "reports.notebook.shown.Table",
    "reports.notebook.shown.Picture",
    "fea.common.band.Band",
    "fea.common.verdict.Verdict",
)


def page() -> str:
    """Return the page.

    Returns
    -------
    str
        Markdown whose directives Sphinx fills with the docstrings.
    """
    parts = ["# Python", "```{automodule} alula\n```", "## Functions"]
    parts += [f"### {name}\n\n```{{autofunction}} alula.{name}\n```" for name in alula.__all__]
    return "\n\n".join(parts) + "\n"

"""``alula open``: a page to work in, for the browser of this machine."""

import os
import threading
from pathlib import Path
from typing import Annotated

import typer

from alula.reports.commands import options
from alula.reports.commands.ending import progress

app = typer.Typer()


@app.command("open")
def open_case(
    case: Annotated[
        Path | None,
        typer.Argument(help="Path to a case file; without it, or for a new one, the page offers what to start from."),
    ] = None,
    port: Annotated[
        int, typer.Option(metavar="<number>", min=0, max=65535, help="Port of 127.0.0.1; 0: one that is free.")
    ] = 0,
    browser: Annotated[bool, typer.Option("--browser/--no-browser", help="Open the page in a browser.")] = True,
    threads: options.ThreadsOption = 2,
    memory: options.MemoryOption = None,
) -> None:
    """Open a page to work in: draw, drag, and see the verdict change."""
    from alula.geometry.base.errors import CaseError
    from alula.loads.case.case_file import built_in_cases
    from alula.reports.workbench.app import serve
    from alula.reports.workbench.keeping import case_text, is_missing

    if case is not None:
        if not os.path.exists(case) and str(case) in built_in_cases():
            raise CaseError(
                f"case '{case}': it is a built-in case; write one of your own with "
                f"'alula new my-case.toml --from {case}', and open that"
            )
        if not (case.suffix == ".toml" and is_missing(case) and case.parent.is_dir()):
            case_text(case)

    def ready(address: str) -> None:
        print(f"The page: {address}\nCtrl-C ends it.", flush=True)
        if browser:  # which may come back only when it is closed
            threading.Thread(target=show, args=(address,), daemon=True).start()

    case, folder = (None, Path.cwd()) if case is None else (case.absolute(), case.absolute().parent)
    serve(case, folder, port, ready, threads=threads, memory=memory)


def show(address: str) -> None:
    """Have a browser show a page, and say where there is none.

    Parameters
    ----------
    address : str
    """
    import webbrowser

    try:
        shown = webbrowser.open(address)
    except (webbrowser.Error, OSError):
        shown = False
    if not shown:
        progress("No browser was found; open the address above in one.")

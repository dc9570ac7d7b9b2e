"""What a page may run and load: nothing but what alula put into it."""

import base64
import hashlib
from importlib.resources import files


def sealed(*styles: str, script: str = "") -> dict[str, str]:
    """Return style, script and Content-Security-Policy of a page, for its template.

    The policy allows the style and the script by their SHA-256, and pictures inside of the page. They come from alula's
    own files, never from the finished page, in which the texts of a case stand.

    Parameters
    ----------
    *styles : str
        Names of style sheets among the templates.
    script : str, optional

    Returns
    -------
    dict
        ``style`` and ``script``, the contents of these elements to the letter, and ``policy``, the content of
        ``<meta http-equiv="Content-Security-Policy">``.

    References
    ----------
    W3C, Content Security Policy Level 3.
    """
    style = "".join((files("alula.reports.templates") / name).read_text(encoding="utf-8") for name in styles)
    rules = {
        "default-src": "'none'",
        "script-src": _allowed(script),
        "style-src": _allowed(style),
        "img-src": "data:",
        "base-uri": "'none'",
        "form-action": "'none'",
    }
    return {
        "style": style,
        "script": script,
        "policy": "; ".join(f"{name} {value}" for name, value in rules.items()),
    }


def _allowed(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode('ascii')}'" if text else "'none'"

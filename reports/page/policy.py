"""What a page may run and load: nothing but what alula put into it."""

import base64
import hashlib
import re
from importlib.resources import files


def sealed(*styles: str, script: str = "", running: str = "") -> dict[str, str]:
    """Return style, script and Content-Security-Policy of a page, for its template.

    The policy allows the style and the script by their SHA-256, and pictures inside of the page. They come from alula's
    own files, never from the finished page, in which the texts of a case stand; of what runs along the foot of sheets,
    all signs are escaped that could end a string of CSS.

    Parameters
    ----------
    *styles : str
        Names of style sheets among the templates.
    script : str, optional
    running : str, optional
        What stands at the foot of every printed sheet, beside its number.

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
    if running:
        content = re.sub(r"[^\w .:·…-]", lambda sign: f"\\{ord(sign[0]):x} ", running)
        style += f'@page {{ @bottom-left {{ content: "{content}"; }} }}\n'
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

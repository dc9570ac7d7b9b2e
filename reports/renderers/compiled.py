"""Compiled templates, kept beside Python's own compiled modules: compiling them takes longer than filling them."""

import os
import sys
import tempfile
from contextlib import suppress
from importlib.resources import files
from pathlib import Path

from jinja2 import BytecodeCache
from jinja2.bccache import Bucket


class CompiledTemplates(BytecodeCache):
    """Keeps templates in ``__pycache__`` of their folder, as Python keeps modules, and only where Python keeps these.

    A template that changed, and another version of jinja2 or of Python, is compiled anew; where nothing can be written,
    every run compiles.
    """

    def __init__(self) -> None:
        self.folder = Path(str(files("alula.reports.templates"))) / "__pycache__"

    def load_bytecode(self, bucket: Bucket) -> None:
        """Read a compiled template, if there is one.

        Parameters
        ----------
        bucket : Bucket
        """
        with suppress(OSError), self._of(bucket).open("rb") as stream:
            bucket.load_bytecode(stream)

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Write a compiled template, whole or not at all.

        Parameters
        ----------
        bucket : Bucket
        """
        if sys.dont_write_bytecode:
            return
        with suppress(OSError):
            self.folder.mkdir(exist_ok=True)
            number, name = tempfile.mkstemp(dir=self.folder)
            try:
                with os.fdopen(number, "wb") as stream:
                    bucket.write_bytecode(stream)
                os.replace(name, self._of(bucket))
            except BaseException:
                Path(name).unlink(missing_ok=True)
                raise

    def _of(self, bucket: Bucket) -> Path:
        return self.folder / f"{bucket.key}.{sys.implementation.cache_tag}.jinja"

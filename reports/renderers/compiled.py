"""Compiled templates, kept beside Python's own compiled modules: compiling them takes longer than filling them."""

import os
import sys
from contextlib import suppress
from importlib.resources import files

from jinja2 import FileSystemBytecodeCache
from jinja2.bccache import Bucket


class CompiledTemplates(FileSystemBytecodeCache):
    """Keeps templates in ``__pycache__`` of their folder, as Python keeps modules, and only where Python keeps these.

    A template that changed, and another version of jinja2 or of Python, is compiled anew; where nothing can be written,
    every run compiles.
    """

    def __init__(self) -> None:
        folder = files("alula.reports.templates") / "__pycache__"
        super().__init__(str(folder), f"%s.{sys.implementation.cache_tag}.jinja")

    def load_bytecode(self, bucket: Bucket) -> None:
        """Read a compiled template, if there is one.

        Parameters
        ----------
        bucket : Bucket
        """
        with suppress(OSError):
            super().load_bytecode(bucket)

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Write a compiled template, whole or not at all.

        Parameters
        ----------
        bucket : Bucket
        """
        if not sys.dont_write_bytecode:
            with suppress(OSError):
                os.makedirs(self.directory, exist_ok=True)
                super().dump_bytecode(bucket)

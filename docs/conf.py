"""How Sphinx makes the site (`make docs`): pages of this folder, and those made from models and docstrings."""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from alula.geometry.base.version import alula_version  # noqa: E402
from docs.extensions.gallery import NOT_RUN_PICTURE, not_run, run_pattern  # noqa: E402 - the path comes first

project = "alula"
author = "the alula developers"
project_copyright = "the alula developers, GPL-3.0-or-later"
version = release = alula_version()
language = "en"

extensions = [
    "docs.extensions.pages",
    "docs.extensions.mathml",
    "myst_parser",
    "sphinx.ext.autodoc",
    "numpydoc",
    "sphinx_gallery.gen_gallery",
]
exclude_patterns = ["gallery"]
suppress_warnings = ["config.cache"]

myst_enable_extensions = ["dollarmath", "amsmath", "deflist", "fieldlist", "attrs_block"]
smartquotes = False  # quotation marks belong to TOML
myst_heading_anchors = 4  # a link to a heading works as in a repository browser

autodoc_typehints = "none"  # numpydoc's sections state the types
numpydoc_show_class_members = False
toc_object_entries = False

sphinx_gallery_conf = {
    "examples_dirs": "gallery",
    "gallery_dirs": "generated/gallery",
    "filename_pattern": run_pattern(not_run()),
    "run_stale_examples": True,  # a script that did not change gives other results after a change of alula
    "within_subsection_order": "FileNameSortKey",
    "image_scrapers": ("docs.extensions.gallery.pictures",),
    "reset_modules": (),  # no script changes settings of a library
    "default_thumb_file": str(NOT_RUN_PICTURE),
    "download_all_examples": False,
    "show_signature": False,
    "min_reported_time": 1e9,  # times belong to the benchmarks
    "write_computation_times": False,
}

html_theme = "furo"
html_title = "alula"
html_math_renderer = "mathml"
html_static_path = ["style"]
html_css_files = ["site.css"]
html_search_scorer = str(ROOT / "docs/style/search.js")
html_copy_source = False
html_show_sphinx = False

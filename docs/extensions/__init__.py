"""What Sphinx needs besides its own extensions to make the site: generated pages, formulas, pictures of the gallery."""

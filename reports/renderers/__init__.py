"""How sections become a page, a text on the console, ``result.json``, CSV and tables: none knows a feature."""

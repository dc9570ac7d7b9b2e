"""Numbers, bands and verdicts in words, for console and page alike."""

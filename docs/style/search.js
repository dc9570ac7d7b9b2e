// Order of what a search finds: recipes and entries of the case file first, then what Sphinx makes of the words.
var Scorer = {
  score: ([page, , anchor, , score]) => {
    if (page === "tutorial" || page.startsWith("how-to/")) return score + 60;
    if (page.startsWith("generated/case-file/") && anchor) return score + 40;
    return score;
  },
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 15, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};

// Browsers refuse to read pages from the file system for the lines below each result; the results need none.
if (location.protocol === "file:") DOCUMENTATION_OPTIONS.SHOW_SEARCH_SUMMARY = false;

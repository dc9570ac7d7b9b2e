/** On which line of a TOML text an entry stands. Good for texts that people write; what it cannot read it passes over. */

/** The keys of a dotted key, which may be quoted. */
function keysOf(text) {
  return [...text.matchAll(/"((?:[^"\\]|\\.)*)"|'([^']*)'|([\w-]+)/g)].map(([, double, single, bare]) => double ?? single ?? bare);
}

/** The 1-based line of the entry at a path, or of the nearest table around it that is there; null if none is. */
export function lineOf(text, path) {
  const counts = new Map();
  let table = [];
  let best = { depth: 0, line: null };
  let closing = null; // what ends a value of several lines
  const meet = (found, line) => {
    let depth = 0;
    while (depth < found.length && depth < path.length && String(found[depth]) === String(path[depth])) depth += 1;
    if (depth > best.depth) best = { depth, line };
  };
  for (const [place, line] of text.split("\n").entries()) {
    if (closing) {
      if (line.includes(closing)) closing = null;
      continue;
    }
    const header = line.match(/^\s*\[(\[?)\s*([^\]]+?)\s*\]/);
    if (header) {
      const keys = keysOf(header[2]);
      table = [];
      for (const [depth, name] of keys.entries()) {
        table.push(name);
        const known = JSON.stringify(table);
        if (header[1] && depth === keys.length - 1) counts.set(known, (counts.get(known) ?? -1) + 1);
        if (counts.has(known)) table.push(counts.get(known));
      }
      meet(table, place + 1);
      continue;
    }
    const entry = line.match(/^\s*((?:"(?:[^"\\]|\\.)*"|'[^']*'|[\w-]+)(?:\s*\.\s*(?:"(?:[^"\\]|\\.)*"|'[^']*'|[\w-]+))*)\s*=(.*)$/);
    if (!entry) continue;
    meet([...table, ...keysOf(entry[1])], place + 1);
    for (const quotes of ['"""', "'''"]) if (entry[2].trim().startsWith(quotes) && entry[2].split(quotes).length === 2) closing = quotes;
  }
  return best.line;
}

/** The path of the entry that is selected in the drawing. */
export function pathOf(selected) {
  if (!selected) return null;
  const { kind, name, link, point, path } = selected;
  return { link: ["links", name], joint: ["joints", name], point: ["links", link, "points", point], load: path }[kind] ?? null;
}

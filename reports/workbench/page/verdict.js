/** The verdict: what decides it, what would change it, and how hand and solid differ. */

import { command, make, number } from "./elements.js";
import { edit } from "./server.js";
import { same } from "./store.js";

const STAGES = { linear: "so far, by hand; limit load and buckling follow", whole: "by hand, whole", solids: "with solids" };
const ORDER = { fail: 0, undecided: 1, pass: 2 };
const time = (seconds) => (seconds < 1 ? `${Math.round(1000 * seconds)} ms` : `${number(Number(seconds.toPrecision(2)))} s`);

/** How much of its limit a check uses; above 1 it fails. Which side of the limit is safe tells the verdict's own sense. */
function use(check) {
  if (!(check.limit > 0) || !(check.value > 0)) return 0;
  const least = /factor|frequency|gap|clearance|life|cycles/.test(check.type) || check.sense === "least";
  return least ? check.limit / (check.low ?? check.value) : (check.high ?? check.value) / check.limit;
}

/** Checks with the worst first. */
const sorted = (checks) => [...checks].sort((a, b) => (ORDER[a.verdict] ?? 1) - (ORDER[b.verdict] ?? 1) || use(b) - use(a));

/** The verdict that is shown: solids where they are of the newest revision, otherwise the most that the hand knows. */
export function shownVerdict({ linear, whole, solids }) {
  const newest = Math.max(...[linear, whole, solids].map((one) => one?.revision ?? -1));
  return [solids, whole, linear].find((one) => one && one.revision === newest) ?? null;
}

const band = ({ low, high }) => (low === null || low === undefined || high === null || high === undefined || low === high ? "" : `${number(low)} to ${number(high)}`);

export function mount(holder, store) {
  const stamp = make("p", { class: "stamp-line", role: "status", "aria-live": "polite" });
  const rest = make("div");
  const open = new Set();
  holder.append(stamp, rest);

  function draw() {
    const found = shownVerdict(store.state.verdict);
    const now = store.state.document;
    const late = found && now && (found.revision < now.revision || now.problem);
    holder.classList.toggle("old", Boolean(late));
    stamp.replaceChildren(...badge(found, now));
    if (!found) return rest.replaceChildren();
    const linkOf = (subject) => Object.keys(found.links ?? {}).find((name) => name === subject) ?? null;
    rest.replaceChildren(...[
      ...(found.sentences ?? []).map((sentence) => make("p", {}, sentence)),
      changes(found),
      table(found, linkOf),
      sideBySide(),
      warnings(found),
    ].flat().filter(Boolean));
  }

  function badge(found, now) {
    if (!found) return [make("span", { class: "soft" }, now?.problem ? "No verdict: mend the case first." : "The verdict is being computed ...")];
    const computing = !now?.problem && (found.revision < (now?.revision ?? 0) || found.stage === "linear");
    const running = store.state.solids?.state === "running" ? "solids are being solved" : "";
    return [
      make("strong", { class: `stamp ${found.verdict}` }, found.verdict),
      make("span", { class: "soft" }, [STAGES[found.stage], time((found.ms ?? 0) / 1000), computing ? "being computed ..." : "", running].filter(Boolean).join("; ")),
    ];
  }

  function changes(found) {
    if (!found.changes?.length) return null;
    const one = ({ text, command: typed, operations }) => make("li", {}, text, " ",
      operations?.length ? make("button", { type: "button", onclick: () => edit(operations).catch(() => {}) }, "Apply") : typed ? command(typed) : null);
    return [make("h2", {}, "What would change it"), make("ul", { class: "changes" }, ...found.changes.map(one))];
  }

  function table(found, linkOf) {
    const chosen = store.state.selected;
    const row = (check) => {
      const link = linkOf(check.subject);
      const subject = link
        ? make("button", { type: "button", class: "plain", onclick: () => store.put("selected", { kind: "link", name: link }) }, check.subject)
        : check.subject;
      return make("tr", { class: link && same(chosen, { kind: "link", name: link }) ? "chosen" : null },
        make("td", {}, make("span", { class: `mark ${check.verdict}` }, check.verdict)),
        make("td", {}, subject, make("small", {}, ` ${[check.check, check.load_case].filter(Boolean).join(", ")}`)),
        make("td", { class: "num" }, number(check.value), band(check) ? make("small", {}, ` ${band(check)}`) : null),
        make("td", { class: "num" }, `${number(check.limit)}${check.unit && check.unit !== "1" ? ` ${check.unit}` : ""}`),
      );
    };
    const all = sorted(found.checks ?? []);
    if (!all.length) return null;
    const head = make("tr", {}, ...["verdict", "of", "value, band", "limit"].map((title, place) => make("th", { scope: "col", class: place > 1 ? "num" : null }, title)));
    return [make("h2", {}, "Checks, the worst first"), make("div", { class: "wide" }, make("table", {}, make("thead", {}, head), make("tbody", {}, ...all.map(row))))];
  }

  /** Bands by hand and of the solid on one scale, for each link that both have. */
  function sideBySide() {
    const { whole, linear, solids } = store.state.verdict;
    const hand = whole ?? linear;
    if (!hand || !solids) return null;
    const keyOf = (check) => [check.check, check.subject, check.load_case].join("\n");
    const by = new Map(hand.checks.map((check) => [keyOf(check), check]));
    const pairs = sorted(solids.checks).map((solid) => [by.get(keyOf(solid)), solid]).filter(([one, other]) => one && other.value > 0 && one.value > 0);
    if (!pairs.length) return null;
    const links = new Map();
    for (const pair of pairs) if (!links.has(pair[1].subject)) links.set(pair[1].subject, pair);
    const took = (name) => {
      const seconds = store.state.solids?.links?.[name]?.seconds;
      return seconds === null || seconds === undefined ? "" : `, ${time(seconds)}`;
    };
    const figures = [...links].map(([name, [one, other]]) => make("figure", {}, make("figcaption", {}, name, make("small", {}, ` ${other.check}${other.unit && other.unit !== "1" ? ` [${other.unit}]` : ""}`)), bands(name, one, other, took(name))));
    return [
      make("h2", {}, "By hand and as a solid"),
      make("p", { class: "soft" }, `All links by hand took ${time((hand.ms ?? 0) / 1000)}. A bar is the band of a value; the upright line is the limit.`,
        hand.revision === solids.revision ? "" : " The solids are of an earlier state of the case."),
      ...figures,
    ];
  }

  function warnings(found) {
    if (!found.warnings?.length) return null;
    const box = make("details", { open: open.has("warnings") }, make("summary", {}, `${found.warnings.length} warning${found.warnings.length > 1 ? "s" : ""}`), make("ul", {}, ...found.warnings.map((one) => make("li", {}, one))));
    box.addEventListener("toggle", () => open[box.open ? "add" : "delete"]("warnings"));
    return box;
  }

  for (const key of ["verdict", "document", "selected", "solids"]) store.on(key, draw);
  draw();
}

/** Two bars on a common logarithmic scale, with the limit. */
function bands(name, hand, solid, took) {
  const ends = ({ low, high, value }) => [low ?? value, high ?? value].map((end) => Math.max(end, 1e-9));
  const all = [...ends(hand), ...ends(solid), ...(solid.limit > 0 ? [solid.limit] : [])];
  const [least, most] = [Math.min(...all) / 1.15, Math.max(...all) * 1.15];
  const x = (value) => 76 + (220 * Math.log(value / least)) / Math.log(most / least);
  const bar = (kind, check, y) => {
    const [low, high] = ends(check);
    return make("g", {},
      make("text", { x: 70, y: y + 9, "text-anchor": "end" }, kind),
      make("rect", { x: x(low), y, width: Math.max(3, x(high) - x(low)), height: 11, class: `bar ${check.verdict}` }),
      make("line", { x1: x(check.value), x2: x(check.value), y1: y - 1, y2: y + 12, class: "value" }));
  };
  const told = (kind, check) => `${kind} ${number(check.value)}${band(check) ? ` (${band(check)})` : ""}`;
  const limit = solid.limit > 0 ? [
    make("line", { x1: x(solid.limit), x2: x(solid.limit), y1: 2, y2: 42, class: "limit" }),
    make("text", { x: x(solid.limit), y: 53, "text-anchor": "middle" }, `limit ${number(solid.limit)}`),
  ] : [];
  const label = `${name}: ${told("by hand", hand)}; ${told("solid", solid)}; limit ${number(solid.limit)}`;
  return [
    make("svg", { viewBox: "0 0 306 56", role: "img", "aria-label": label, class: "bands" }, bar("by hand", hand, 6), bar("solid", solid, 26), ...limit),
    make("p", { class: "soft" }, `${told("By hand", hand)}; ${told("solid", solid)}${took}.`),
  ];
}

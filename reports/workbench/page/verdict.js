/** The verdict: what decides it, what would change it, and how hand and solid differ. */

import { keepingFocus, make, number } from "./elements.js";
import { edit, send, tell } from "./server.js";
import { same } from "./store.js";

const STAGES = { linear: "so far, by hand; limit load and buckling follow", whole: "by hand, whole", solids: "with solids" };
const time = (seconds) => (seconds < 1 ? `${Math.round(1000 * seconds)} ms` : `${number(Number(seconds.toPrecision(2)))} s`);

/** The verdict that is shown: solids where they are of the newest revision, otherwise the most that the hand knows. */
export function shownVerdict({ linear, whole, solids }) {
  const newest = Math.max(...[linear, whole, solids].map((one) => one?.revision ?? -1));
  return [solids, whole, linear].find((one) => one && one.revision === newest) ?? null;
}

/** A band in words; an end that is null is not known, or there is none. */
function band({ low, high, value }) {
  const [known, most] = [low ?? null, high ?? null];
  if (known === null && most === null) return "";
  if (known === null) return `up to ${number(most)}`;
  if (most === null) return `${number(known)} or more`;
  return known === most && known === value ? "" : `${number(known)} to ${number(most)}`;
}

/** The badge of a verdict, faint where it is of an earlier state of the case. */
export const stamp = (found, late = false, ...more) => make("strong", { class: `stamp ${found.verdict} ${late ? "late" : ""}` }, found.verdict, ...more);

export function mount(holder, store) {
  const brief = document.getElementById("brief"); // stands above the drawing, whichever panel is open
  brief.addEventListener("click", () => store.put("panel", "verdict"));
  const line = make("p", { class: "stamp-line", role: "status", "aria-live": "polite" });
  const rest = make("div");
  let open = false;
  holder.append(line, rest);

  /** What is known; a problem of the case stands above the drawing, and is no verdict. */
  function known() {
    const found = shownVerdict(store.state.verdict);
    return store.state.document?.problem && !found?.checks?.length ? null : found;
  }

  /** The badge, and whether the verdict is of what stands there now. */
  function head() {
    const found = known();
    const now = store.state.document;
    const late = found && now && (found.revision < now.revision || now.problem);
    holder.classList.toggle("old", Boolean(late));
    line.replaceChildren(...badge(found, now));
    brief.replaceChildren(found?.verdict ?? "no verdict", make("small", {}, found ? (found.stage === "solids" ? " with solids" : " by hand") : ""));
    brief.className = `stamp ${found?.verdict ?? ""} ${late ? "late" : ""}`;
    brief.hidden = !now?.path;
  }

  function draw() {
    head();
    const found = known();
    const now = store.state.document;
    if (!found) return rest.replaceChildren();
    const names = (table) => Object.keys(now?.tables?.[table] ?? {});
    const subjectOf = (name) => (names("links").includes(name) ? { kind: "link", name } : names("joints").includes(name) ? { kind: "joint", name } : null);
    rest.replaceChildren(...[
      ...(found.sentences ?? []).map((sentence) => make("p", {}, sentence)),
      found.stage !== "solids" && found.checks.length ? make("p", {}, make("button", { type: "button", onclick: solve, disabled: store.state.solids?.state === "running" }, "Check with solids")) : null,
      changes(found),
      sideBySide(),
      table(found, subjectOf),
      warnings(found),
    ].flat().filter(Boolean));
  }

  function solve() {
    store.put("panel", "solids");
    send("solids", { do: "start" }).catch(({ message }) => tell(message));
  }

  function badge(found, now) {
    if (!found) return [make("span", { class: "soft" }, now?.problem ? "No verdict yet: the case is not whole." : "The verdict is being computed ...")];
    const computing = !now?.problem && (found.revision < (now?.revision ?? 0) || found.stage === "linear");
    return [
      stamp(found),
      make("span", { class: "soft" }, [STAGES[found.stage], time((found.ms ?? 0) / 1000), computing ? "being computed ..." : ""].filter(Boolean).join("; ")),
    ];
  }

  function changes(found) {
    if (found.changes?.length === 0) return null;
    const sought = found.verdict === "pass" ? "It is being tried ..." : "A section that passes is sought ...";
    const one = ({ text, operations }) => make("li", {}, text, " ", operations?.length ? make("button", { type: "button", onclick: () => edit(operations).catch(() => {}) }, "Apply") : null);
    return [make("h2", {}, "What would change it"), found.changes ? make("ul", { class: "changes" }, ...found.changes.map(one)) : make("p", { class: "soft" }, sought)];
  }

  function table(found, subjectOf) {
    const chosen = store.state.selected;
    const row = (check) => {
      const selected = subjectOf(check.subject);
      const subject = selected
        ? make("button", { type: "button", class: "plain", onclick: () => store.put("selected", selected) }, check.subject)
        : check.subject;
      return make("tr", { class: selected && same(chosen, selected) ? "chosen" : null },
        make("td", {}, make("span", { class: `mark ${check.verdict}` }, check.verdict)),
        make("td", {}, subject, make("small", {}, ` ${[check.quantity ?? check.check, check.load_case].filter(Boolean).join(", ")}`)),
        make("td", { class: "num" }, number(check.value), band(check) ? make("small", {}, ` ${band(check)}`) : null),
        make("td", { class: "num" }, `${number(check.limit)}${check.unit && check.unit !== "1" ? ` ${check.unit}` : ""}`),
      );
    };
    const all = found.checks ?? []; // the server has them with the worst first
    if (!all.length) return null;
    const alike = Map.groupBy(all, (check) => check.text);
    /** A reason stands once, below the last of the checks that have it. */
    const why = (check) => {
      const same = alike.get(check.text);
      if (check.verdict === "pass" || !check.text || check !== same.at(-1)) return null;
      const names = same.length > 1 ? `${[...new Set(same.map((one) => one.subject))].join(", ")}: ` : "";
      return make("tr", { class: "why" }, make("td", { colspan: 4 }, names + check.text));
    };
    const head = make("tr", {}, ...["verdict", "of", "value, band", "limit"].map((title, place) => make("th", { scope: "col", class: place > 1 ? "num" : null }, title)));
    return [make("h2", {}, "Checks, the worst first"), make("div", { class: "wide" }, make("table", {}, make("thead", {}, head), make("tbody", {}, ...all.flatMap((check) => [row(check), why(check)]))))];
  }

  /** Bands by hand and of the solid on one scale, for each link that both have. */
  function sideBySide() {
    const { whole, linear, solids } = store.state.verdict;
    const hand = whole ?? linear;
    if (!hand || !solids) return null;
    const keyOf = (check) => [check.check, check.quantity, check.subject, check.load_case].join("\n");
    const by = new Map(hand.checks.map((check) => [keyOf(check), check]));
    const pairs = solids.checks.map((solid) => [by.get(keyOf(solid)), solid]).filter(([one, other]) => one && other.value > 0 && one.value > 0);
    if (!pairs.length) return null;
    const figures = [...Map.groupBy(pairs, ([, solid]) => solid.subject)].map(([name, [[one, other]]]) => make("figure", {}, make("figcaption", {}, name, make("small", {}, ` ${other.quantity ?? other.check}${other.unit && other.unit !== "1" ? ` [${other.unit}]` : ""}`)), bands(name, one, other)));
    return [
      make("h2", {}, "By hand and as a solid"),
      make("p", { class: "soft" }, `All links took ${time(hand.ms / 1000)} by hand and ${time(solids.ms / 1000)} as solids. A bar is the band of a value; the upright line is the limit.`,
        hand.revision === solids.revision ? "" : " The solids are of an earlier state of the case."),
      ...figures,
    ];
  }

  function warnings(found) {
    if (!found.warnings?.length) return null;
    const box = make("details", { open }, make("summary", {}, `${found.warnings.length} warning${found.warnings.length > 1 ? "s" : ""}`), make("ul", {}, ...found.warnings.map((one) => make("li", {}, one))));
    box.addEventListener("toggle", () => (open = box.open));
    return box;
  }

  for (const key of ["verdict", "selected", "solids"]) store.on(key, () => keepingFocus(rest, draw));
  store.on("document", head);
  draw();
}

/** Two bars on a common logarithmic scale, with the limit. */
function bands(name, hand, solid) {
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
    make("p", { class: "soft" }, `${told("By hand", hand)}; ${told("solid", solid)}.`),
  ];
}

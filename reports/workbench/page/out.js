/** What leaves the page: report, picture, case, STEP; commands for a study and a least size; and what comes in. */

import { command, handOut, make, offer, unused } from "./elements.js";
import { mountDrop } from "./drop.js";
import { ask, tell } from "./server.js";
import { shownVerdict } from "./verdict.js";

const SHAPES = "fill fill-opacity stroke stroke-width stroke-dasharray stroke-linecap stroke-linejoin stroke-opacity opacity font-family font-size font-weight text-anchor dominant-baseline display visibility paint-order vector-effect marker-start marker-end".split(" ");
const SCALE = 2; // pixels of the PNG to those of the screen

/** The drawing as it is seen: what style sheets say stands in its elements. */
function pictureOf(seen) {
  const copy = seen.cloneNode(true);
  const box = seen.getBoundingClientRect();
  const from = [seen, ...seen.querySelectorAll("*")];
  const to = [copy, ...copy.querySelectorAll("*")];
  for (const [place, element] of from.entries()) {
    const style = getComputedStyle(element);
    for (const name of SHAPES) to[place].setAttribute(name, style.getPropertyValue(name));
    for (const name of ["class", "style", "tabindex", "role"]) to[place].removeAttribute(name);
  }
  for (const hidden of to.filter((element) => element.getAttribute("display") === "none")) hidden.remove();
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  copy.setAttribute("width", box.width);
  copy.setAttribute("height", box.height);
  if (!copy.hasAttribute("viewBox")) copy.setAttribute("viewBox", `0 0 ${box.width} ${box.height}`);
  return { text: new XMLSerializer().serializeToString(copy), width: box.width, height: box.height };
}

async function pngOf({ text, width, height }) {
  const image = new Image(width, height);
  image.src = URL.createObjectURL(new Blob([text], { type: "image/svg+xml" }));
  await image.decode();
  const canvas = make("canvas", { width: Math.round(SCALE * width), height: Math.round(SCALE * height) });
  const pen = canvas.getContext("2d");
  pen.fillStyle = "#ffffff";
  pen.fillRect(0, 0, canvas.width, canvas.height);
  pen.drawImage(image, 0, 0, canvas.width, canvas.height);
  URL.revokeObjectURL(image.src);
  return new Promise((resolve) => canvas.toBlob(resolve, "image/png"));
}

/** A word as a shell takes it, whatever stands in it. */
const quoted = (text) => (/^[\w./:=,+-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

/** Half to double of a stated quantity, as a range; null for what has none. */
function rangeOf(value) {
  const found = typeof value === "string" && value.match(/^\s*(\d+\.?\d*|\.\d+)\s*(\S.*)$/);
  if (!found || !Number(found[1])) return null;
  const [low, high] = [0.5, 2].map((factor) => Number((factor * Number(found[1])).toPrecision(3)));
  return `${low} ${found[2].trim()}..${high} ${found[2].trim()}`;
}

export function mount(holder, store) {
  const stem = () => (store.state.document?.name ?? "case").replace(/^.*[/\\]/, "").replace(/\.toml$/, "");
  const said = make("p", { role: "status", "aria-live": "polite", class: "soft" });
  const steps = make("select", { id: unused() });
  const asked = make("div");
  const button = (title, act) => make("button", { type: "button", onclick: act }, title);

  /** Fetch a file and hand it out; `open` shows it in a tab of its own, which is opened by the click itself. */
  async function fetched(route, name, doing) {
    said.textContent = doing;
    try {
      handOut(name, await (await ask(route)).blob());
      said.textContent = `${name} is downloaded.`;
    } catch (problem) {
      said.textContent = problem.message;
    }
  }

  async function picture(kind) {
    const seen = document.querySelector("#plane svg");
    if (!seen) return tell("There is no drawing yet.");
    const made = pictureOf(seen);
    const blob = kind === "svg" ? new Blob([made.text], { type: "image/svg+xml" }) : await pngOf(made);
    handOut(`${stem()}.${kind}`, blob);
  }

  function commands() {
    const path = store.state.entry;
    const value = path?.reduce((inside, step) => inside?.[step], store.state.document?.tables);
    const range = rangeOf(value);
    const file = quoted(store.state.document?.name ?? "case.toml");
    const sizes = (store.state.verdict.whole?.changes ?? []).map((change) => change.command).filter(Boolean);
    asked.replaceChildren(range
      ? make("p", {}, `Study ${path.join(".")}, which is ${value}, from half to double: `, command(`alula study ${file} --vary ${quoted(`${path.join(".")}=${range}/7`)} -o ${quoted(`${stem()}-study`)}`))
      : make("p", { class: "soft" }, "Choose an entry with a unit under Entries, such as the width of a part: the command for a study of it stands here then."),
      ...sizes.map((one) => make("p", {}, "Least size: ", command(one))));
  }

  function draw() {
    const found = shownVerdict(store.state.verdict);
    report.href = `out/report?fidelity=${found?.stage === "solids" ? "solid" : "beam"}`;
    report.textContent = found?.stage === "solids" ? "Report, with solids" : "Report, by hand";
    const links = (store.state.drawn?.links ?? []).filter((link) => link.part).map((link) => link.name);
    offer(steps, links);
    commands();
  }

  const report = make("a", { href: "out/report", target: "_blank", rel: "noopener", class: "button", onclick: () => (said.textContent = "The report is made, and opens in a tab of its own.") }, "Report");
  holder.append(
    make("h2", {}, "Take with you"),
    make("p", { class: "row" }, report, button("Case file", () => fetched("out/case", `${stem()}.toml`, "")), button("Picture, SVG", () => picture("svg")), button("Picture, PNG", () => picture("png"))),
    make("p", { class: "row" }, make("label", { for: steps.id }, "Solid of "), steps, button("STEP", () => steps.value && fetched(`out/step/${encodeURIComponent(steps.value)}`, `${steps.value}.step`, "The solid is being built ..."))),
    said,
    make("h2", {}, "Ask for more"),
    asked,
  );
  mountDrop(holder, store);
  for (const key of ["verdict", "drawn", "document", "entry", "panel"]) store.on(key, draw);
  draw();
}

/** What leaves the page: report, picture, case, STEP; commands for a study and a least size; and what comes in. */

import { command, handOut, make, offer, set, unused } from "./elements.js";
import { mountDrop } from "./drop.js";
import { ask } from "./server.js";
import { shownVerdict } from "./verdict.js";

const SHAPES = "fill fill-opacity stroke stroke-width stroke-dasharray stroke-linecap stroke-linejoin stroke-opacity opacity font-family font-size font-weight text-anchor dominant-baseline display visibility paint-order vector-effect marker-start marker-end".split(" ");
const SCALE = 2; // pixels of the PNG to those of the screen

/** A drawing as it is seen: what style sheets say stands in its elements. */
function copyOf(seen, frame) {
  const copy = seen.cloneNode(true);
  const from = [seen, ...seen.querySelectorAll("*")];
  const to = [copy, ...copy.querySelectorAll("*")];
  for (const [place, element] of from.entries()) {
    const style = getComputedStyle(element);
    for (const name of SHAPES) to[place].setAttribute(name, style.getPropertyValue(name));
    for (const name of ["class", "style", "tabindex", "role"]) to[place].removeAttribute(name);
  }
  for (const hidden of to.filter((element) => element.getAttribute("display") === "none")) hidden.remove();
  const { left, top, width, height } = seen.getBoundingClientRect();
  return set(copy, { x: left - frame.left, y: top - frame.top, width, height });
}

/** A line of the legend: a mark, and what it means. */
function lineOf(seen, frame) {
  const mark = seen.querySelector("i");
  const [at, box] = [mark ?? seen, seen].map((one) => one.getBoundingClientRect());
  const { color, fontFamily, fontSize } = getComputedStyle(seen);
  const fill = mark?.matches(".over") ? "url(#hatch)" : mark && getComputedStyle(mark).backgroundColor;
  return make("g", {},
    mark && make("rect", { x: at.left - frame.left, y: at.top - frame.top, width: at.width, height: at.height, fill, stroke: mark.matches(".use") ? color : null }),
    make("text", { x: (mark ? at.right + 5 : box.left) - frame.left, y: box.bottom - 5 - frame.top, fill: color, "font-family": fontFamily, "font-size": fontSize }, seen.textContent));
}

/** What is seen of the linkage: plane, legend and layers. */
function picture() {
  const [sheet, layers] = ["sheet", "layers"].map((id) => document.getElementById(id));
  const frame = sheet.getBoundingClientRect();
  const [width, height] = [frame.width, layers.getBoundingClientRect().bottom - frame.top];
  const legend = [...document.querySelectorAll("#legend span")].map((one) => lineOf(one, frame));
  const whole = make("svg", { width, height, viewBox: `0 0 ${width} ${height}` }, copyOf(sheet, frame), legend, copyOf(layers, frame));
  return { text: new XMLSerializer().serializeToString(whole), width, height };
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

/** Entries that are quantities, by name: [name, value]. */
function* quantities(value, name = "") {
  if (rangeOf(value)) yield [name, value];
  else if (value && typeof value === "object") for (const [key, inner] of Object.entries(value)) yield* quantities(inner, name ? `${name}.${key}` : key);
}

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
  const [asked, found] = [make("div"), make("div")];
  const button = (title, act) => make("button", { type: "button", onclick: act }, title);
  const entry = make("select", { id: unused(), onchange: () => asked.replaceChildren() });
  const [study, size] = [button("Study this", () => write("study")), button("Least size", () => write("size"))];
  let stated = new Map();

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

  async function drawn(kind) {
    const made = picture();
    handOut(`${stem()}.${kind}`, kind === "svg" ? new Blob([made.text], { type: "image/svg+xml" }) : await pngOf(made));
  }

  /** Write what asks for more about the entry that is chosen. */
  function write(what) {
    const range = quoted(`${entry.value}=${rangeOf(stated.get(entry.value))}`);
    const file = quoted(store.state.document.name);
    const text = what === "size" ? `alula size ${file} --vary ${range}` : `alula study ${file} --vary ${range}/7 -o ${quoted(`${stem()}-study`)}`;
    asked.replaceChildren(make("p", {}, `${entry.value}, which is ${stated.get(entry.value)}, from half to double: `, command(text)));
  }

  /** Offer entries that are quantities; one that is stepped on under Entries is chosen. */
  function entries() {
    const tables = store.state.document?.tables ?? {};
    stated = new Map([...quantities({ parts: tables.parts }), ...quantities(tables)]); // sizes first
    offer(entry, [...stated.keys()]);
    for (const one of [study, size]) one.disabled = !stated.size;
    const sizes = (store.state.verdict.whole?.changes ?? []).map((change) => change.command).filter(Boolean);
    found.replaceChildren(...sizes.map((one) => make("p", {}, "Least size, as the verdict has it: ", command(one))));
  }

  function draw() {
    const found = shownVerdict(store.state.verdict);
    report.href = `out/report?fidelity=${found?.stage === "solids" ? "solid" : "beam"}`;
    report.textContent = found?.stage === "solids" ? "Report, with solids" : "Report, by hand";
    const links = (store.state.drawn?.links ?? []).filter((link) => link.part).map((link) => link.name);
    offer(steps, links);
    entries();
  }

  const report = make("a", { href: "out/report", target: "_blank", rel: "noopener", class: "button", onclick: () => (said.textContent = "The report is made, and opens in a tab of its own.") }, "Report");
  holder.append(
    make("h2", {}, "Take with you"),
    make("p", { class: "row" }, report, button("Case file", () => fetched("out/case", `${stem()}.toml`, "")), button("Picture, SVG", () => drawn("svg")), button("Picture, PNG", () => drawn("png"))),
    make("p", { class: "row" }, make("label", { for: steps.id }, "Solid of "), steps, button("STEP", () => steps.value && fetched(`out/step/${encodeURIComponent(steps.value)}`, `${steps.value}.step`, "The solid is being built ..."))),
    said,
    make("h2", {}, "Ask for more"),
    make("p", { class: "row" }, make("label", { for: entry.id }, "Entry "), entry, study, size),
    asked, found,
  );
  mountDrop(holder, store);
  for (const key of ["verdict", "drawn", "document", "panel"]) store.on(key, draw);
  store.on("entry", (path) => stated.has(path.join(".")) && (entry.value = path.join(".")));
  draw();
}

/** Links as solids: asked for or by itself after a pause, how far they are, and their models to turn. */

import { keepingFocus, make, number } from "./elements.js";
import { send, tell } from "./server.js";
import { stamp } from "./verdict.js";

const PAUSE = 3000; // ms without a change until solids are solved by themselves
const STATES = { waiting: "waits", solving: "is being solved ...", done: "solved", kept: "kept from before" };

export function mount(holder, store) {
  const verdict = make("p");
  const said = make("p", { role: "status", "aria-live": "polite" });
  const start = make("button", { type: "button", onclick: () => ask("start") }, "Check with solids");
  const stop = make("button", { type: "button", onclick: () => ask("stop"), disabled: true }, "Stop");
  const auto = make("input", { type: "checkbox", id: "solids-auto", onchange: later });
  const list = make("table", {}, make("caption", { class: "soft" }, "Links"), make("tbody"));
  const figures = make("div", { class: "models" });
  let shown = null; // {name, model} of what stands on the page: the link, and the number of its model
  let turned = null; // what the viewer shows of it
  let pause = null;
  let begun = -1; // the revision that solids were last started of by themselves

  holder.append(
    verdict,
    make("p", { class: "row" }, start, stop),
    make("p", { class: "row" }, auto, make("label", { for: auto.id }, "by itself, three seconds after the last change")),
    said, list, figures,
  );

  const ask = (doing) => send("solids", { do: doing }).catch(({ message }) => tell(message));

  function later() {
    clearTimeout(pause);
    const now = store.state.document;
    if (!auto.checked || !now || now.problem || now.revision === begun) return;
    pause = setTimeout(() => {
      begun = now.revision;
      ask("start");
    }, PAUSE);
  }

  function draw() {
    const now = store.state.solids;
    const found = store.state.verdict.solids;
    verdict.replaceChildren(...(found ? [stamp(found, found.revision < store.state.document?.revision), ` ${found.sentences[0]}`] : []));
    const running = now?.state === "running";
    start.disabled = running || Boolean(store.state.document?.problem);
    stop.disabled = !running;
    const stale = now && store.state.document && now.revision < store.state.document.revision && now.state !== "idle";
    said.textContent = [now?.sentence, stale ? "The case has changed since." : ""].filter(Boolean).join(" ");
    const links = Object.entries(now?.links ?? {});
    list.hidden = !links.length;
    list.tBodies[0].replaceChildren(...links.map(([name, { state, seconds, model }]) => {
      const turn = model ? make("button", { type: "button", "aria-pressed": String(name === shown?.name), onclick: () => show(name, model) }, "Model") : null;
      return make("tr", {}, make("th", { scope: "row" }, name), make("td", {}, STATES[state] ?? state), make("td", { class: "num" }, seconds ? `${number(Number(seconds.toPrecision(2)))} s` : ""), make("td", {}, turn));
    }));
    const [name, next] = links.find(([one, { model }]) => model && (!shown || (one === shown.name && model !== shown.model))) ?? [];
    if (next) show(name, next.model);
  }

  /** Fetch the model of a link and let the viewer show it; one stands on the page at a time. */
  async function show(name, model) {
    shown = { name, model };
    try {
      const record = await send(`model/${encodeURIComponent(name)}`);
      await viewer();
      if (shown.name !== name || shown.model !== model) return; // another one was asked for meanwhile
      turned?.remove();
      const figure = make("figure", {}, make("figcaption", {}, name));
      figures.replaceChildren(figure);
      turned = window.alulaViewer.show(figure, "link", JSON.stringify(record));
      if (!turned) figure.append("This browser shows no model, since it has no WebGL.");
    } catch (problem) {
      tell(problem.message);
    }
  }

  for (const key of ["solids", "document", "verdict"]) store.on(key, () => keepingFocus(list, draw));
  store.on("document", later);
  draw();
}

let loaded = null;

/** The script that draws models, fetched when the first one is asked for. */
function viewer() {
  loaded ??= new Promise((resolve, reject) => {
    document.head.append(make("link", { rel: "stylesheet", href: "page/turnable.css" }));
    document.head.append(make("script", { src: "page/viewer.js", onload: resolve, onerror: () => reject(new Error("The viewer of models did not load; reload the page.")) }));
  });
  return loaded;
}

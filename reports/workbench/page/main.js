/** Makes the parts of the page and joins them to the store. */

import { store } from "./store.js";
import { connect } from "./server.js";

const find = (id) => document.getElementById(id);
const PANELS = ["verdict", "forms", "text", "solids", "out"];

/** Tabs as a keyboard expects them: arrows go from tab to tab, Tab goes into the panel. */
function tabs() {
  for (const [place, name] of PANELS.entries()) {
    const tab = find(`tab-${name}`);
    tab.addEventListener("click", () => store.put("panel", name));
    tab.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (!step) return;
      const other = PANELS[(place + step + PANELS.length) % PANELS.length];
      store.put("panel", other);
      find(`tab-${other}`).focus();
    });
  }
  store.on("panel", (shown) => {
    for (const name of PANELS) {
      const open = name === shown;
      find(`tab-${name}`).setAttribute("aria-selected", String(open));
      find(`tab-${name}`).tabIndex = open ? 0 : -1;
      find(`panel-${name}`).hidden = !open;
    }
  });
}

/** The name of the file, what is wrong with it, and what happened. */
function said() {
  store.on("document", (now) => {
    const changed = now.saved ? "" : " (not saved)";
    find("name").textContent = now.name + changed;
    document.title = `${now.name}${changed} - alula`;
    const line = now.problem?.line ? `Line ${now.problem.line}: ` : "";
    find("problem").textContent = now.problem ? line + now.problem.sentence : "";
    find("problem").hidden = !now.problem;
  });
  store.on("notice", (notice) => {
    find("notice").textContent = notice?.sentence ?? "";
    find("notice").hidden = !notice?.sentence;
  });
  find("notice").addEventListener("click", () => store.put("notice", null));
}

/** The load case that is shown: the first one until another is chosen. */
function loadCases() {
  store.on("drawn", (drawn) => {
    if (drawn && !drawn.load_cases.includes(store.state.loadCase)) store.put("loadCase", drawn.load_cases[0] ?? null);
  });
}

async function panels() {
  for (const name of PANELS) {
    const module = await import(`./${name}.js`).catch(() => null);
    module?.mount(find(`panel-${name}`), store);
  }
}

tabs();
said();
loadCases();
await panels();
connect();

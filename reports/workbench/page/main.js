/** Makes the parts of the page and joins them to the store. */

import { store } from "./store.js";
import { change, connect } from "./server.js";
import * as plane from "./plane.js";
import * as gestures from "./gestures.js";
import * as tools from "./tools.js";
import * as side from "./side.js";
import * as motion from "./motion.js";
import * as start from "./start.js";
import * as verdict from "./verdict.js";
import * as forms from "./forms.js";
import * as text from "./text.js";
import * as solids from "./solids.js";
import * as out from "./out.js";
import { add } from "./elements.js";

const find = (id) => document.getElementById(id);
const TITLES = { verdict: "Verdict", forms: "Entries", text: "Text", solids: "Solids", out: "Out" };
const PANELS = Object.keys(TITLES);

/** Tabs as a keyboard expects them: arrows go from tab to tab, Tab goes into the panel. */
function tabs() {
  for (const [place, name] of PANELS.entries()) {
    const tab = add(find("tabs"), "button", { type: "button", role: "tab", id: `tab-${name}`, "aria-controls": `panel-${name}`, onclick: () => store.put("panel", name) }, TITLES[name]);
    add(find("panels"), "div", { role: "tabpanel", id: `panel-${name}`, "aria-labelledby": `tab-${name}`, tabindex: 0 });
    tab.addEventListener("keydown", (event) => {
      const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (!step) return;
      const other = PANELS[(place + step + PANELS.length) % PANELS.length];
      store.put("panel", other);
      find(`tab-${other}`).focus();
    });
  }
  const show = (shown) => {
    for (const name of PANELS) {
      const open = name === shown;
      find(`tab-${name}`).setAttribute("aria-selected", String(open));
      find(`tab-${name}`).tabIndex = open ? 0 : -1;
      find(`panel-${name}`).hidden = !open;
    }
  };
  store.on("panel", show);
  show(store.state.panel);
}

/** The name of the file, what is wrong with it, and what happened. */
function said() {
  store.on("document", (now) => {
    const name = now.name ?? "alula";
    find("name").textContent = find("name").title = now.name ? `${name}\n${now.saved ? "saved" : "not saved"}` : name;
    document.title = now.name ? `${name}${now.saved ? "" : " (not saved)"} - alula` : name;
    const line = now.problem?.line ? `Line ${now.problem.line}: ` : "";
    find("problem").textContent = now.problem ? line + now.problem.sentence : "";
    find("problem").hidden = !now.problem || Boolean(tools.nextStep(now)); // what is only begun is no mistake
    asked(now);
  });
  store.on("notice", (notice) => {
    find("notice").firstElementChild.textContent = notice?.sentence ?? "";
    find("notice").hidden = !notice?.sentence;
  });
  find("notice").lastElementChild.addEventListener("click", () => store.put("notice", null));
}

const DISK = {
  changed: ["Another program has changed the file.", ["Take its text over", "reload"], ["Keep mine", "overwrite"]],
  deleted: ["The file is gone from the disk.", ["Write it anew", "overwrite"]],
  "read-only": ["The file may not be written: Out has the case as a copy."],
};
const draft = (since) => [`Changes of ${new Date(1000 * since).toLocaleString()} were not saved.`, ["Take them", "draft", { take: true }], ["Let them go", "draft", { take: false }]];

/** What the page has to ask the reader about the file. */
function asked(now) {
  const [sentence, ...answers] = now.draft ? draft(now.draft) : DISK[now.disk] ?? [""];
  const bar = find("asked");
  bar.hidden = !sentence;
  if (bar.dataset.shown === sentence) return;
  bar.dataset.shown = sentence;
  bar.textContent = `${sentence} `;
  for (const [label, route, body] of answers) add(bar, "button", { type: "button" }, label).addEventListener("click", () => change(route, body));
}

tabs();
said();
tools.mount(find("tools")); // first: it chooses the load case of what is drawn
gestures.mount(plane.mount(find("plane")));
for (const [id, part] of Object.entries({ side, motion, start })) part.mount(find(id));
for (const [name, panel] of Object.entries({ verdict, forms, text, solids, out })) panel.mount(find(`panel-${name}`), store);
connect();

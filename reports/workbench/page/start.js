/** What one starts from while no case is open: cases of the folder, and built-in ones to copy. */

import { store } from "./store.js";
import { change, send, tell } from "./server.js";
import { add } from "./svg.js";

export function mount(element) {
  let shown = false;
  store.on("document", (now) => {
    element.hidden = now.path !== null;
    for (const id of ["tools", "work"]) document.getElementById(id).hidden = !element.hidden;
    if (!element.hidden && !shown) show(element);
    shown = !element.hidden;
  });
}

async function show(element) {
  const { starters, files, folder } = await send("starters").catch((problem) => {
    tell(problem.message);
    return { starters: [], files: [], folder: "" };
  });
  element.replaceChildren();
  add(element, "h2", {}, `Open a case of ${folder}`);
  const here = add(element, "ul");
  for (const name of files) button(here, name, "", { path: name });
  if (!files.length) add(here, "li", {}, "There is none yet.");
  add(element, "h2", {}, "Start from a case of the gallery");
  const label = add(element, "label", {}, "Name of the new file ");
  const name = add(label, "input", { "aria-label": "Name of the new file", spellcheck: "false" });
  name.value = "my-case.toml";
  const gallery = add(element, "ul");
  for (const one of starters) button(gallery, one.name, one.title, () => ({ starter: one.name, as: name.value.trim() }));
}

function button(list, text, title, body) {
  const row = add(list, "li");
  add(row, "button", { type: "button" }, text).addEventListener("click", () => change("open", typeof body === "function" ? body() : body).catch(() => {}));
  row.append(` ${title}`);
}

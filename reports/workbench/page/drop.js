/** STEP files that are dropped on the page: what is found in them is offered to the pins of a link. */

import { free, make, number, unused } from "./elements.js";
import { ask, edit } from "./server.js";

const LARGEST = 200; // MB, as the server takes them

export function mountDrop(holder, store) {
  const said = make("p", { role: "status", "aria-live": "polite" });
  const found = make("div");
  const input = make("input", { type: "file", accept: ".step,.stp", id: unused(), onchange: () => input.files[0] && take(input.files[0]) });
  holder.append(
    make("h2", {}, "A part from CAD"),
    make("p", {}, make("label", { for: input.id }, "A STEP file, chosen or dropped on the page; it is copied in beside the case. "), input),
    said, found,
  );

  async function take(file) {
    store.put("panel", "out");
    found.replaceChildren();
    if (file.size > LARGEST * 1e6) return (said.textContent = `'${file.name}' is larger than ${LARGEST} MB; export the part alone.`);
    said.textContent = `Looking into '${file.name}' ...`;
    const post = { method: "POST", headers: { "Content-Type": "application/octet-stream" }, body: file };
    const told = await ask(`drop/${encodeURIComponent(file.name)}`, post).then((answer) => answer.json(), ({ message }) => void (said.textContent = message));
    if (!told) return;
    said.textContent = `'${told.file}' stands beside the case: ${told.size.map(number).join(" × ")} mm, ${told.bores.length} bore${told.bores.length > 1 ? "s" : ""} that may hold pins.`;
    offer(told);
  }

  /** Bores, and the points of the link that they shall be. */
  function offer(told) {
    const tables = store.state.document?.tables ?? {};
    const links = Object.entries(tables.links ?? {}).filter(([, link]) => !link.ground).map(([name]) => name);
    const selected = store.state.selected;
    const first = links.includes(selected?.name) ? selected.name : links.includes(selected?.link) ? selected.link : "";
    const link = make("select", { id: unused(), onchange: rows }, make("option", { value: "" }, "a new link"), ...links.map((name) => make("option", { value: name, selected: name === first }, name)));
    const body = make("tbody");
    let choices = [];

    function rows() {
      const stated = tables.links?.[link.value]?.points;
      const points = typeof stated === "object" ? Object.keys(stated) : [];
      choices = told.bores.map((bore, place) => make("select", { "aria-label": `Point of ${bore.bore}` },
        make("option", { value: "" }, "none"),
        ...[...new Set([...points, ...(link.value ? [] : [bore.point])])].map((name) => make("option", { value: name, selected: link.value ? points[place] === name : true }, name))));
      body.replaceChildren(...told.bores.map((bore, place) => make("tr", {},
        make("th", { scope: "row" }, bore.bore), make("td", { class: "num" }, `${number(bore.diameter)} mm`), make("td", { class: "num" }, bore.at.map(number).join(", ")), make("td", {}, choices[place]))));
    }

    async function use() {
      const chosen = told.bores.map((bore, place) => [choices[place].value, bore]).filter(([name]) => name);
      const names = chosen.map(([name]) => name);
      if (!names.length) return (said.textContent = "Give at least one bore a point.");
      if (new Set(names).size < names.length) return (said.textContent = "Give each bore a point of its own.");
      const part = free(told.part, Object.keys(tables.parts ?? {}));
      const name = link.value || free(told.part, Object.keys(tables.links ?? {}));
      const bores = Object.fromEntries(chosen.map(([point, bore]) => [point, bore.bore]));
      const operations = [{ op: "set", path: ["parts", part], value: { ...told.table, bores } }, { op: "set", path: ["links", name, "part"], value: part }];
      for (const [point, bore] of chosen) {
        operations.push({ op: "set", path: ["links", name, "points", point], value: told.link.points[bore.point] });
        if (bore.slot) operations.push({ op: "set", path: ["links", name, "slots", point], value: told.link.slots[bore.point] });
      }
      try {
        await edit(operations);
        found.replaceChildren();
        said.textContent = `Link ${name} is made of '${told.file}' now, of ${told.table.material}: state its own material under Entries, parts.`;
        store.put("selected", { kind: "link", name });
      } catch (problem) {
        said.textContent = problem.message;
      }
    }

    rows();
    const head = ["bore", "diameter", "x, y [mm]", "point"].map((title) => make("th", { scope: "col" }, title));
    found.replaceChildren(
      make("p", {}, make("label", { for: link.id }, "Make of it "), link),
      make("div", { class: "wide" }, make("table", {}, make("thead", {}, make("tr", {}, ...head)), body)),
      make("p", {}, make("button", { type: "button", onclick: use }, "Use this part")),
    );
  }

  addEventListener("dragover", (event) => event.dataTransfer?.types.includes("Files") && event.preventDefault());
  addEventListener("drop", (event) => {
    if (!event.dataTransfer?.files.length) return;
    event.preventDefault();
    take(event.dataTransfer.files[0]);
  });
}

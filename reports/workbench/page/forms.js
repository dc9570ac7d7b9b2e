/** The entries of the case as forms, made from the JSON Schema: one table, and one of its entries, at a time. */

import { free, keepingFocus, make, perFrame, unused, worded } from "./elements.js";
import { beginning, isList, isMap, isPlain, isTable, itemOf, optionOf, options, schema, titleOf } from "./schema.js";
import { edit } from "./server.js";
import { same } from "./store.js";

const SELECTED = { links: "link", joints: "joint" };
const WORDS = { links: "link", joints: "joint", springs: "spring", tendons: "tendon", stops: "stop", materials: "material", parts: "part", load_cases: "load case", checks: "check" };
const CASE = ""; // the section of what stands at the top of the file
const NUMBER = /^[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?$/i;
const MEASURED = /^[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?\s*([^\d\s.]\S*)$/i;
const words = (key) => String(key).replaceAll("_", " ");
const dotted = (path) => path.join(".");
const key = (path) => JSON.stringify(path);
const at = (tables, path) => path.reduce((inside, step) => inside?.[step], tables);

export async function mount(holder, store) {
  const root = await schema().catch((problem) => {
    holder.append(make("p", { role: "alert" }, problem.message));
  });
  if (root) new Forms(holder, store, root);
}

class Forms {
  constructor(holder, store, root) {
    Object.assign(this, { holder, store, root, table: "links", name: null, open: new Set(), refused: new Map(), unsent: new Map(), drawn: "" });
    this.choice = make("select", { id: unused(), onchange: () => this.show(this.choice.value, null) });
    this.names = make("div", { class: "names", role: "group", "aria-label": "Entries of this table" });
    this.form = make("form", { onsubmit: (event) => event.preventDefault() });
    this.said = make("p", { class: "wrong", role: "status" });
    holder.append(make("p", {}, make("label", { for: this.choice.id }, "Show "), this.choice), this.names, this.said, this.form);
    this.later = perFrame(() => keepingFocus(this.holder, () => this.draw()));
    this.form.addEventListener("focusin", ({ target }) => this.entered(target));
    store.on("document", (now) => {
      if (now?.revision !== this.revision) this.refused.clear(); // what stood there when it was refused has gone
      this.revision = now?.revision;
      this.tables = now?.tables ?? this.tables;
      this.later();
    });
    store.on("selected", (selected) => this.follow(selected));
    store.on("panel", () => this.later());
    this.tables = store.state.document?.tables ?? null;
    this.follow(store.state.selected); // it may have been chosen before the schema was there
    this.later();
  }

  show(table, name) {
    Object.assign(this, { table, name });
    this.later();
    const kind = SELECTED[table];
    if (kind && name) this.select({ kind, name });
  }

  select(selected) {
    if (!same(selected, this.store.state.selected)) this.store.put("selected", selected);
  }

  /** What is selected in the drawing opens its form. */
  follow(selected) {
    if (!selected) return;
    const { kind, name, link, path } = selected;
    if (kind === "link" || kind === "joint") Object.assign(this, { table: `${kind}s`, name });
    if (kind === "point") Object.assign(this, { table: "links", name: link });
    if (kind === "load" && path) {
      Object.assign(this, { table: path[0], name: path[1] });
      path.forEach((_, place) => this.open.add(key(path.slice(0, place + 1))));
    }
    this.seek = kind === "point" ? ["links", link, "points", selected.point] : kind === "load" ? path : null;
    this.later();
  }

  /** An entry that is stepped on is told to the other panels, and a load is selected in the drawing. */
  entered(target) {
    const path = JSON.parse(target.closest("[data-path]")?.dataset.path ?? "null");
    if (!path) return;
    this.store.put("entry", path);
    if (path[0] === "load_cases" && Number.isInteger(path[3])) this.select({ kind: "load", path: path.slice(0, 4) });
  }

  draw() {
    if (this.store.state.panel !== "forms" || !this.tables) return;
    const problem = this.store.state.document?.problem?.sentence ?? "";
    const state = JSON.stringify([this.tables, this.table, this.name, problem, [...this.refused], this.store.state.selected]);
    if (state === this.drawn && !this.seek) return;
    this.drawn = state;
    const active = this.form.contains(document.activeElement) ? document.activeElement : null;
    const kept = active?.dataset.path && { path: active.dataset.path, value: active.value, was: active.dataset.was, start: active.selectionStart };
    const scrolled = this.holder.scrollTop;
    this.sections();
    this.wrong = problem;
    this.said.textContent = "";
    const shown = this.shown();
    this.form.replaceChildren(...shown.flat().filter(Boolean));
    if (problem && !this.form.querySelector('[aria-invalid="true"], .wrong:not(:empty)')) this.said.replaceChildren(this.elsewhere());
    this.holder.scrollTop = scrolled;
    this.back(kept);
    if (this.seek) this.find(this.seek)?.scrollIntoView({ block: "center" });
    this.seek = null;
  }

  /** A button that shows the entry that is wrong, where another one is shown. */
  elsewhere() {
    const tables = Object.keys(this.root.properties).filter((table) => this.begins([table]) && !this.plain(table));
    if (!tables.length && !(this.wrong.split(/[ .:]/)[0] in this.root.properties)) return "";
    const [table = CASE] = tables;
    const name = Object.keys(this.tables[table] ?? {}).find((one) => this.begins([table, one])) ?? null;
    const title = [words(table) || "the case itself", name].filter(Boolean).join(", ");
    return make("button", { type: "button", class: "plain to-line", onclick: () => this.show(table, name) }, `Something is wrong in ${title}: show it`);
  }

  /** The element of an entry, or the one of its elements that has a property. */
  find(path, property = "dataset") {
    return [...this.form.querySelectorAll("[data-path]")].find((one) => one.dataset.path === key(path) && property in one);
  }

  /** Put the cursor back to where it was, with what was typed and not sent yet. */
  back(kept) {
    const again = kept && this.find(JSON.parse(kept.path), "value");
    if (!again) return;
    if (kept.value !== kept.was) {
      again.value = kept.value;
      let sent = false; // a browser tells no change of what a script has put there
      again.addEventListener("change", () => (sent = true), { once: true });
      again.addEventListener("blur", () => sent || again.value === again.dataset.was || again.dispatchEvent(new Event("change")), { once: true });
    }
    again.focus({ preventScroll: true });
    if (again.setSelectionRange && again.type === "text") again.setSelectionRange(kept.start, kept.start);
  }

  sections() {
    const tables = Object.keys(this.root.properties).filter((name) => !this.plain(name));
    const stated = (name) => this.tables[name] !== undefined;
    const told = (name) => {
      const value = this.tables[name];
      return words(name) + (value && typeof value === "object" && (isMap(options(this.root.properties[name])[0]) || Array.isArray(value)) ? ` (${Object.keys(value).length})` : "");
    };
    const choices = (names) => names.map((name) => make("option", { value: name, selected: name === this.table }, told(name)));
    const groups = [["In this case", tables.filter(stated)], ["Further ones", tables.filter((name) => !stated(name))]];
    this.choice.replaceChildren(
      make("option", { value: CASE, selected: this.table === CASE }, "the case itself"),
      ...groups.map(([label, names]) => make("optgroup", { label }, ...choices(names))),
    );
    this.names.replaceChildren();
    if (!WORDS[this.table]) return;
    const names = Object.keys(this.tables[this.table] ?? {});
    if (!names.includes(this.name)) this.name = names[0] ?? null;
    const one = (name) => make("button", { type: "button", "aria-pressed": String(name === this.name), onclick: () => this.show(this.table, name) }, name);
    this.names.append(...names.map(one), ...this.adder());
  }

  plain(name) {
    return options(this.root.properties[name]).every((option) => isPlain(option) || (isList(option) && isPlain(options(option.items)[0])));
  }

  /** What adds an entry to the shown table: its kind, where there are several, and a button. */
  adder() {
    const node = this.root.properties[this.table].additionalProperties;
    const kinds = options(node);
    const kind = kinds.length > 1 && make("select", { "aria-label": `Kind of the new ${WORDS[this.table]}` }, ...kinds.map((option, place) => make("option", { value: place }, titleOf(option))));
    const add = () => {
      const option = kinds[Number(kind?.value ?? 0)];
      const wish = (isTable(option) && kind ? titleOf(option) : WORDS[this.table]).replace(/[^\w+ -]/g, " ").replace(/-\d+$/, "");
      const name = free(wish, Object.keys(this.tables[this.table] ?? {}));
      this.send([{ op: "set", path: [this.table, name], value: this.first(option) }], () => this.show(this.table, name));
    };
    return [make("span", { class: "adder" }, kind || null, make("button", { type: "button", onclick: add }, `Add a ${WORDS[this.table]}`))];
  }

  /** A new entry: like the last one of its kind, or as the example states it. */
  first(option) {
    const like = Object.values(this.tables[this.table] ?? {}).filter((value) => optionOf({ oneOf: options(this.root.properties[this.table].additionalProperties) }, value).title === option.title);
    const last = like.at(-1);
    return last && !last.ground ? structuredClone(last) : this.fitted(option, beginning(option), [this.table, ""]);
  }

  /** What an entry is when it is stated: of a list of tables one. */
  begun(node, path, table = null) {
    const value = beginning(node);
    const several = Array.isArray(value) && typeof value[0] === "object" && !Array.isArray(value[0]) && options(node)[0].items;
    return this.fitted(node, several ? value.slice(0, 1) : value, path, table);
  }

  /** A value whose names are of this case: each that is not there is replaced by the first one that is. */
  fitted(node, value, path, table = null) {
    const option = optionOf(node, value);
    if (Array.isArray(value)) return value.map((one, place) => this.fitted({ ...itemOf(option, place), "x-refers": node["x-refers"] }, one, [...path, place], table));
    if (node["x-refers"] && typeof value === "string") {
      const names = this.namesOf(node, path, table);
      const moving = names.filter((name) => !this.tables[node["x-refers"]]?.[name]?.ground);
      const place = path.findLast(Number.isInteger) ?? 0; // the second of a list is another one than the first
      return names.includes(value) ? value : (path.at(-1) === "end" ? moving.at(-1) : moving[place % moving.length]) ?? value;
    }
    if (!value || typeof value !== "object") return value;
    const made = {};
    for (const [name, inner] of Object.entries(value)) made[name] = this.fitted(option.properties?.[name] ?? option.additionalProperties ?? {}, inner, [...path, name], made);
    return made;
  }

  shown() {
    if (this.table === CASE) {
      const names = Object.keys(this.root.properties).filter((name) => this.plain(name) && name !== "schema_version");
      return [make("h2", {}, "The case"), ...this.fields({ properties: this.root.properties, required: this.root.required }, this.tables, [], names)];
    }
    const node = this.root.properties[this.table];
    if (!WORDS[this.table]) return [make("h2", {}, words(this.table)), this.help(node.description), this.error([this.table]), this.inside(node, this.tables[this.table], [this.table])];
    if (!this.name) return [this.help(node.description), make("p", { class: "soft" }, "There is none yet.")];
    const path = [this.table, this.name];
    const value = at(this.tables, path);
    const option = optionOf(node.additionalProperties, value);
    const buttons = make("p", { class: "row" }, make("button", { type: "button", onclick: () => this.send([{ op: "remove", path }]) }, "Remove"));
    return [this.nameField(path, WORDS[this.table]), this.help(option.description), this.error(path), buttons, this.part(value.part), ...this.kinds(node.additionalProperties, value, path), ...this.fields(option, value, path)];
  }

  /** Section and material of a link: they stand in its part, which other links may have as well. */
  part(name) {
    const value = this.tables.parts?.[name];
    if (this.table !== "links" || !value) return null;
    const others = Object.entries(this.tables.links).filter(([link, one]) => one.part === name && link !== this.name).map(([link]) => link);
    const own = free(name, Object.keys(this.tables.parts));
    const apart = () => this.send([{ op: "set", path: ["parts", own], value }, { op: "set", path: ["links", this.name, "part"], value: own }]);
    return this.box(["parts", name], `Part ${name}${others.length ? `, shared with ${others.join(", ")}` : ""}`, () => [
      others.length ? make("button", { type: "button", onclick: apart }, `Give ${this.name} a part of its own`) : null,
      ...this.fields(optionOf(this.root.properties.parts.additionalProperties, value), value, ["parts", name])], true);
  }

  /** The name of an entry, which can be changed. */
  nameField(path, word) {
    const id = unused();
    const name = path.at(-1);
    const rename = ({ target }) => {
      const to = target.value.trim();
      if (!to || to === name) return (target.value = name);
      this.send([{ op: "rename", path, to }], () => this.name === name && path.length === 2 && this.show(path[0], to), path);
    };
    return make("p", { class: "named" }, make("label", { for: id }, `Name of the ${word}`), make("input", { id, type: "text", value: name, "data-was": name, "data-path": key([...path, "name of it"]), onchange: rename }));
  }

  /** The choice among the kinds of a union of tables, and others. */
  kinds(node, value, path) {
    const all = options(node);
    if (all.length < 2 || all.every(isPlain)) return [];
    const id = unused();
    const now = optionOf(node, value);
    const change = ({ target }) => {
      const option = all[Number(target.value)];
      const fresh = beginning(option);
      if (option["x-names"]) for (const name of at(this.tables, path.slice(0, -1))?.[option["x-names"]] ?? []) fresh[name] = beginning(option.additionalProperties);
      if (isTable(option) && value && typeof value === "object" && !Array.isArray(value)) {
        for (const name of Object.keys(option.properties)) if (name in value && !("const" in option.properties[name])) fresh[name] = value[name];
      }
      this.send([{ op: "set", path, value: fresh }], null, path);
    };
    const choices = all.map((option, place) => make("option", { value: place, selected: option === now || same(option, now) }, titleOf(option)));
    return [make("p", { class: "field" }, make("label", { for: id }, isTable(now) ? "kind" : "stated as"), make("select", { id, onchange: change, "data-path": key([...path, "kind of it"]) }, ...choices))];
  }

  /** The fields of a table: what is stated or needed first, all others in a box that opens. */
  fields(option, value, path, names = Object.keys(option.properties)) {
    const told = names.filter((name) => typeof option.properties[name].const !== "string");
    const first = told.filter((name) => value?.[name] !== undefined || option.required?.includes(name));
    const rest = told.filter((name) => !first.includes(name));
    const one = (name) => this.field(name, option.properties[name], value?.[name], [...path, name], value, option.required?.includes(name));
    if (!rest.length) return first.map(one);
    const box = this.box([...path, "further"], `${rest.length} further ${rest.length > 1 ? "entries" : "entry"}, as by default`, () => rest.map(one), !first.length);
    return [...first.map(one), box];
  }

  /** A box that opens; what is in it is made only then. */
  box(path, title, inside, open = false) {
    const name = key(path);
    const wrong = path.at(-1) === "further" ? path.length > 2 && this.begins(path.slice(0, -1)) : this.begins(path);
    const is = open || this.open.has(name) || wrong;
    const box = make("details", { "data-path": name, open: is }, make("summary", {}, title));
    const fill = () => box.childElementCount === 1 && box.append(...inside().flat().filter(Boolean));
    if (is) fill();
    box.addEventListener("toggle", () => {
      this.open[box.open ? "add" : "delete"](name);
      if (box.open) fill();
    });
    return box;
  }

  begins(path) {
    const name = dotted(path);
    return Boolean(name && this.wrong) && this.wrong.startsWith(name) && !/[\w+-]/.test(this.wrong[name.length] ?? " ");
  }

  help(text) {
    if (!text) return null;
    const [first, ...rest] = text.replaceAll("\n", " ").split(/(?<=\.) (?=[A-Z\[{])/);
    if (!rest.length) return make("p", { class: "help" }, ...worded(first));
    return make("details", { class: "help" }, make("summary", {}, ...worded(first)), make("p", {}, ...worded(rest.join(" "))));
  }

  /** The sentence that belongs to an entry, if there is one. */
  error(path, deep = false) {
    const here = this.refused.get(key(path)) ?? (this.begins(path) && (deep || !this.deeper(path)) ? this.wrong : "");
    return make("p", { class: "wrong", id: `wrong-${dotted(path).replace(/\W/g, "_")}`, role: "alert" }, here);
  }

  /** Whether the problem names something that stands inside of an entry. */
  deeper(path) {
    const value = at(this.tables, path);
    return value && typeof value === "object" && Object.keys(value).some((step) => this.begins([...path, step]));
  }

  field(name, node, value, path, table, needed) {
    const all = options(node);
    const plain = all.every(isPlain) || (all.length === 1 && isList(all[0]) && this.short(all[0]));
    const id = unused();
    const label = words(name);
    const help = this.help(node.description);
    if (plain) {
      const error = this.error(path, true);
      const inside = all.length === 1 && isList(all[0]) ? this.row(node, all[0], value, path, table, id, label) : [this.input(node, value, path, table, { id, wrong: error })];
      return make("div", { class: value === undefined ? "field unset" : "field" }, make("label", { for: id }, label), make("span", { class: "values" }, ...inside), help, error);
    }
    if (value === undefined) {
      const add = () => {
        this.open.add(key(path));
        this.send([{ op: "set", path, value: this.begun(node, path, table) }], null, path);
      };
      return make("div", { class: "field unset" }, make("span", {}, label), make("button", { type: "button", onclick: add, "aria-label": `State ${label}` }, "State"), help, this.error(path));
    }
    const size = typeof value === "object" ? ` (${Object.keys(value).length})` : "";
    return this.box(path, label + (isTable(optionOf(node, value)) ? "" : size), () => [help, this.error(path), this.inside(node, value, path, table),
      needed ? null : make("button", { type: "button", onclick: () => this.send([{ op: "set", path, value: null }]) }, `Leave out ${label}`)], needed || ["points", "forces", "between"].includes(name));
  }

  short(option) {
    return (option.prefixItems?.length ?? option.maxItems ?? 9) <= 3 && isPlain(options(itemOf(option, 0))[0]);
  }

  /** What stands in an entry that is not plain. */
  inside(node, value, path, table) {
    const box = make("div", { class: "inside" });
    if (value === undefined || value === null) {
      box.append(make("button", { type: "button", onclick: () => this.send([{ op: "set", path, value: this.begun(node, path) }]) }, `State ${words(path.at(-1))}`));
      return box;
    }
    const option = optionOf(node, value);
    if (typeof value === "string" && !options(node).some(isPlain)) { // such as "from-part"
      box.append(this.input({ type: "string" }, value, path, table, { label: words(path.at(-1)) }));
      return box;
    }
    box.append(...this.kinds(node, value, path));
    if (isTable(option)) box.append(...this.fields(option, value, path));
    else if (isMap(option)) box.append(...this.map(option, value, path));
    else if (isList(option)) box.append(...this.list({ ...node, ...option }, value, path, table));
    else box.append(this.input(node, value, path, table, { label: words(path.at(-1)) }));
    return box;
  }

  /** A table whose keys are names. */
  map(option, value, path) {
    const rows = Object.entries(value).map(([name, inner]) => {
      const here = [...path, name];
      const remove = make("button", { type: "button", "aria-label": `Remove ${name}`, onclick: () => this.send([{ op: "remove", path: here }]) }, "Remove");
      const child = option.additionalProperties;
      const kind = optionOf(child, inner);
      if (!isPlain(kind) && !(isList(kind) && this.short(kind))) return this.box(here, name, () => [this.error(here), this.inside(child, inner, here), remove]);
      const id = unused();
      const inputs = isPlain(kind) ? [this.input(child, inner, here, value, { id })] : this.row(child, kind, inner, here, value, id, name);
      const label = path.at(-1) === "points" ? this.nameField(here, "point") : make("label", { for: id }, name);
      return make("div", { class: "field keyed", "data-path": key(here) }, label, make("span", { class: "values" }, ...inputs), remove, this.error(here, true));
    });
    const told = { type: "text", "aria-label": "Name of the new entry", placeholder: "name" };
    const links = Object.keys(this.tables.links ?? {}).filter((name) => !(name in value));
    const fresh = option["x-names"] || path.at(-1) === "near" ? make("select", told, links.map((name) => make("option", {}, name))) : make("input", told);
    const add = () => {
      const name = fresh.value.trim();
      if (!name) return fresh.focus();
      const like = Object.values(value).at(-1);
      this.send([{ op: "set", path: [...path, name], value: like === undefined ? beginning(option.additionalProperties) : structuredClone(like) }], null, path);
    };
    return [...rows, make("p", { class: "adder" }, fresh, make("button", { type: "button", onclick: add }, "Add"))];
  }

  /** A list of any length. */
  list(option, value, path, table) {
    const plain = isPlain(options(itemOf(option, 0))[0]);
    const fixed = Boolean(option.prefixItems);
    if (plain) {
      const id = unused();
      return [make("span", { class: "values" }, ...this.row(option, option, value, path, table, id, words(path.at(-1))))];
    }
    const items = value.map((inner, place) => {
      const here = [...path, place];
      const label = `${words(path.at(-1))} ${place + 1}`;
      const box = make("fieldset", { "data-path": key(here) }, make("legend", {}, label), this.error(here), this.inside(itemOf(option, place), inner, here, table));
      if (!fixed) box.append(make("button", { type: "button", onclick: () => this.send([{ op: "remove", path: here }], () => this.leave(path)), "aria-label": `Remove ${label}` }, "Remove"));
      return box;
    });
    const add = () => {
      const fresh = value.length ? structuredClone(value.at(-1)) : this.fitted(option.items, beginning(option.items), [...path, 0]);
      this.send([{ op: "append", path, value: fresh }], null, path);
    };
    return [...items, fixed ? null : make("button", { type: "button", onclick: add }, `Add one more`)].filter(Boolean);
  }

  /** The inputs of a list of plain values: as many as there may be, or one more than there are. */
  row(node, option, value, path, table, id, label) {
    const now = Array.isArray(value) ? value : [];
    const most = option.prefixItems?.length ?? option.maxItems ?? 200;
    const shown = most <= 3 ? most : Math.min(most, now.length + 1);
    const inputs = [];
    const commit = () => {
      const stated = inputs.map((input) => this.read(itemOf(option, 0), input.value, null, input.dataset.was));
      for (const one of inputs) this.unsent.set(one.dataset.path, one.value);
      while (stated.length && stated.at(-1) === null) stated.pop();
      const filled = most <= 3 ? stated : stated.filter((one) => one !== null);
      const least = option.prefixItems ? most : (option.minItems ?? 0);
      if (filled.length && (filled.includes(null) || filled.length < least)) return now.length ? this.refuse(path, `State all ${least} values.`) : null; // what is begun waits for the rest
      for (const one of inputs) this.unsent.delete(one.dataset.path);
      const changed = filled.flatMap((one, place) => (one === now[place] ? [] : [place]));
      const single = filled.length === now.length && changed.length === 1;
      return this.send([single ? { op: "set", path: [...path, changed[0]], value: filled[changed[0]] } : { op: "set", path, value: filled.length ? filled : null }], null, path);
    };
    const examples = node.examples?.[0] ?? [];
    for (let place = 0; place < shown; place += 1) {
      const child = { ...itemOf(option, place), "x-refers": node["x-refers"] };
      if (examples[place] !== undefined) child.examples = [examples[place]];
      if (place >= (option.minItems ?? most)) child.default = "left out";
      inputs.push(this.input(child, now[place] ?? this.unsent.get(key([...path, place])), [...path, place], table, { id: place ? null : id, label: place || !id ? `${label}, value ${place + 1}` : null, commit }));
    }
    return inputs;
  }

  /** One input or choice. */
  input(node, value, path, table, { id = null, label = null, commit = null, wrong = null }) {
    const all = options(node);
    const names = node["x-refers"] ? this.namesOf(node, path, table) : all.every((one) => one.enum || one.const !== undefined) ? all.flatMap((one) => one.enum ?? [one.const]) : all[0]?.type === "boolean" && all.length === 1 ? [true, false] : null;
    const unset = node.default === undefined || node.default === null ? "" : node.default === "left out" ? node.default : `${this.told(node.default)} (default)`;
    const send = ({ target }) => (commit ? commit() : this.send([{ op: "set", path, value: this.read(node, target.value, names, target.dataset.was) }], null, path));
    const common = { id, "aria-label": label, "data-path": key(path), "data-was": value === undefined ? "" : String(value), onchange: send,
      "aria-invalid": wrong?.textContent ? "true" : null, "aria-describedby": wrong?.textContent ? wrong.id : null };
    if (names) {
      const known = value === undefined || names.includes(value);
      const option = (one) => make("option", { value: String(one), selected: one === value }, this.told(one));
      return make("select", common, make("option", { value: "", selected: value === undefined }, unset || "-"), ...names.map(option), known ? null : make("option", { value: String(value), selected: true }, `${value} (not there)`));
    }
    const example = node.examples?.[0] ?? all.find((one) => one.examples)?.examples[0];
    const hint = unset || (example !== undefined && typeof example !== "object" ? `e.g. ${example}` : "");
    if (all[0]?.type === "string" && !all[0].format && all.length === 1 && String(value ?? "").length > 40) {
      const area = make("textarea", { ...common, rows: 3, placeholder: hint });
      area.value = value;
      return area;
    }
    return make("input", { ...common, type: "text", value: value ?? null, placeholder: hint, autocomplete: "off", spellcheck: "false" });
  }

  told(value) {
    if (typeof value === "boolean") return value ? "yes" : "no";
    if (Array.isArray(value)) return value.length ? value.join(", ") : "none";
    return typeof value === "object" ? "" : String(value);
  }

  /** What was typed, as the file states it; a bare number has the unit of the number that stood there. */
  read(node, text, names, was) {
    const stated = text.trim();
    if (!stated) return null;
    if (names) return names.find((name) => String(name) === stated) ?? stated;
    const numeric = options(node).some((option) => ["number", "integer"].includes(option.type));
    if (!NUMBER.test(stated)) return text;
    const unit = NUMBER.test(was) ? null : was.match(MEASURED)?.[1];
    return unit ? `${stated} ${unit}` : numeric ? Number(stated) : text;
  }

  /** The names that an entry may refer to. */
  namesOf(node, path, table) {
    const refers = node["x-refers"];
    if (refers === "points") {
      const link = path[2] === "held_at" ? path[1] : (table?.link ?? (table?.links && table.links[path.at(-1)]));
      const of = link ? [link] : Object.keys(this.tables.links ?? {});
      const pointsOf = (points) => (typeof points === "object" ? Object.keys(points) : []);
      return [...new Set(of.flatMap((one) => pointsOf(this.tables.links?.[one]?.points)))];
    }
    const own = Object.keys(this.tables[refers] ?? {});
    const library = refers === "materials" ? (options(node)[0].examples ?? node.examples ?? []) : [];
    return [...own, ...library.filter((name) => !own.includes(name))];
  }

  /** Let go of what is selected in a list, whose places have changed. */
  leave(path) {
    const { selected } = this.store.state;
    if (selected?.path && same(selected.path.slice(0, path.length), path)) this.store.put("selected", null);
  }

  refuse(path, sentence) {
    this.refused.set(key(path), sentence);
    this.later();
  }

  async send(operations, then = null, path = null) {
    if (path) this.refused.delete(key(path));
    try {
      await edit(operations);
      then?.();
    } catch (problem) {
      if (path) this.refuse(path, problem.message);
      else this.said.textContent = problem.message;
    }
  }
}

/** The JSON Schema of the case file, as forms need it. */

import { send } from "./server.js";

let root = null;

/** Fetch the schema, once. */
export const schema = async () => (root ??= await send("schema"));

/** What a node may be: references followed, unions taken apart, without null. */
export function options(node) {
  if (node.$ref) return options(root.$defs[node.$ref.split("/").pop()]);
  const several = node.oneOf ?? node.anyOf;
  if (several) return several.flatMap(options);
  return node.type === "null" ? [] : [node];
}

export const isTable = (node) => node.type === "object" && "properties" in node;
export const isMap = (node) => node.type === "object" && !("properties" in node);
export const isList = (node) => node.type === "array";
export const isPlain = (node) => node.type !== "object" && node.type !== "array";

/** The node of what is at a place in a list. */
export const itemOf = (node, place) => node.items ?? node.prefixItems[Math.min(place, node.prefixItems.length - 1)];

/** The option of which a value is; the first one where none fits. */
export function optionOf(node, value) {
  const all = options(node);
  return all.find((option) => fits(option, value)) ?? all.find((option) => sameKind(option, value)) ?? all[0];
}

function sameKind(option, value) {
  if (Array.isArray(value)) return isList(option);
  if (value && typeof value === "object") return option.type === "object";
  if (typeof value === "string") return option.type === "string";
  return typeof value === "number" && ["number", "integer"].includes(option.type);
}

function fits(option, value) {
  if (!sameKind(option, value)) return false;
  if (!isTable(option)) return true;
  const known = Object.keys(option.properties);
  const marks = known.filter((key) => "const" in option.properties[key] && key in value);
  return marks.length ? marks.every((key) => option.properties[key].const === value[key])
    : Object.keys(value).every((key) => known.includes(key)) && (option.required ?? []).every((key) => key in value);
}

/** What an option of a union is called: its kind, or what it holds. */
export function titleOf(option) {
  const mark = isTable(option) && Object.values(option.properties).find((child) => typeof child.const === "string");
  if (mark) return mark.const;
  if (isTable(option)) return (option.title ?? "table").replace(/([a-z])([A-Z])/g, "$1 $2").toLowerCase();
  if (isMap(option)) return option["x-names"] ? `one for each of its ${option["x-names"]}` : "a table";
  if (isList(option)) return option.prefixItems?.length === 2 || option.maxItems === 2 ? "a range" : "a list";
  return option.format ?? { string: "text", integer: "whole number", number: "number", boolean: "yes or no" }[option.type] ?? "value";
}

/** A value to begin with: an example, or what has to be stated, from examples. */
export function beginning(node) {
  const [option] = options(node);
  if (node.examples?.length) return structuredClone(node.examples[0]);
  if (option.examples?.length) return structuredClone(option.examples[0]);
  if (isTable(option)) {
    const needed = new Set(option.required ?? []);
    for (const [key, child] of Object.entries(option.properties)) if ("const" in child && typeof child.const === "string") needed.add(key);
    return Object.fromEntries([...needed].map((key) => [key, beginning(option.properties[key])]));
  }
  if (isMap(option)) return {};
  if (isList(option)) return Array.from({ length: option.minItems ?? 0 }, (_, place) => beginning(itemOf(option, place)));
  if ("const" in option) return option.const;
  return option.enum?.[0] ?? { boolean: true, integer: 1, number: 1 }[option.type] ?? "";
}

/** What the page asks of the server, and what the server tells. */

import { store } from "./store.js";

const EVENTS = ["document", "drawn", "verdict", "motion", "solids", "notice"];
let revision = 0;
let waiting = [];
let busy = false;

/** Ask the server; its answer, or an error whose message is a sentence for the reader: nothing has changed then. */
export async function ask(route, options = {}) {
  const answer = await fetch(route, options).catch(() => {
    throw new Error("The server of alula does not answer; start it again with alula open.");
  });
  if (answer.ok) return answer;
  const { sentence } = await answer.json().catch(() => ({}));
  throw new Error(sentence ?? `The server refused (${answer.status}).`);
}

/** What it answers as JSON. Without a body it is a GET. */
export async function send(route, body) {
  const post = { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) };
  return (await ask(route, body === undefined ? {} : post)).json();
}

/** Change the document. One request is on its way at a time; of one gesture the newest change wins. */
export function change(route, body = {}, gesture = "") {
  const last = waiting.at(-1);
  if (gesture && last?.gesture === gesture && last.route === route) {
    last.body = body;
    return last.promise;
  }
  const one = { route, body, gesture };
  one.promise = new Promise((resolve, reject) => Object.assign(one, { resolve, reject }));
  one.promise.catch(() => {}); // told as a notice; who waits for it sees it too
  waiting.push(one);
  next();
  return one.promise;
}

async function next() {
  if (busy || !waiting.length) return;
  busy = true;
  const { route, body, gesture, resolve, reject } = waiting.shift();
  try {
    const answer = await send(route, { revision, gesture, ...body });
    revision = Math.max(revision, answer.revision ?? 0);
    if (store.state.notice?.refused) store.put("notice", null);
    resolve(answer);
  } catch (problem) {
    store.put("notice", { sentence: problem.message, refused: true });
    reject(problem);
  }
  busy = false;
  next();
}

/** Edit the case by a list of operations; those of one gesture are one step of undo. */
export const edit = (operations, gesture = "") => change("edit", { operations }, gesture);
export const newGesture = () => crypto.randomUUID();

/** Show a sentence to the reader. */
export const tell = (sentence) => store.put("notice", { sentence });

/** Take what the server tells into the store, for as long as the page is open. */
export function connect() {
  const source = new EventSource("events");
  let lost = false;
  source.onerror = () => {
    lost = true;
    const file = store.state.document?.name ?? "";
    tell(`The server of alula has ended. Start it again with: alula open ${file} - and use the page that it opens: changes that were not saved are offered there.`);
  };
  source.onopen = () => {
    if (lost) store.put("notice", null);
    lost = false;
  };
  for (const name of EVENTS) source.addEventListener(name, (event) => take(name, JSON.parse(event.data)));
}

function take(name, value) {
  if (name === "document") {
    const other = store.state.document?.path !== value.path;
    revision = other ? value.revision : Math.max(revision, value.revision);
    if (other) forget();
  }
  // Told before its joint forces are known: those of the drawing before stand until then.
  if (name === "drawn" && !value.problem && !Object.keys(value.forces).length) value.forces = store.state.drawn?.forces ?? {};
  store.put(name, name === "verdict" ? { ...store.state.verdict, [value.stage]: value } : value);
}

/** Another case was opened: nothing that was told of the last one holds. */
function forget() {
  store.put("verdict", { linear: null, whole: null, solids: null });
  for (const name of ["drawn", "motion", "solids", "selected", "loadCase", "instant", "held"]) store.put(name, null);
  store.put("fitted", false);
}

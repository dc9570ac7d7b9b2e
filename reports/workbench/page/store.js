/** What the page knows. Modules know the store alone, not each other. */

const listeners = {};

export const store = {
  state: {
    document: null, // the last event "document"
    drawn: null, // the last event "drawn"
    verdict: { linear: null, whole: null, solids: null }, // the last event "verdict" of each stage
    motion: null,
    solids: null,
    notice: null,
    selected: null, // {kind: "link"|"joint", name} | {kind: "point", link, point} | {kind: "load", path}
    loadCase: null, // name of the load case whose forces are shown
    instant: null, // number of the instant of the motion that is shown; null for the case's own pose
    panel: "verdict", // name of the tab that is open
    view: null, // {scale, left, top}: where the plane is on the screen
    fitted: false, // whether all of the case was shown once
    tool: "", // name of the tool that a press in the plane uses
    held: null, // what is pulled: {points, at, text} | {load, vector, at, text} | {pose, at, text}
    ends: null, // first end of what a tool makes: {end, at, operations, handle, to}
    cursor: null, // place that the keyboard moves, for tools
    paths: false, // whether paths of points are shown
  },

  /** Call `listener(value)` after each change of a key. */
  on(key, listener) {
    (listeners[key] ??= new Set()).add(listener);
  },

  /** Set a key and tell its listeners. */
  put(key, value) {
    if (store.state[key] === value) return;
    store.state[key] = value;
    for (const listener of listeners[key] ?? []) listener(value);
  },
};

/** Whether two selections are the same thing. */
export const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);

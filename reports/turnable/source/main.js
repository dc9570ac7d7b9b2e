// Starts the models of a page as they come near the visible part of it.
//
// A figure with a model holds its picture and a data block, <script type="application/json" data-model>. The picture stays
// where there is no WebGL, and on paper. A figure's data-turnable is "waiting", "ready" or, without WebGL, "still"; that of
// the whole page is "ready" as soon as all models near the visible part are drawn.
//
// A page that gets models later, such as that of alula open, shows each by window.alulaViewer.show(parent, kind, text).
//
// Tests read window.alulaViewer.models: each has name, kind, figure and start(), which returns what it is made of. Of a link:
// nodes (how many), value(node) with value, unit, place and displacement, screen(node) with x and y in the window and
// whether it is seen, hottest() (node of the largest stress), face(node) (looks at it from near), reading() and legend() (texts), and its stage.

import { element } from "./elements.js";
import { startLink } from "./link.js";
import { startLinkage } from "./linkage.js";
import { renderer } from "./stage.js";

const STARTS = { link: startLink, linkage: startLinkage };
const NEAR = "300px";
const page = document.documentElement.dataset;

function modelOf(block) {
  const figure = block.closest("figure");
  const model = { name: figure.dataset.name, kind: block.dataset.model, figure, started: null };
  figure.dataset.turnable = "waiting";
  model.start = () => {
    if (model.started || figure.dataset.turnable === "still") return model.started;
    model.started = show(figure, model.kind, block.textContent);
    figure.dataset.turnable = model.started ? "ready" : "still";
    return model.started;
  };
  return model;
}

/** Shows a model, by its kind and its record as text, first in an element; null without WebGL. `remove` takes it away. */
function show(parent, kind, text) {
  if (!renderer()) return null;
  const holder = element("div", { class: "model" });
  parent.prepend(holder);
  parent.classList.add("turned");
  const remove = () => {
    holder.remove();
    parent.classList.remove("turned");
  };
  try {
    const started = STARTS[kind](holder, JSON.parse(text));
    return {
      ...started,
      remove: () => {
        started.stage.end();
        remove();
      },
    };
  } catch (error) {
    remove();
    console.error(error);
    return null;
  }
}

function begin() {
  const models = [...document.querySelectorAll('script[type="application/json"][data-model]')].map(modelOf);
  window.alulaViewer = { models, show };
  if (!renderer()) {
    models.forEach(({ figure }) => (figure.dataset.turnable = "still"));
    page.turnable = "still";
    return;
  }
  const observer = new IntersectionObserver(
    (seen) => {
      for (const { target } of seen.filter((entry) => entry.isIntersecting)) {
        observer.unobserve(target);
        models.find(({ figure }) => figure === target).start();
      }
      page.turnable = "ready";
    },
    { rootMargin: NEAR },
  );
  models.forEach(({ figure }) => observer.observe(figure));
}

begin();

// Starts the models of a page as they come near the visible part of it.
//
// A figure with a model holds its picture and a data block, <script type="application/json" data-model>. The picture stays
// where there is no WebGL, and on paper. A figure's data-turnable is "waiting", "ready" or, without WebGL, "still"; that of
// the whole page is "ready" as soon as all models near the visible part are drawn.
//
// A page that gets models later puts such a figure into itself and calls window.alulaViewer.add(its data block).
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
    const holder = element("div", { class: "model" });
    figure.insertBefore(holder, figure.firstChild);
    figure.classList.add("turned");
    try {
      model.started = STARTS[model.kind](holder, JSON.parse(block.textContent));
      figure.dataset.turnable = "ready";
    } catch (error) {
      figure.classList.remove("turned");
      holder.remove();
      figure.dataset.turnable = "still";
      console.error(error);
    }
    return model.started;
  };
  return model;
}

/** Start a model that came after the page; those whose figures are gone are let go. */
function add(models, block) {
  const model = modelOf(block);
  models.splice(0, models.length, ...models.filter(({ figure }) => figure.isConnected), model);
  if (renderer()) model.start();
  else model.figure.dataset.turnable = "still";
}

function begin() {
  const models = [...document.querySelectorAll('script[type="application/json"][data-model]')].map(modelOf);
  window.alulaViewer = { models, add: (block) => add(models, block) };
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

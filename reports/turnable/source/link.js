// A link: the stress that decides, for each variant in its band, or the plastic strain at its collapse, on its deformed shape.

import { Vector3 } from "three";
import { indices, reals } from "./data.js";
import { button, choice, element, slider } from "./elements.js";
import { Legend } from "./legend.js";
import { Stage } from "./stage.js";
import { Surface, colourTexture, trianglesOf } from "./surface.js";
import { fixed, number, plain } from "./words.js";

const ABOVE = 18; // pixels from a pin to its name

/** Build the model of a link in a holder; returns what `window.alulaViewer` offers of it. */
export function startLink(holder, record) {
  const rest = reals(record.nodes);
  const faces = indices(record.faces);
  const surface = new Surface(rest, trianglesOf(faces, record.faces.columns), indices(record.edges), { colours: colourTexture(record.colours) });
  const variants = record.variants.map((variant) => ({ ...variant, displacement: reals(variant.displacement), values: reals(variant.values) }));
  const stage = new Stage(holder, `Model of link ${record.name}: ${record.measure} on its deformed shape`);
  const legend = new Legend(`${record.measure} [${record.unit}]`, record.colours, 0, record.top);
  const reading = element("output", { class: "reading", "aria-live": "polite" });
  let variant = variants[record.governing];
  let factor = record.scale;
  let chosen = null;

  const scale = slider("Deformation", { low: 0, high: 2 * record.scale, step: record.scale / 50, value: record.scale },
    (value) => (value === 0 ? "undeformed" : `× ${plain(value)}`), (value) => {
      factor = value;
      show();
    });
  const value = (node) => ({
    value: variant.values[node],
    unit: record.unit,
    place: Array.from(rest.subarray(3 * node, 3 * node + 3)),
    displacement: Array.from(variant.displacement.subarray(3 * node, 3 * node + 3)),
  });

  function show() {
    surface.deform(variant.displacement, factor);
    stage.redraw();
  }

  function take(place) {
    variant = variants[place];
    surface.colour(variant.values, 0, record.top);
    legend.tell([...variant.peak, `largest displacement ${number(variant.largest, 3)} mm`, "thin grey lines: undeformed", "dashed ring: behind the body"], variant.beyond);
    point(variant.hottest);
    show();
  }

  function point(node) {
    chosen = node;
    const { value: size, place, displacement } = value(node);
    const where = ["x", "y", "z"].map((axis, k) => `${axis} = ${fixed(place[k], 2)}`).join(", ");
    reading.textContent = `${number(size)} ${record.unit} at ${where} mm; displacement ${number(Math.hypot(...displacement), 3)} mm`;
    stage.redraw();
  }

  function face(node) {
    const toward = new Vector3(...record.toward);
    const free = surface.freeDirection(node, toward);
    point(node);
    stage.aim(surface.node(node), free ?? toward, record.close, free === null); // inside of a hollow body: cut open
  }

  function pickAt(event) {
    const box = stage.canvas.getBoundingClientRect();
    const found = surface.pick(stage.ray(event.clientX - box.left, event.clientY - box.top));
    if (found && found.node !== chosen) point(found.node);
  }

  stage.canvas.addEventListener("pointermove", (event) => {
    if (!event.buttons) pickAt(event);
  });
  stage.canvas.addEventListener("click", pickAt);
  stage.picture.after(reading);
  stage.tools.append(button(record.seek, `Show the place of the ${record.seek.toLowerCase()}`, () => face(variant.hottest)));
  if (variants.length > 1) {
    stage.tools.append(choice("Variant", variants.map(({ title }, place) => title + (place === record.governing ? " (value)" : "")), record.governing, take));
  }
  stage.tools.append(scale.line);
  reading.after(legend.box);
  stage.scene.add(surface.group, surface.still());
  stage.overlays.push((pen) => {
    for (const [name, [x, y]] of Object.entries(record.points)) {
      const at = stage.project(new Vector3(x, y, record.high));
      stage.write(pen, name, at.x, at.y - ABOVE, { bold: true, align: "center" });
    }
    const { x, y } = stage.project(surface.node(chosen));
    const dash = surface.seen(chosen, stage.ray(x, y)) ? [] : [3, 3];
    for (const [colour, width] of [["#ffffff", 4], ["#1c2733", 1.6]]) {
      Object.assign(pen, { strokeStyle: colour, lineWidth: width });
      pen.setLineDash(dash);
      pen.beginPath();
      pen.arc(x, y, 7, 0, 2 * Math.PI);
      pen.stroke();
    }
    pen.setLineDash([]);
  });
  stage.look(record.corners, record.toward, record.up);
  take(record.governing);
  stage.draw();

  return {
    stage,
    nodes: rest.length / 3,
    value,
    screen: (node) => {
      const box = stage.canvas.getBoundingClientRect();
      const at = stage.project(surface.node(node));
      return { x: box.left + at.x, y: box.top + at.y, seen: surface.seen(node, stage.ray(at.x, at.y)) };
    },
    reading: () => reading.textContent,
    legend: () => legend.box.innerText,
    face: (node) => {
      face(node);
      stage.draw();
    },
    hottest: () => variant.hottest,
  };
}

// The linkage as a whole: its links in their layers, over its motion, each in the colour of its value at the pose shown.

import { Group, Vector3 } from "three";
import { lineSurface, pinSurface, plateSurface } from "./bodies.js";
import { reals, shades } from "./data.js";
import { button, choice, element, slider } from "./elements.js";
import { Legend } from "./legend.js";
import { drawMarks } from "./marks.js";
import { Stage } from "./stage.js";
import { colourTexture, colours } from "./surface.js";
import { number, plain } from "./words.js";

const HINT = "Point at a link or a pin, or tap it, to read its value.";
const SECONDS = 5; // of the whole motion
const PIN = "#39434d";
const BARE = "#aab4bd";

/** Build the model of a linkage in a holder; returns what `window.alulaViewer` offers of it. */
export function startLinkage(holder, record) {
  const stage = new Stage(holder, `Model of the linkage: ${record.title}`);
  const { motion, pins } = record;
  const table = colours(record.colours);
  const groups = new Map(record.links.map(({ name }) => [name, new Group()]));
  const bodies = record.links.flatMap((link) => bodiesOf(link, record));
  const frames = motion.frames ? reals(motion.frames) : [];
  const reading = element("output", { class: "reading", "aria-live": "polite" });
  const legend = element("div");
  const values = record.values.map((one) => {
    const along = Object.entries(one.along).map(([link, found]) => [link, { ...found, shades: shades(found.shades) }]);
    return { ...one, along: Object.fromEntries(along) };
  });
  const shows = [...values, { label: record.layered ? "layers" : "links", layers: true }];
  let [pose, apart, playing] = [motion.first, record.apart.first, 0];
  let [show, seen] = [shows[0], null];

  for (const body of bodies) groups.get(body.link).add(body.surface.group);
  for (const group of groups.values()) stage.scene.add(group);

  /** Where a point of a link is now, in the axes of the scene. */
  function placeOf(link, x, y, z) {
    const group = groups.get(link);
    group.updateMatrix();
    return new Vector3(x, y, z).applyMatrix4(group.matrix);
  }

  function valueOf(body, at = pose) {
    const values = show.layers ? null : body.pin ? body.names.map((name) => show.pins[name]).find(Boolean) : show.links[body.link];
    return values ? values[values.length === 1 ? 0 : at] : null;
  }

  function move() {
    motion.links.forEach((name, k) => {
      const [angle, x, y] = frames.subarray(3 * (pose * motion.links.length + k));
      groups.get(name).rotation.z = angle;
      groups.get(name).position.set(x, y, 0);
    });
  }

  function pull() {
    const step = apart * record.apart.far;
    for (const body of bodies) {
      if (body.pin) body.surface.deform(body.steps, step);
      else body.surface.group.position.z = body.rank * step;
    }
  }

  function paint() {
    for (const body of bodies) {
      const { uniforms } = body.surface.mesh.material;
      const value = valueOf(body);
      uniforms.coloured.value = Number.isFinite(value) ? 1 : 0;
      uniforms.plain.value.set(show.layers && !body.pin && !body.bare ? record.layers[(body.rank + record.layers.length) % record.layers.length] : body.pin ? PIN : BARE);
      if (!Number.isFinite(value)) continue;
      const texels = body.texture.image.data;
      const shade = shadeOf(value / show.top);
      const along = body.pin ? null : show.along[body.link];
      for (let k = 0; k < 256; k += 1) {
        texels.set(table[along ? along.shades[pose * along.stretches + stretchAt(body, along, k / 255)] : shade], 4 * k);
      }
      body.texture.needsUpdate = true;
    }
  }

  function tell() {
    reading.textContent = seen ? describe(seen) : HINT;
    stage.redraw();
  }

  /** A body in words: its name, its value with the unit, its place. */
  function describe(body) {
    const value = valueOf(body);
    const told = Number.isFinite(value) ? `${number(value, 3)} ${show.unit}` : "";
    if (body.pin) return [told, body.text].filter(Boolean).join(", ");
    const { name, ground, layer } = body.of;
    const text = show.texts && show.texts[name];
    return [`${ground ? "ground" : "link"} ${name}${told && ` ${told}`}`, text, layer].filter(Boolean).join("; ");
  }

  function take(place) {
    show = shows[place];
    const known = !show.layers && show.top > 0;
    const scale = known ? new Legend(`${show.title} [${show.unit}]`, record.colours, 0, show.top) : null;
    if (scale) scale.tell(show.note ? [show.note] : [], show.beyond);
    legend.replaceChildren(...(scale ? [scale.box] : []));
    paint();
    tell();
  }

  function pickAt(event) {
    const box = stage.canvas.getBoundingClientRect();
    seen = nearest(bodies, stage.ray(event.clientX - box.left, event.clientY - box.top));
    tell();
  }

  const told = (value) => motion.texts[value];
  const poses = slider("Pose", { low: motion.start, high: motion.texts.length - 1, step: 1, value: pose }, told, (value) => {
    stop();
    to(value);
  });
  const layers = slider("Layers apart", { low: 0, high: 1, step: 0.02, value: apart }, distanceTold, (value) => {
    apart = value;
    pull();
    stage.frame(corners());
  });
  const play = button("▶ Play", "Play the motion", () => (playing ? stop() : start()));

  function distanceTold(value) {
    const distance = `${plain(Number((value * record.apart.far).toPrecision(2)))} mm`;
    if (record.layered) return value === 0 ? "as built" : `by ${distance}`;
    return value === 0 ? "in one plane" : `by ${distance}, to be told apart`;
  }

  function to(value) {
    pose = value;
    move();
    paint();
    tell();
  }

  function start() {
    let [last, way] = [performance.now(), 1];
    const interval = (1000 * SECONDS) / (motion.texts.length - motion.start);
    const next = (now) => {
      playing = requestAnimationFrame(next);
      const steps = Math.floor((now - last) / interval);
      if (!steps) return;
      last += steps * interval;
      const count = motion.texts.length - motion.start;
      let place = pose - motion.start + way * Math.min(steps, count - 1);
      if (motion.returns) place = (place + count) % count;
      else if (place < 0 || place > count - 1) {
        place = place < 0 ? -place : 2 * (count - 1) - place;
        way = -way;
      }
      to(place + motion.start);
      poses.input.value = pose;
      poses.show();
    };
    playing = requestAnimationFrame(next);
    tellPlay("⏸ Pause", "Pause the motion");
  }

  function stop() {
    cancelAnimationFrame(playing);
    playing = 0;
    tellPlay("▶ Play", "Play the motion");
  }

  function tellPlay(text, title) {
    play.textContent = text;
    play.title = title;
    play.setAttribute("aria-label", title);
  }

  /** Corners of all that is seen at some poses, as the layers are apart now. */
  function corners() {
    const found = [];
    const [count, now] = [motion.texts.length, pose];
    for (pose of new Set([0, 1, 2, 3, 4, 5, 6, 7, 8].map((k) => Math.round((k / 8) * (count - 1))))) {
      move();
      for (const { link, box, rank, pin } of bodies) {
        if (!pin) found.push(...box.map(([x, y, z]) => placeOf(link, x, y, z + rank * apart * record.apart.far).toArray()));
      }
    }
    pose = now;
    move();
    return found;
  }

  stage.canvas.addEventListener("pointermove", (event) => {
    if (!event.buttons) pickAt(event);
  });
  stage.canvas.addEventListener("click", pickAt);
  stage.picture.after(reading);
  if (motion.texts.length - motion.start > 1) stage.tools.append(element("div", { class: "moving" }, play, poses.line));
  stage.tools.append(layers.line, choice("Colour", shows.map(({ label }) => label), 0, take));
  holder.append(legend);
  const heightOf = (link) => {
    const body = bodies.find((one) => one.link === link && !one.pin);
    return body.box.at(-1)[2] + body.rank * apart * record.apart.far;
  };
  const at = (link, x, y) => placeOf(link, x, y, heightOf(link));
  stage.overlays.push((pen) => drawMarks(pen, stage, record, at, (link) => groups.get(link).rotation.z));
  move();
  pull();
  stage.look(corners(), record.view.toward, record.view.up);
  take(0);
  stage.draw();

  return {
    stage,
    poses: motion.texts.length,
    pose: () => ({ place: pose, text: motion.texts[pose] }),
    move: (value) => {
      stop();
      to(value);
      poses.input.value = value;
      poses.show();
    },
    playing: () => playing !== 0,
    joint: (name) => {
      const pin = pins.find(({ names }) => names.includes(name));
      return placeOf(pin.link, ...pin.at, 0).toArray().slice(0, 2);
    },
    value: (link) => {
      const body = bodies.find((one) => one.link === link && !one.pin);
      return { value: valueOf(body), unit: show.unit };
    },
    screen: (link) => visible(stage, bodies, link),
    reading: () => reading.textContent,
  };
}

/** The place of a share of the legend's range among its 256 colours. */
function shadeOf(share) {
  return Math.round(255 * Math.min(Math.max(share, 0), 1));
}

/** In which stretch of its link a share of a body's extent along x lies. */
function stretchAt({ box }, { ends: [first, last], stretches }, share) {
  const x = box[0][0] + share * (box.at(-1)[0] - box[0][0]);
  return Math.min(Math.max(Math.floor(((x - first) / (last - first)) * stretches), 0), stretches - 1);
}

/** The surfaces of a link and of the pins that move with it. */
function bodiesOf(link, record) {
  const look = () => ({ colours: colourTexture(record.colours) });
  const made = [];
  const add = (surface, facts) => {
    const texture = surface.mesh.material.uniforms.colours.value;
    const box = cornersOf(surface.rest);
    const [low, high] = [box[0][0], box.at(-1)[0]];
    surface.colour(Float32Array.from({ length: surface.rest.length / 3 }, (_, k) => surface.rest[3 * k]), low, Math.max(high, low + 1e-9));
    made.push({ link: link.name, of: link, surface, texture, box, ...facts });
  };
  for (const plate of link.plates) add(plateSurface(plate, look()), { rank: plate.rank });
  if (link.lines) add(lineSurface(link.lines, look()), { rank: link.lines.rank, bare: true });
  for (const pin of record.pins.filter((one) => one.link === link.name)) {
    const surface = pinSurface(pin, look());
    const middle = (pin.low + pin.high) / 2;
    const steps = Float32Array.from(surface.rest, (at, k) => (k % 3 === 2 ? pin.steps[at > middle ? 1 : 0] : 0));
    add(surface, { pin: true, names: pin.names, steps, text: pin.text });
  }
  return made;
}

/** The corners of a box about nodes, the least first and the greatest last. */
function cornersOf(nodes) {
  const ends = [0, 1, 2].map((axis) => {
    const all = nodes.filter((_, k) => k % 3 === axis);
    return [Math.min(...all), Math.max(...all)];
  });
  return ends[0].flatMap((x) => ends[1].flatMap((y) => ends[2].map((z) => [x, y, z])));
}

/** The body that a ray meets first, or null. */
function nearest(bodies, ray) {
  let [found, distance] = [null, Infinity];
  for (const body of bodies) {
    const hit = body.surface.pick(ray);
    if (hit && hit.distance < distance) [found, distance] = [body, hit.distance];
  }
  return found;
}

/** A place of the page [pixels] at which a link is seen, or null where others hide it. */
function visible(stage, bodies, link) {
  const box = stage.canvas.getBoundingClientRect();
  for (const { surface } of bodies.filter((one) => one.link === link && !one.pin)) {
    for (let k = 0; k < surface.triangles.length; k += 3) {
      const at = [0, 1, 2].reduce((sum, corner) => sum.add(surface.node(surface.triangles[k + corner])), new Vector3());
      const { x, y } = stage.project(at.divideScalar(3));
      const found = nearest(bodies, stage.ray(x, y));
      if (found && found.surface === surface) return { x: box.left + x, y: box.top + y };
    }
  }
  return null;
}

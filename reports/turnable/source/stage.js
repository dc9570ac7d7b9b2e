// A scene with a camera that a reader turns, drawn when something has changed, in parallel projection.
//
// All stages of a page share one WebGL context, since browsers allow some sixteen: each picture is drawn there and copied
// to the stage's own canvas, on which labels are written.

import { ColorManagement, LinearSRGBColorSpace, OrthographicCamera, Quaternion, Scene, Vector3, WebGLRenderer } from "three";
import { button, element } from "./elements.js";
import { HELP, letTurn } from "./turning.js";
import { plain, round } from "./words.js";

const X = new Vector3(1, 0, 0);
const Y = new Vector3(0, 1, 0);
const MARGIN = 0.08; // of the picture, left free about the model in its first view
const INK = "#1c2733";

let context = null;
const stages = [];
let turns = 0;

/** The page's renderer, or null where the browser has no WebGL. */
export function renderer() {
  if (context === null) {
    ColorManagement.enabled = false; // colours stay as the pictures have them
    const canvas = document.createElement("canvas");
    const webgl = canvas.getContext("webgl2", { antialias: true, alpha: false }); // three.js would complain in the console
    context = webgl ? new WebGLRenderer({ canvas, context: webgl }) : false;
    if (context) {
      context.outputColorSpace = LinearSRGBColorSpace;
      context.setClearColor(0xffffff);
      canvas.addEventListener("webglcontextrestored", () => stages.forEach((stage) => stage.redraw()));
    }
  }
  return context || null;
}

export class Stage {
  /**
   * @param {Element} holder receives the canvas and the buttons
   * @param {string} label the model's name, for readers that cannot see it
   */
  constructor(holder, label) {
    this.scene = new Scene();
    this.camera = new OrthographicCamera();
    this.target = new Vector3();
    this.halfHeight = 1;
    this.overlays = []; // functions of (2D context, stage) that write on the picture
    this.canvas = element("canvas", { tabindex: "0", role: "application", "aria-label": label, "aria-describedby": "" });
    const help = element("p", { class: "help", id: `turnable-help-${(turns += 1)}` }, HELP);
    this.canvas.setAttribute("aria-describedby", help.id);
    this.tools = element("div", { class: "tools" });
    this.tools.append(
      button("Reset view", "Reset view", () => this.reset()),
      button("+", "Larger", () => this.zoom(1 / 1.2)),
      button("−", "Smaller", () => this.zoom(1.2)),
    );
    this.picture = element("div", { class: "picture" }, this.canvas);
    holder.append(this.picture, this.tools, help);
    letTurn(this.canvas, this);
    new ResizeObserver(() => this.redraw()).observe(this.picture);
    stages.push(this);
  }

  /** Set the first view: the points [[x, y, z], ...] to be seen, and the directions to the viewer and up. */
  look(points, toward, up) {
    this.camera.position.set(0, 0, 0);
    this.camera.up.set(...up);
    this.camera.lookAt(new Vector3(...toward).negate());
    this.first = this.camera.quaternion.clone();
    this.fit = true;
    this.frame(points);
  }

  /** Return to the first view. */
  reset() {
    this.cut = false;
    this.camera.quaternion.copy(this.first);
    this.fit = true;
    this.frame(this.seen);
  }

  /** Show the points [[x, y, z], ...]; a reader who has moved or scaled the model keeps the view. */
  frame(points) {
    this.seen = points;
    const corners = points.map((point) => new Vector3(...point));
    if (this.fit) {
      const turned = this.camera.quaternion;
      const back = turned.clone().invert();
      const seen = corners.map((point) => point.clone().applyQuaternion(back));
      const range = (axis) => [Math.min(...seen.map((point) => point[axis])), Math.max(...seen.map((point) => point[axis]))];
      const [[left, right], [low, high], [far, near]] = ["x", "y", "z"].map(range);
      this.target.set((left + right) / 2, (low + high) / 2, (far + near) / 2).applyQuaternion(turned); // turns about the middle
      this.halves = [(right - left) / 2, (high - low) / 2];
    }
    this.radius = Math.max(...corners.map((point) => point.distanceTo(this.target)));
    this.redraw();
  }

  /** Look at a point [mm] from a direction, with so much to be seen above and below it [mm]; `cut` takes away what is before it. */
  aim(point, toward, halfHeight, cut = false) {
    this.camera.position.set(0, 0, 0);
    this.camera.up.copy(Math.abs(toward.y) < 0.95 ? Y : X);
    this.camera.lookAt(toward.clone().negate());
    this.target.copy(point);
    Object.assign(this, { halfHeight, cut, fit: false });
    this.redraw();
  }

  /** Turn the model about the picture's axes, to the right and down [radians]. */
  turn(right, down) {
    this.camera.quaternion
      .multiply(new Quaternion().setFromAxisAngle(Y, -right))
      .multiply(new Quaternion().setFromAxisAngle(X, -down));
    this.redraw();
  }

  /** Show more (factor above 1) or less. */
  zoom(factor) {
    const [least, most] = [this.radius / 500, this.radius * 4];
    this.halfHeight = Math.min(Math.max(this.halfHeight * factor, least), most);
    this.fit = false;
    this.redraw();
  }

  /** Move the model by pixels of the page. */
  pan(right, down) {
    const size = (2 * this.halfHeight) / this.canvas.clientHeight;
    this.fit = false;
    this.target.add(new Vector3(-right * size, down * size, 0).applyQuaternion(this.camera.quaternion));
    this.redraw();
  }

  /** Draw before the browser shows the next picture; several calls draw once. */
  redraw() {
    if (this.waiting) return;
    this.waiting = requestAnimationFrame(() => {
      this.waiting = 0;
      this.draw();
    });
  }

  /** Draw now. */
  draw() {
    const gl = renderer();
    const [width, height] = [this.picture.clientWidth, this.picture.clientHeight];
    if (!gl || !width || !height || gl.getContext().isContextLost()) return;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const [wide, tall] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this.fit) this.halfHeight = (Math.max(this.halves[1], (this.halves[0] * height) / width) || 1) * (1 + 2 * MARGIN);
    this.place(width / height);
    const size = gl.domElement;
    if (size.width !== wide || size.height !== tall) gl.setSize(wide, tall, false);
    gl.render(this.scene, this.camera);
    if (this.canvas.width !== wide || this.canvas.height !== tall) Object.assign(this.canvas, { width: wide, height: tall });
    const pen = this.canvas.getContext("2d");
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.drawImage(size, 0, 0);
    pen.scale(ratio, ratio);
    this.bar(pen, height);
    if (this.cut) this.write(pen, "cut open", 12, 16);
    for (const overlay of this.overlays) overlay(pen, this);
  }

  /** Draw no more, and free what the graphics card holds of the model. */
  end() {
    cancelAnimationFrame(this.waiting);
    this.waiting = -1;
    stages.splice(stages.indexOf(this), 1);
    this.scene.traverse(({ geometry, material }) => [geometry, ...[material ?? []].flat()].forEach((one) => one?.dispose()));
  }

  place(aspect) {
    const camera = this.camera;
    const away = 10 * this.radius + this.target.length();
    Object.assign(camera, { left: -this.halfHeight * aspect, right: this.halfHeight * aspect, top: this.halfHeight,
      bottom: -this.halfHeight, near: away - (this.cut ? this.radius / 1000 : 2 * this.radius + this.halfHeight), far: away + 2 * this.radius + this.halfHeight });
    camera.position.set(0, 0, away).applyQuaternion(camera.quaternion).add(this.target);
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
  }

  /** Where a point [mm] is in the picture [pixels from its upper left corner], and how near to the viewer [mm]. */
  project(point) {
    const at = point.clone().project(this.camera);
    return { x: ((at.x + 1) / 2) * this.picture.clientWidth, y: ((1 - at.y) / 2) * this.picture.clientHeight, z: -at.z };
  }

  /** The ray through a place of the picture [pixels]. */
  ray(x, y) {
    const shares = [(2 * x) / this.picture.clientWidth - 1, 1 - (2 * y) / this.picture.clientHeight];
    return {
      origin: new Vector3(...shares, -1).unproject(this.camera),
      direction: new Vector3(0, 0, -1).applyQuaternion(this.camera.quaternion),
    };
  }

  /** Write with a white border, so that it reads on any colour; what would stand half in the picture stands in it. */
  write(pen, text, x, y, { bold = false, align = "left" } = {}) {
    pen.font = `${bold ? "bold " : ""}13px system-ui, sans-serif`;
    Object.assign(pen, { textAlign: align, textBaseline: "middle", lineJoin: "round", lineWidth: 4, strokeStyle: "#ffffffd0", fillStyle: INK });
    const [width, wide] = [this.picture.clientWidth, pen.measureText(text).width];
    const before = align === "center" ? wide / 2 : 0;
    const at = x < -wide || x > width + wide ? x : Math.max(Math.min(x, width - 4 - wide + before), before + 4);
    pen.strokeText(text, at, y);
    pen.fillText(text, at, y);
  }

  bar(pen, height) {
    const size = (2 * this.halfHeight) / height;
    const length = round(110 * size);
    Object.assign(pen, { strokeStyle: INK, lineWidth: 2 });
    pen.beginPath();
    pen.moveTo(12, height - 14);
    pen.lineTo(12 + length / size, height - 14);
    pen.stroke();
    this.write(pen, `${plain(length)} mm`, 18 + length / size, height - 14);
  }
}

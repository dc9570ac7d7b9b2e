// How a reader turns, moves and scales a model: mouse, touch and keyboard.
//
// A finger that moves up or down first scrolls the page; one that moves sideways turns the model. The wheel scales the
// model only after a click on it, or with Ctrl: else it scrolls the page.

const STEP = Math.PI / 18;

export const HELP =
  "Drag to turn. Shift and drag, or two fingers, to move. Wheel (after a click), two fingers, + and − to scale. " +
  "Arrow keys turn, 0 resets the view.";

/** Let a canvas turn the camera of a stage. */
export function letTurn(canvas, stage) {
  const pointers = new Map();
  const place = (event) => ({ x: event.clientX, y: event.clientY });

  canvas.addEventListener("pointerdown", (event) => {
    pointers.set(event.pointerId, place(event));
    canvas.setPointerCapture(event.pointerId);
  });
  canvas.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const now = place(event);
    const [dx, dy] = [now.x - before.x, now.y - before.y];
    const other = [...pointers].find(([id]) => id !== event.pointerId)?.[1];
    pointers.set(event.pointerId, now);
    if (other) {
      stage.zoom(Math.hypot(before.x - other.x, before.y - other.y) / Math.max(Math.hypot(now.x - other.x, now.y - other.y), 1));
      stage.pan(dx / 2, dy / 2);
    } else if (event.shiftKey || event.buttons & 6) {
      stage.pan(dx, dy);
    } else {
      stage.turn(dx * 0.008, dy * 0.008);
    }
  });
  for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (event) => pointers.delete(event.pointerId));
  canvas.addEventListener("contextmenu", (event) => event.preventDefault());

  canvas.addEventListener(
    "wheel",
    (event) => {
      if (document.activeElement !== canvas && !event.ctrlKey) return;
      event.preventDefault();
      stage.zoom(Math.exp(Math.sign(event.deltaY) * Math.min(Math.abs(event.deltaY), 100) * 0.002));
    },
    { passive: false },
  );

  const keys = {
    ArrowLeft: () => stage.turn(-STEP, 0),
    ArrowRight: () => stage.turn(STEP, 0),
    ArrowUp: () => stage.turn(0, -STEP),
    ArrowDown: () => stage.turn(0, STEP),
    "+": () => stage.zoom(1 / 1.2),
    "=": () => stage.zoom(1 / 1.2),
    "-": () => stage.zoom(1.2),
    0: () => stage.reset(),
    Home: () => stage.reset(),
  };
  canvas.addEventListener("keydown", (event) => {
    if (!keys[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    keys[event.key]();
  });
}

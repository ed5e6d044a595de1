/**
 * A cap that is to be marked again, on a piece of the photo without any label: a circle is dragged out from its
 * centre and moved or widened after that, points of the rim are clicked and dragged. Enter sends the mark.
 *
 * @module
 */

import { element } from "./dom.js";

/** @typedef {import("../protocol.js").MarkAgain} MarkAgain */
/** @typedef {import("../protocol.js").Circle} Circle */
/** @typedef {import("../protocol.js").Polygon} Polygon */
/** @typedef {import("../protocol.js").Point} Point */

const SIDE = 560;
const GRAB_PX = 10;
const FEWEST = 3;
const WORDS = {
  circle: "Drag a circle from the centre of the dotted cap to its rim; drag it again to put it right.",
  polygon: "Click points around the whole rim of the dotted cap; drag one to move it, Backspace takes the last one.",
};

/**
 * @param {MarkAgain} asked
 * @param {ImageBitmap} photo
 * @param {(mark: Circle | Polygon) => void} send
 * @param {() => void} ended  nothing was sent, or what was sent is kept
 * @returns {{close: () => void}}
 */
export function markAgain(asked, photo, send, ended) {
  const [x0, y0, x1] = asked.box;
  const scale = SIDE / (x1 - x0);
  const canvas = element("canvas", { attributes: { width: String(SIDE), height: String(SIDE), tabindex: "0", "aria-label": WORDS[asked.mark] } });
  /** @type {(text: string, click: () => void) => HTMLButtonElement} */
  const button = (text, click) => element("button", { text, attributes: { type: "button" }, click });
  const take = button("Take it (Enter)", finish);
  const dialog = element(
    "dialog",
    { class: "fairyring-question fairyring-again", attributes: { "aria-label": "Mark this cap" } },
    element("p", { text: WORDS[asked.mark] }),
    canvas,
    element("div", {}, take, button("Later (Esc)", later)),
  );
  /** @type {Circle | null} */
  let circle = null;
  /** @type {Point[]} */
  let points = [];
  /** @type {((at: Point) => void) | null} */
  let drag = null;

  /** The same both ways. @type {(x: number) => number} */
  const flipped = (x) => (asked.mirrored ? SIDE - x : x);
  /** @type {(at: Point) => Point} */
  const shown = ([x, y]) => [flipped((x - x0) * scale), (y - y0) * scale];
  /** @type {(event: PointerEvent) => Point} */
  const placed = (event) => {
    const box = canvas.getBoundingClientRect();
    const [x, y] = [(event.clientX - box.left) * (SIDE / box.width), (event.clientY - box.top) * (SIDE / box.height)];
    return [flipped(x) / scale + x0, y / scale + y0];
  };

  function finish() {
    if (circle) send(circle);
    else if (points.length >= FEWEST) send({ kind: "polygon", points: points.flat() });
  }

  function later() {
    dialog.close();
  }

  function draw() {
    const context = canvas.getContext("2d");
    if (!context) return;
    const width = asked.width * scale;
    context.setTransform(asked.mirrored ? -1 : 1, 0, 0, 1, asked.mirrored ? SIDE : 0, 0);
    context.fillStyle = "#000";
    context.fillRect(0, 0, SIDE, SIDE);
    context.drawImage(photo, -x0 * scale, -y0 * scale, width, (width * photo.height) / photo.width);
    context.setTransform(1, 0, 0, 1, 0, 0);
    dot(context, shown(asked.at), 4, "#ffd84a");
    if (circle) {
      const [x, y] = shown([circle.cx, circle.cy]);
      context.beginPath();
      context.arc(x, y, circle.r * scale, 0, 2 * Math.PI);
      line(context);
      dot(context, [x, y], 3, "#45c8ff");
    }
    if (points.length > 1) {
      context.beginPath();
      for (const at of points) context.lineTo(...shown(at));
      context.closePath();
      line(context);
    }
    for (const at of points) dot(context, shown(at), 4, "#45c8ff");
    take.disabled = !circle && points.length < FEWEST;
  }

  canvas.addEventListener("pointerdown", (event) => {
    canvas.setPointerCapture(event.pointerId);
    const at = placed(event);
    if (asked.mark === "circle") drag = movedCircle(at);
    else drag = movedPoint(at);
    draw();
  });
  canvas.addEventListener("pointermove", (event) => {
    drag?.(placed(event));
    if (drag) draw();
  });
  canvas.addEventListener("pointerup", () => (drag = null));

  /** What a drag does to the circle: widens it by its rim, moves it by its inside, or begins another one. @type {(from: Point) => (at: Point) => void} */
  function movedCircle([x, y]) {
    const was = circle;
    const off = was ? Math.hypot(x - was.cx, y - was.cy) : Infinity;
    if (was && Math.abs(off - was.r) * scale < GRAB_PX)
      return (to) => (circle = { ...was, r: Math.hypot(to[0] - was.cx, to[1] - was.cy) });
    if (was && off < was.r) return (to) => (circle = { ...was, cx: was.cx + to[0] - x, cy: was.cy + to[1] - y });
    return (to) => (circle = { kind: "circle", cx: x, cy: y, r: Math.hypot(to[0] - x, to[1] - y) });
  }

  function takeBack() {
    points = points.slice(0, -1);
    circle = null;
    draw();
  }

  /** @type {(at: Point) => (at: Point) => void} */
  function movedPoint(at) {
    const near = points.findIndex(([x, y]) => Math.hypot(x - at[0], y - at[1]) * scale < GRAB_PX);
    const nth = near < 0 ? points.push(at) - 1 : near;
    return (to) => (points[nth] = to);
  }

  dialog.addEventListener("keydown", (event) => {
    if (event.key === "Enter") finish();
    else if (event.key === "Backspace") takeBack();
    else return;
    event.preventDefault();
  });
  dialog.addEventListener("close", () => {
    dialog.remove();
    ended();
  });
  document.body.append(dialog);
  draw();
  dialog.showModal();
  canvas.focus();
  return { close: () => dialog.close() };
}

/** @type {(context: CanvasRenderingContext2D) => void} */
function line(context) {
  for (const [width, colour] of /** @type {[number, string][]} */ ([[3, "rgba(0, 0, 0, 0.6)"], [1.5, "#45c8ff"]])) {
    context.lineWidth = width;
    context.strokeStyle = colour;
    context.stroke();
  }
}

/** @type {(context: CanvasRenderingContext2D, at: Point, r: number, colour: string) => void} */
function dot(context, [x, y], r, colour) {
  context.beginPath();
  context.arc(x, y, r, 0, 2 * Math.PI);
  context.fillStyle = colour;
  context.fill();
}

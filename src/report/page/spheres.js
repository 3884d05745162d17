"use strict";
const states = JSON.parse(document.getElementById("run").textContent);
const element = (name) => document.getElementById(name);
const canvas = element("packing"), pen = canvas.getContext("2d");
const start = { yaw: 0.5, pitch: 0.35, zoom: 1 };
let view = { ...start };
let asked = false;

/** A lit ball, drawn once for each colour. */
function sprite(light, dark) {
  const ball = document.createElement("canvas"), size = 128;
  ball.width = ball.height = size;
  const brush = ball.getContext("2d");
  const shade = brush.createRadialGradient(0.36 * size, 0.32 * size, 0.03 * size, size / 2, size / 2, size / 2);
  shade.addColorStop(0, "#ffffff");
  shade.addColorStop(0.35, light);
  shade.addColorStop(1, dark);
  brush.fillStyle = shade;
  brush.arc(size / 2, size / 2, size / 2 - 1, 0, 2 * Math.PI);
  brush.fill();
  return ball;
}
const carrying = sprite("#e6dfd0", "#8d8571"), loose = sprite("#b9d3ea", "#4d7ba6");

/** Right, up, towards the eye: z is up, turned about z by the yaw and tilted by the pitch. */
function turned(x, y, z) {
  const right = x * Math.cos(view.yaw) + y * Math.sin(view.yaw), away = y * Math.cos(view.yaw) - x * Math.sin(view.yaw);
  return [right, z * Math.cos(view.pitch) + away * Math.sin(view.pitch), z * Math.sin(view.pitch) - away * Math.cos(view.pitch)];
}

function draw() {
  asked = false;
  const state = states[Number(element("which").value)], ratio = window.devicePixelRatio || 1;
  canvas.width = canvas.clientWidth * ratio;
  canvas.height = canvas.clientHeight * ratio;
  const scale = (0.47 * Math.min(canvas.width, canvas.height) / state.reach) * view.zoom;
  const place = (p) => {
    const [right, up, near] = turned(p[0] - state.centre[0], p[1] - state.centre[1], p[2] - state.centre[2]);
    return [canvas.width / 2 + scale * right, canvas.height / 2 - scale * up, near];
  };
  const nearest = state.reach * (1 - 2 * Number(element("cut").value));
  const line = (from, to, width, colour) => {
    pen.strokeStyle = colour;
    pen.lineWidth = width;
    pen.beginPath();
    pen.moveTo(from[0], from[1]);
    pen.lineTo(to[0], to[1]);
    pen.stroke();
  };
  pen.lineCap = "round";
  const forces = element("forces").checked, spheres = element("spheres").checked, rattlers = element("rattlers").checked;
  const items = [];
  for (const ball of state.balls) {
    const at = place(ball);
    if ((ball[4] ? rattlers : spheres) && at[2] <= nearest) {
      items.push({ depth: at[2], at, size: scale * ball[3], picture: ball[4] ? loose : carrying });
    }
  }
  for (const one of forces ? state.lines : []) {
    const from = place(one), to = place(one.slice(3)), depth = (from[2] + to[2]) / 2;
    if (depth <= nearest) {
      items.push({ depth, from, to, width: Math.max(0.7 * ratio, 0.1 * state.radius * scale * Math.abs(one[6])), colour: one[6] < 0 ? "#1b5fbf" : one[6] > 0 ? "#8c1c13" : "#777" });
    }
  }
  for (const edge of state.edges) line(place(edge), place(edge.slice(3)), ratio, "#222");
  items.sort((a, b) => a.depth - b.depth);
  for (const item of items) {
    if (item.picture) {
      pen.globalAlpha = forces && item.picture === carrying ? 0.35 : 1;
      pen.drawImage(item.picture, item.at[0] - item.size, item.at[1] - item.size, 2 * item.size, 2 * item.size);
    } else {
      pen.globalAlpha = 1;
      line(item.from, item.to, item.width, item.colour);
    }
  }
  const count = state.balls.filter((ball) => ball[4]).length;
  element("what").textContent = `Equilibrium ${state.equilibrium}: ${state.balls.length} spheres, ${count} without force, ${state.lines.length} contacts (width: force).`;
  document.body.dataset.drawn = `${items.length} ${view.yaw.toFixed(3)} ${view.pitch.toFixed(3)}`;
}
function ask() {
  if (!asked) requestAnimationFrame(draw);
  asked = true;
}
function turn(yaw, pitch) {
  view.yaw += yaw;
  view.pitch = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, view.pitch + pitch));
  ask();
}
function zoom(factor) {
  view.zoom = Math.max(0.2, Math.min(50, view.zoom * factor));
  ask();
}
const keys = {
  ArrowLeft: () => turn(-0.1, 0), ArrowRight: () => turn(0.1, 0), ArrowUp: () => turn(0, 0.1), ArrowDown: () => turn(0, -0.1),
  "+": () => zoom(1.2), "-": () => zoom(1 / 1.2), 0: () => { view = { ...start }; ask(); },
};
canvas.addEventListener("keydown", (event) => {
  if (event.key in keys) {
    keys[event.key]();
    event.preventDefault();
  }
});
canvas.addEventListener("pointerdown", (event) => canvas.setPointerCapture(event.pointerId));
canvas.addEventListener("pointermove", (event) => {
  if (event.buttons & 1) turn(-0.01 * event.movementX, 0.01 * event.movementY);
});
canvas.addEventListener("wheel", (event) => {
  zoom(Math.exp(-0.001 * event.deltaY));
  event.preventDefault();
}, { passive: false });
window.addEventListener("resize", ask);
for (const name of ["which", "spheres", "forces", "rattlers", "cut"]) element(name).addEventListener("input", ask);
element("which").max = states.length - 1;
element("which").value = states.length - 1;
if (states.length > 0) draw();
document.body.dataset.ready = "";

// Brings the page to life.
showHead();
showEnergy();
showSummary();

const slider = document.getElementById("time"), playButton = document.getElementById("play");
slider.max = frameCount - 1;
let view = null, playing = false, before = 0;

const chart = new Chart((time) => {
  const nearest = scene.times.reduce((best, t, i) =>
    Math.abs(t - time) < Math.abs(scene.times[best] - time) ? i : best, 0);
  showTime(nearest);
});
chooseColumns(chart, []);

function showTime(frame) {
  const k = Math.min(Math.floor(frame), frameCount - 1), next = Math.min(k + 1, frameCount - 1);
  const time = scene.times[k] + (scene.times[next] - scene.times[k]) * (frame - k);
  slider.value = Math.round(frame);
  document.getElementById("clock").textContent =
    `${written(time, 4)} ${unit("time")}  (${Math.round(frame) + 1} of ${frameCount})`;
  chart.now = time;
  chart.draw();
  if (!view) return;
  view.time = frame;
  view.redraw(true);
}

function play(isOn) {
  playing = isOn;
  playButton.textContent = isOn ? "\u275a\u275a" : "\u25b6";
  playButton.ariaLabel = isOn ? "Pause" : "Play";
  if (!isOn || !view) return;
  if (view.time >= frameCount - 1) showTime(0);
  before = performance.now();
  requestAnimationFrame(step);
}

function step(now) {
  if (!playing) return;
  const whole = 1000 * Number(document.getElementById("speed").value);
  const frame = view.time + Math.min(now - before, 1000) / whole * (frameCount - 1);
  before = now;
  showTime(Math.min(frame, frameCount - 1));
  if (frame >= frameCount - 1) play(false);
  else requestAnimationFrame(step);
}

slider.addEventListener("input", () => {
  play(false);
  showTime(Number(slider.value));
});
playButton.addEventListener("click", () => play(!playing));
document.getElementById("view").addEventListener("keydown", (event) => {
  if (event.key === " ") play(!playing);
  else if (event.key === "ArrowRight") showTime(Math.min(Math.round(view.time) + 1, frameCount - 1));
  else if (event.key === "ArrowLeft") showTime(Math.max(Math.round(view.time) - 1, 0));
  else return;
  event.preventDefault();
});

// What is shown stands behind the # of the address, to be kept or sent: frame, field, hidden parts, camera.
let isRead = false;
function writeAddress() {
  if (!view || !isRead) return;
  const { chosen, camera, state } = view, said = new URLSearchParams();
  said.set("field", chosen.field?.name || "part");
  said.set("frame", Math.round(view.time));
  if (state.hidden.size > 0) said.set("hide", [...state.hidden].join(","));
  said.set("look", camera.said().join(","));
  try {
    history.replaceState(null, "", `#${said}`);
  } catch (refused) { /* a browser may refuse so many; nothing depends on it */ }
}

function readAddress(controls) {
  const said = new URLSearchParams(location.hash.slice(1));
  if (said.has("field")) controls.useField(scene.fields.find((field) => field.name === said.get("field")) || null);
  for (const part of (said.get("hide") || "").split(",")) {
    if (part !== "" && Number(part) < scene.parts.length) controls.showPart(Number(part), false);
  }
  const look = (said.get("look") || "").split(",").map(Number);
  if (look.length === 6 && look.every(Number.isFinite)) {
    view.camera.hear(look);
    view.isPlaced = true;
  }
  const frame = Number(said.get("frame") || 0);
  showTime(Number.isFinite(frame) ? Math.min(Math.max(frame, 0), frameCount - 1) : 0);
  isRead = true;
}

function addViews() {
  const looks = { iso: [-54, 16], "+x": [0, 0], "\u2212x": [180, 0], "+y": [90, 0], "\u2212y": [-90, 0], "+z": [-90, 90] };
  const box = document.getElementById("views");
  for (const [name, look] of Object.entries(looks)) {
    box.append(element("button", { title: `View from ${name}`, onclick: () => {
      view.camera.look(...look);
      view.fit();
    } }, name));
  }
}

try {
  view = new View();
  const controls = new Controls(view, () => {
    writeAddress();
    chart.draw();
  });
  view.moved = () => {
    view.isPlaced = true;
    writeAddress();
  };
  addViews();
  readAddress(controls);
} catch (fault) {
  const said = document.getElementById("fault");
  said.hidden = false;
  said.textContent = fault.message;
  showTime(0);
}

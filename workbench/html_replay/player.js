"use strict";
// Plays: one time for the scene, the events and the slider.

const data = JSON.parse(document.getElementById("data").textContent);
const get = (id) => document.getElementById(id);

function table(id, values) {
  const rows = Object.entries(values || {}).map(([name, value]) => {
    const row = document.createElement("tr"), head = document.createElement("th"), cell = document.createElement("td");
    head.textContent = name;
    cell.textContent = value;
    row.append(head, cell);
    return row;
  });
  get(id).hidden = !rows.length;
  get(id).tBodies[0].replaceChildren(...rows);
}

table("parameters", data.parameters);
table("result", data.events.result);
const came = data.events.result && data.events.result.outcome;
const ENDINGS = { stop: "the model called stop()", done: "no agent had anything left to do", end: "the program was over", exit: "the program ended itself", limits: "its time was over",
  left: data.branched === null ? "it was left before its end" : `its past was changed at ${timeText(data.branched)}` };

let drawing = null;
try {
  if (data.scenes.length) drawing = new Drawing(get("canvas"), data.scenes, data.palette);
} catch (error) {
  get("empty").textContent = error.message;
}
if (!drawing) {
  get("canvas").hidden = true;
  get("empty").hidden = false;
  get("empty").textContent ||= "No scene is stored.";
}

let now = 0, playing = false, before = 0;
const end = Math.max(drawing ? drawing.end : 0, data.events.end);
const events = new Events(data.events, (time) => goTo(time), end);
get("time").max = end;
const over = data.ended ? `Ended: ${ENDINGS[data.ended] || data.ended}.` : `Shown up to ${timeText(end)}: ${data.failed ? `the run failed at that time (${data.failed})` : "the run was not over at that time"}.`;
get("outcome").textContent = (came ? `Outcome: ${came}. ` : "") + over;

function goTo(time) {
  now = Math.min(end, Math.max(0, time));
  get("time").value = now;
  get("time").setAttribute("aria-valuetext", timeText(now, 2, end));
  get("clock").textContent = timeText(now, 2, end);
  events.mark(now);
  if (!drawing) return;
  const early = Math.fround(now) < drawing.begin;
  get("canvas").hidden = early;
  get("empty").hidden = !early;
  get("empty").textContent = `No scene is stored before ${timeText(drawing.begin, 2, end)}.`;
  drawing.draw(now);
}

function play(on) {
  playing = on;
  if (on && now >= end) goTo(0);
  get("play").textContent = on ? "Pause" : "Play";
  get("play").setAttribute("aria-pressed", String(on));
  before = performance.now();
  if (on) requestAnimationFrame(frame);
}

function frame(at) {
  if (!playing) return;
  const passed = Math.max(0, at - before) / 1000;
  before = at;
  goTo(now + passed * Number(get("speed").value));
  if (now >= end) play(false);
  else requestAnimationFrame(frame);
}

get("play").addEventListener("click", () => play(!playing));
get("time").addEventListener("input", (event) => goTo(Number(event.target.value)));
get("follow").checked = drawing !== null && drawing.camera.following;
get("follow").addEventListener("change", (event) => {
  if (drawing) drawing.camera.following = event.target.checked;
  goTo(now);
});
document.addEventListener("keydown", (event) => {
  if (event.target.closest("input, select, button")) return;
  if (event.key === " ") play(!playing);
  else if (event.key === "ArrowRight") goTo(now + (event.shiftKey ? 1 : 0.05));
  else if (event.key === "ArrowLeft") goTo(now - (event.shiftKey ? 1 : 0.05));
  else return;
  event.preventDefault();
});
goTo(0);

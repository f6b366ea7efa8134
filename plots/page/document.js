"use strict";
// Shared by all parts: the data, and elements whose text is never read as markup.
const data = JSON.parse(document.getElementById("data").textContent);
const points = data.points.map((row) => Object.fromEntries(data.columns.map((name, index) => [name, row[index]])));

function element(name, properties = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (key in made) made[key] = value; else made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
}

function timeText(seconds) {
  if (seconds === null) return "";
  for (const [unit, scale] of [["s", 1], ["ms", 1e-3], ["µs", 1e-6]]) {
    if (seconds >= scale) return `${Number((seconds / scale).toPrecision(3))} ${unit}`;
  }
  return `${seconds.toPrecision(3)} s`;
}
const percent = (part) => part === null ? "" : `${Number((100 * part).toPrecision(3))} %`;
const stepText = (step) => step === null ? "" : step < 0.5 ? `1/${Number((1 / step).toPrecision(4))} s` : `${step} s`;
// A mesh by its file's name and four digits of its content's hash.
const words = (name) => {
  const found = /^(?:mesh|folder):(?:[^,]*\/)?([^,]*)(?:.*,content=(.{4}))?/.exec(name);
  return !found ? name.replaceAll("_", " ") : found[2] ? `${found[1]} (${found[2]})` : found[1];
};

// The command that repeats one point: that of its run, with a filter that keeps only this id.
function commandOf(point) {
  const pattern = `^${point.id.replace(/[.*+?^${}()|[\]\\]/g, "\\$&")}$`;
  return `${data.files[point.file].command} --filter '${pattern.replaceAll("'", "'\\''")}'`;
}

// A point's measurements, in words.
function story(point) {
  const parts = [data.labels[point.solver], point.id];
  if (point.seconds !== null) {
    parts.push(`${timeText(point.seconds)} a simulated second` +
      (point.high === null ? "" : ` (${timeText(point.seconds)} to ${timeText(point.high)}, ${point.runs} runs)`));
  }
  if (point.status !== "ok") parts.push(`${point.status}: ${point.detail}`);
  for (const name of ["iterations", "factorizations", "projections"]) {
    if (point[name]) parts.push(`${point[name]} ${name}`);
  }
  if (point.error !== null) parts.push(`error ${point.error.toPrecision(3)}`);
  return parts.join(" · ");
}

// Copies the command that repeats a point, and shows it.
function repeatButton(place, point) {
  const button = element("button", {type: "button"}, "Copy command");
  button.addEventListener("click", async () => {
    const command = commandOf(point);
    try {
      await navigator.clipboard.writeText(command);
      place.textContent = `Copied: ${command}`;
    } catch {
      place.textContent = command;  // a page from a file may not write to the clipboard
    }
  });
  return button;
}

// Pictures are packed by gzip. The picture shown is also the download.
async function unpack(image) {
  const packed = Uint8Array.from(atob(image.dataset.packed), (character) => character.charCodeAt(0));
  const svg = await new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
  image.src = URL.createObjectURL(new Blob([svg], {type: "image/svg+xml"}));
  image.closest("figure").querySelector("a").href = image.src;
}
for (const image of document.querySelectorAll("img[data-packed]")) unpack(image);

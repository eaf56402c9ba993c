// What the result says: one text (JSON) and tables of numbers in base64, each read once.
const head = JSON.parse(document.getElementById("head").textContent);
const scene = head.scene;
const frameCount = scene.times.length;
const noValue = 65535, quantizedSteps = 65534;

function bytesOf(name) {
  const element = document.getElementById(name);
  const text = atob(element.textContent);
  element.remove();  // its text is not needed a second time
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

// Tables are little endian, as is every machine on which browsers run.
const tableOf = (name, Numbers) => new Numbers(bytesOf(name).buffer);

const positions = tableOf("positions", Uint16Array);
const facetTable = tableOf("facets", Uint32Array);  // four nodes and a cell each
const facetLife = tableOf("facet_life", Uint16Array);
const facetKind = tableOf("facet_kind", Uint8Array);
const cellPart = tableOf("cell_part", Uint16Array);
const cellSize = tableOf("cell_size", Float32Array);
const historyValues = tableOf("history", Float32Array);
for (const field of scene.fields) field.codes = tableOf(field.table, Uint16Array);

const solidFacet = 0, shellFacet = 1, lineFacet = 2, vertexFacet = 3;

function historyColumn(name) {
  const place = head.history.columns.indexOf(name);
  const rows = head.history.rows;
  return place < 0 ? new Float32Array(0) : historyValues.subarray(place * rows, (place + 1) * rows);
}

// Units are labels: what the deck does not name is put together from what it does.
function unit(quantity) {
  const has = head.units;
  const made = (wanted, text) => wanted.every((w) => has[w]) ? text : "";
  if (has[quantity]) return has[quantity];
  switch (quantity) {
    case "velocity": return made(["length", "time"], `${has.length}/${has.time}`);
    case "energy": return made(["force", "length"], `${has.force} ${has.length}`);
    case "impulse": return made(["force", "time"], `${has.force} ${has.time}`);
    case "moment": return made(["force", "length"], `${has.force} ${has.length}`);
    case "stress": return made(["force", "length"], `${has.force}/${has.length}\u00b2`);
    case "density": return made(["mass", "length"], `${has.mass}/${has.length}\u00b3`);
    default: return "";
  }
}

function unitOfField(name) {
  if (/^(stress|von_mises|pressure|contact_pressure)/.test(name)) return unit("stress");
  if (/^(displacement|thickness|radius|position|contact_gap)/.test(name)) return unit("length");
  if (/^velocity/.test(name)) return unit("velocity");
  if (/^contact_force/.test(name)) return unit("force");
  if (/^density/.test(name)) return unit("density");
  if (/^temperature/.test(name)) return unit("temperature");
  return "";
}

const energyColumns = ["kinetic", "internal", "hourglass", "viscous", "deleted", "contact", "friction", "external",
  "total"];

function unitOfColumn(name) {
  if (energyColumns.includes(name)) return unit("energy");
  if (name === "time" || name === "dt") return unit("time");
  if (/velocity_[xyz]$/.test(name)) return unit("velocity");
  if (/(displacement|centre)_[xyz]$/.test(name) || /^spring\..*\.elongation$/.test(name)) return unit("length");
  if (/impulse_[xyz]$/.test(name)) return unit("impulse");
  if (/^section\..*_m[xyz]$/.test(name)) return unit("moment");
  if (/^(reaction|contact|section)\./.test(name) || /^spring\..*\.force$/.test(name)) return unit("force");
  return "";
}

// A number as people write it, to some digits.
function written(value, digits = 4) {
  if (!Number.isFinite(value)) return "\u2013";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) {
    const [factor, power] = value.toExponential(digits - 1).split("e");
    return `${String(Number(factor))}e${Number(power)}`;
  }
  return String(Number(value.toPrecision(digits)));
}
const words = (name) => name.replaceAll("_", " ");

// An element of the page; texts of a result never become markup.
function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name in made && name !== "list") made[name] = value;
    else made.setAttribute(name, value);
  }
  made.append(...children);
  return made;
}

// Colour maps by some of their colours, between which they are linear.
const colourMaps = {
  viridis: "440154 482878 3e4989 31688e 26828e 1f9e89 35b779 6ece58 b5de2b fde725",
  turbo: "4a58c4 4675ed 39a2fc 1bcfd4 24eca6 61fc6c a4fc3b d1e834 f3c63a fe9b2d f36315 d93806 a81501",
  plasma: "0d0887 46039f 7201a8 9c179e bd3786 d8576b ed7953 fb9f3a fdca26 f0f921",
  "cool to warm": "3b4cc0 5977e3 7b9ff9 9ebeff c0d4f5 dddcdc f2cbb7 f7ac8e ee8468 d65244 b40426",
  grey: "2b2b2b f4f4f4",
};

const partPalette = ["7d9fc4", "dba765", "86b591", "c98079", "a391c2", "bdb76f", "84b8c4", "c095b0", "9aa3ad", "a98f76"];

const rgb = (text) => [0, 2, 4].map((i) => parseInt(text.slice(i, i + 2), 16));
const css = (colour) => `rgb(${colour.map(Math.round).join(" ")})`;
const partColour = (part) => rgb(partPalette[part % partPalette.length]);

// At a fraction of the range.
function mapColour(name, fraction) {
  const colours = colourMaps[name].split(" ");
  const place = Math.min(Math.max(fraction, 0), 1) * (colours.length - 1);
  const before = Math.min(Math.floor(place), colours.length - 2);
  const a = rgb(colours[before]), b = rgb(colours[before + 1]);
  return a.map((value, i) => value + (b[i] - value) * (place - before));
}

// 256 colours for the graphics processor.
function mapTexels(name) {
  const texels = new Uint8Array(1024);
  for (let i = 0; i < 256; ++i) texels.set([...mapColour(name, i / 255).map(Math.round), 255], 4 * i);
  return texels;
}

function mapGradient(name) {
  const stops = [];
  for (let i = 0; i <= 20; ++i) stops.push(`${css(mapColour(name, i / 20))} ${5 * i}%`);
  return `linear-gradient(to top, ${stops.join(", ")})`;
}

// A range that is good to read, from one that was found: steps of 1, 2 or 5.
function roundStep(extent, steps) {
  const raw = extent / steps;
  const power = 10 ** Math.floor(Math.log10(raw));
  const factor = raw / power;
  return power * (factor <= 1.0001 ? 1 : factor <= 2.0001 ? 2 : factor <= 5.0001 ? 5 : 10);
}

// Range of a field without the rarest values at its ends, which would leave no colour to the others.
// Of one frame, or of all; of cells in parts that are not hidden.
function usualRange(field, hidden, frame = -1) {
  const rows = field.codes.length / frameCount;
  const codes = frame < 0 ? field.codes : field.codes.subarray(frame * rows, (frame + 1) * rows);
  const counts = new Uint32Array(65536), isSeen = scene.parts.map((_, part) => !hidden.has(part));
  let all = 0;
  for (let i = 0; i < codes.length; ++i) {
    if (codes[i] === noValue || !field.points && !isSeen[cellPart[i % rows]]) continue;
    ++counts[codes[i]];
    ++all;
  }
  if (all === 0) return [0, 1];
  let low = 0, high = quantizedSteps;
  for (let sum = counts[low]; sum < all * 0.001; sum += counts[++low]);
  for (let sum = counts[high]; sum < all * 0.001; sum += counts[--high]);
  const value = (code) => field.min + (field.max - field.min) * code / quantizedSteps;
  let [min, max] = [value(low), value(high)];
  if (min > 0 && min < 0.3 * max) min = 0;
  if (!(max > min)) return [min, min + (Math.abs(min) || 1)];
  const step = roundStep(max - min, 10);
  return [Math.floor(min / step + 1e-6) * step, Math.ceil(max / step - 1e-6) * step];
}

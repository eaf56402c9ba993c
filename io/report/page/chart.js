// Curves of the history over time, to zoom.
const curveColours = ["2f6fb2", "d1732b", "3d8f57", "b8433f", "7a5fae", "8a6a4f", "c667a5", "5f6b78", "a3a01f", "2fa3b3"];
const margin = { left: 66, right: 20, top: 20, bottom: 40 };

// A power of a thousand by which numbers between two are written shorter; 0 where they are short.
function commonPower(from, to) {
  const size = Math.max(Math.abs(from), Math.abs(to));
  return size >= 1e4 || size < 0.1 ? 3 * Math.floor(Math.log10(size || 1) / 3) : 0;
}
const raised = (power) => [...String(power)].map((c) => c === "-" ? "\u207b" : "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079"[c]).join("");

class Chart {
  constructor(onTime) {
    this.box = document.getElementById("chart");
    this.canvas = document.getElementById("curves");
    this.times = historyColumn("time");
    this.columns = [];
    this.now = 0;
    this.onTime = onTime;
    this.zoomOut();
    this.listen();
    new ResizeObserver(() => this.draw()).observe(this.box);
  }

  zoomOut() {
    const n = this.times.length;
    this.from = n > 0 ? this.times[0] : 0;
    this.to = n > 1 && this.times[n - 1] > this.from ? this.times[n - 1] : this.from + 1;
    this.draw();
  }

  show(columns) {
    this.columns = columns.map((name) => ({ name, values: historyColumn(name) }));
    this.draw();
  }

  // Of the values between the ends of the plot.
  span() {
    let [min, max] = [Infinity, -Infinity];
    for (const { values } of this.columns) {
      for (let i = 0; i < values.length; ++i) {
        if (this.times[i] < this.from || this.times[i] > this.to || !Number.isFinite(values[i])) continue;
        min = Math.min(min, values[i]);
        max = Math.max(max, values[i]);
      }
    }
    if (!(max >= min)) return [0, 1];
    if (min === max) return [min - (Math.abs(min) || 1) * 0.5, max + (Math.abs(max) || 1) * 0.5];
    return [min - 0.04 * (max - min), max + 0.04 * (max - min)];
  }

  // Names stand beside the curves where there is room.
  beside() { return this.box.clientWidth > 640 ? 215 : 0; }
  width() { return Math.max(10, this.box.clientWidth - margin.left - margin.right - this.beside()); }
  height() { return Math.max(10, this.box.clientHeight - margin.top - margin.bottom); }
  x(time) { return margin.left + this.width() * (time - this.from) / (this.to - this.from); }
  y(value) { return margin.top + this.height() * (this.top - value) / (this.top - this.bottom); }
  timeAt(x) { return this.from + (this.to - this.from) * Math.min(1, Math.max(0, (x - margin.left) / this.width())); }

  draw() {
    const density = window.devicePixelRatio || 1, pen = this.canvas.getContext("2d");
    this.canvas.width = Math.max(1, Math.round(this.box.clientWidth * density));
    this.canvas.height = Math.max(1, Math.round(this.box.clientHeight * density));
    pen.setTransform(density, 0, 0, density, 0, 0);
    [this.bottom, this.top] = this.span();
    this.style = getComputedStyle(document.documentElement);
    pen.font = "12px system-ui, sans-serif";
    this.drawGrid(pen);
    this.drawCurves(pen);
    this.drawCursor(pen);
    this.drawNames(pen);
  }

  drawGrid(pen) {
    const line = this.style.getPropertyValue("--line"), dim = this.style.getPropertyValue("--dim");
    pen.lineWidth = 1;
    const ticks = (from, to, count) => {
      const step = roundStep(to - from, count), found = [];
      for (let i = Math.ceil(from / step - 1e-9); i * step <= to + 1e-9 * step && found.length < 50; ++i) found.push(i * step);
      return found;
    };
    const stroke = (x0, y0, x1, y1) => {
      pen.strokeStyle = line;
      pen.beginPath();
      pen.moveTo(x0, y0);
      pen.lineTo(x1, y1);
      pen.stroke();
    };
    pen.fillStyle = dim;
    pen.textAlign = "center";
    pen.textBaseline = "top";
    const timePower = commonPower(this.from, this.to), power = commonPower(this.bottom, this.top);
    for (const t of ticks(this.from, this.to, this.width() / 85)) {
      stroke(this.x(t), margin.top, this.x(t), margin.top + this.height());
      pen.fillText(written(t / 10 ** timePower, 6), this.x(t), margin.top + this.height() + 6);
    }
    pen.textAlign = "right";
    pen.textBaseline = "middle";
    for (const v of ticks(this.bottom, this.top, this.height() / 45)) {
      stroke(margin.left, this.y(v), margin.left + this.width(), this.y(v));
      pen.fillText(written(v / 10 ** power, 6), margin.left - 7, this.y(v));
    }
    pen.textAlign = "center";
    const label = (name, unitText, tens) =>
      [name, [tens ? `10${raised(tens)}` : "", unitText].filter(Boolean).join(" ")].filter(Boolean).join(" / ");
    pen.fillText(label("time", unit("time"), timePower), margin.left + this.width() / 2, this.box.clientHeight - 9);
    const units = [...new Set(this.columns.map(({ name }) => unitOfColumn(name)))];
    const areEnergies = this.columns.every(({ name }) => energyColumns.includes(name));
    const name = this.columns.length === 1 ? words(this.columns[0].name) : areEnergies ? "energy" : "";
    pen.save();
    pen.translate(9, margin.top + this.height() / 2);
    pen.rotate(-Math.PI / 2);
    pen.fillText(label(name, units.length === 1 ? units[0] : "", power), 0, 0);
    pen.restore();
  }

  drawCurves(pen) {
    pen.save();
    pen.beginPath();
    pen.rect(margin.left, margin.top, this.width(), this.height());
    pen.clip();
    pen.lineWidth = 1.6;
    pen.lineJoin = "round";
    this.columns.forEach(({ values }, c) => {
      pen.strokeStyle = `#${curveColours[c % curveColours.length]}`;
      pen.beginPath();
      for (let i = 0; i < values.length; ++i) pen.lineTo(this.x(this.times[i]), this.y(values[i]));
      pen.stroke();
    });
    pen.restore();
  }

  drawCursor(pen) {
    if (this.now >= this.from && this.now <= this.to) {
      pen.strokeStyle = this.style.getPropertyValue("--accent");
      pen.setLineDash([4, 3]);
      pen.beginPath();
      pen.moveTo(this.x(this.now), margin.top);
      pen.lineTo(this.x(this.now), margin.top + this.height());
      pen.stroke();
      pen.setLineDash([]);
    }
    if (this.drag && Math.abs(this.drag[1] - this.drag[0]) > 3) {
      pen.fillStyle = "rgb(47 111 178 / 0.15)";
      pen.fillRect(this.drag[0], margin.top, this.drag[1] - this.drag[0], this.height());
    }
  }

  rowAt(time) {
    let low = 0, high = this.times.length - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.times[middle] < time) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  // With the values at the pointer, or at the time of the scene.
  drawNames(pen) {
    const row = this.rowAt(this.pointer ?? this.now), card = this.style.getPropertyValue("--card");
    const lines = this.columns.map(({ name, values }) => `${words(name)}  ${written(values[row], 5)}`);
    const wide = Math.max(0, ...lines.map((text) => pen.measureText(text).width));
    const x = this.beside() > 0 ? margin.left + this.width() + 12 : margin.left + this.width() - wide - 34;
    if (lines.length === 0) return;
    pen.globalAlpha = 0.85;
    pen.fillStyle = card;
    pen.fillRect(x, margin.top + 5, wide + 29, 17 * lines.length + 8);
    pen.globalAlpha = 1;
    pen.textAlign = "left";
    lines.forEach((text, c) => {
      const y = margin.top + 18 + 17 * c;
      pen.fillStyle = `#${curveColours[c % curveColours.length]}`;
      pen.fillRect(x + 6, y - 1.5, 13, 3);
      pen.fillStyle = this.style.getPropertyValue("--text");
      pen.fillText(text, x + 24, y);
    });
  }

  listen() {
    const place = (event) => event.clientX - this.canvas.getBoundingClientRect().left;
    this.canvas.addEventListener("pointerdown", (event) => {
      this.canvas.setPointerCapture(event.pointerId);
      this.drag = [place(event), place(event)];
    });
    this.canvas.addEventListener("pointermove", (event) => {
      this.pointer = this.timeAt(place(event));
      if (this.drag) this.drag[1] = place(event);
      this.draw();
    });
    this.canvas.addEventListener("pointerleave", () => {
      this.pointer = undefined;
      this.draw();
    });
    this.canvas.addEventListener("pointerup", () => {
      const drag = this.drag;
      this.drag = null;
      if (!drag) return;
      const [a, b] = drag.map((x) => this.timeAt(x)).sort((p, q) => p - q);
      if (Math.abs(drag[1] - drag[0]) > 8 && b > a) [this.from, this.to] = [a, b];
      else this.onTime(a);
      this.draw();
    });
    this.canvas.addEventListener("dblclick", () => this.zoomOut());
    this.canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      const at = this.timeAt(place(event)), factor = Math.exp(Math.max(-0.5, Math.min(0.5, event.deltaY * 0.0015)));
      const n = this.times.length - 1;
      if (n < 1) return;
      this.from = Math.max(this.times[0], at + (this.from - at) * factor);
      this.to = Math.min(this.times[n], at + (this.to - at) * factor);
      this.draw();
    }, { passive: false });
  }
}

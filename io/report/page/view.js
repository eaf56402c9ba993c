// The scene on the page: what the user has chosen, the camera in his hands, the legend.
class View {
  constructor() {
    this.box = document.getElementById("view");
    this.canvas = document.getElementById("canvas");
    this.state = new Scene();
    this.painter = new Painter(this.canvas);
    this.camera = new Camera(boxOfFrame(0));
    this.whole = Math.hypot(...subtract(scene.box.max, scene.box.min)) || 1;
    this.time = 0;
    this.chosen = {
      field: scene.fields.find((field) => field.name === "equivalent_plastic_strain") || scene.fields[0] || null,
      map: "turbo", range: [0, 1], smooth: true, meshLines: true, featureLines: true, cutAxis: -1, cutPlace: 0.5, cutSide: 1,
    };
    this.wanted = false;
    this.stale = true;
    this.isPlaced = false;  // whether the user, or the address, has placed the camera
    this.listen();
    new ResizeObserver(() => this.resize()).observe(this.box);
  }

  resize() {
    const density = Math.min(window.devicePixelRatio || 1, 2);
    for (const canvas of [this.canvas, document.getElementById("overlay")]) {
      canvas.width = Math.max(1, Math.round(this.box.clientWidth * density));
      canvas.height = Math.max(1, Math.round(this.box.clientHeight * density));
    }
    if (!this.isPlaced) this.camera.fit(this.canvas.width / this.canvas.height);
    this.redraw();
  }

  // Draws before the next picture of the browser. \param isStale whether the scene differs, not the camera alone
  redraw(isStale = false) {
    this.stale ||= isStale;
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame(() => {
      this.wanted = false;
      this.draw();
    });
  }

  draw() {
    const { field, smooth } = this.chosen;
    if (this.stale) {
      this.state.update(this.time, this.chosen);
      this.painter.take(this.state);
      this.stale = false;
    }
    const aspect = this.canvas.width / this.canvas.height;
    const reach = this.whole + Math.hypot(...subtract(this.camera.target, boxCentre()));
    this.painter.draw({
      view: this.camera.view(), projection: this.camera.projection(aspect, reach),
      colouring: !field ? 0 : field.points ? 2 : 1, smooth, range: this.chosen.range, cut: this.cut(),
      meshLines: this.chosen.meshLines, featureLines: this.chosen.featureLines, leastRadius: this.whole * 2e-4,
    });
    this.drawAxes();
  }

  cut() {
    const { cutAxis: axis, cutPlace, cutSide } = this.chosen;
    if (axis < 0) return [0, 0, 0, 1];
    const cut = [0, 0, 0, cutSide * (this.camera.home.min[axis] * (1 - cutPlace) + this.camera.home.max[axis] * cutPlace)];
    cut[axis] = cutSide;
    return cut;
  }

  drawAxes() {
    const overlay = document.getElementById("overlay"), pen = overlay.getContext("2d");
    const density = overlay.width / Math.max(1, this.box.clientWidth);
    pen.setTransform(density, 0, 0, density, 0, 0);
    pen.clearRect(0, 0, overlay.width, overlay.height);
    const { right, up, towards } = this.camera.axes(), x = 52, y = this.box.clientHeight - 46;
    pen.font = "600 12px system-ui, sans-serif";
    pen.textAlign = "center";
    pen.textBaseline = "middle";
    pen.lineWidth = 2;
    for (const axis of [0, 1, 2].sort((a, b) => towards[a] - towards[b])) {
      pen.strokeStyle = pen.fillStyle = ["#c8443c", "#3f9148", "#3a6fc0"][axis];
      pen.beginPath();
      pen.moveTo(x, y);
      pen.lineTo(x + 28 * right[axis], y - 28 * up[axis]);
      pen.stroke();
      pen.fillText("xyz"[axis], x + 38 * right[axis], y - 38 * up[axis]);
    }
  }

  listen() {
    const held = new Map(), box = this.canvas;
    let spread = 0;
    box.addEventListener("contextmenu", (event) => event.preventDefault());
    box.addEventListener("pointerdown", (event) => {
      box.setPointerCapture(event.pointerId);
      held.set(event.pointerId, [event.clientX, event.clientY]);
      spread = 0;
    });
    for (const end of ["pointerup", "pointercancel"]) box.addEventListener(end, (event) => {
      held.delete(event.pointerId);
      spread = 0;
      this.moved?.();
    });
    box.addEventListener("pointermove", (event) => {
      if (!held.has(event.pointerId)) return;
      const [x, y] = held.get(event.pointerId), dx = event.clientX - x, dy = event.clientY - y;
      held.set(event.pointerId, [event.clientX, event.clientY]);
      const height = this.box.clientHeight;
      if (held.size > 1) {  // two fingers move and zoom
        const [a, b] = [...held.values()], now = Math.hypot(a[0] - b[0], a[1] - b[1]);
        if (spread > 0) this.camera.zoom(spread / Math.max(now, 1));
        spread = now;
        this.camera.move(dx / 2, dy / 2, height);
      } else if (event.shiftKey || event.buttons & 6) {
        this.camera.move(dx, dy, height);
      } else {
        this.camera.turn(dx, dy);
      }
      this.redraw();
    });
    box.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.camera.zoom(Math.exp(Math.max(-0.4, Math.min(0.4, event.deltaY * 0.0012))));
      this.moved?.();
      this.redraw();
    }, { passive: false });
    box.addEventListener("dblclick", () => this.fit());
  }

  fit() {
    this.camera.fit(this.canvas.width / this.canvas.height);
    this.moved?.();
    this.redraw();
  }

  showLegend() {
    const legend = document.getElementById("legend"), { field, map, range } = this.chosen;
    legend.replaceChildren();
    if (!field) {
      scene.parts.forEach((part, i) => {
        if (i < 12 && !this.state.hidden.has(i)) legend.append(element("div", { className: "part" },
          element("span", { className: "swatch", style: `background:${css(partColour(i))}` }), part.name));
      });
      return;
    }
    const bar = element("div", { className: "bar" }), ticks = element("div", { className: "ticks" });
    bar.style.background = mapGradient(map);
    for (let i = 5; i >= 0; --i) ticks.append(element("span", {}, written(range[0] + (range[1] - range[0]) * i / 5, 3)));
    const name = element("div", { className: "name" }, words(field.name));
    if (unitOfField(field.name)) name.append(element("span", {}, unitOfField(field.name)));
    legend.append(name, element("div", { className: "scale" }, bar, ticks));
  }
}

function boxOfFrame(frame) {
  const min = [Infinity, Infinity, Infinity], max = [-Infinity, -Infinity, -Infinity], first = 3 * scene.nodes * frame;
  for (let i = 0; i < 3 * scene.nodes; ++i) {
    const axis = i % 3;
    const value = scene.box.min[axis] + (scene.box.max[axis] - scene.box.min[axis]) * positions[first + i] / quantizedSteps;
    if (value < min[axis]) min[axis] = value;
    if (value > max[axis]) max[axis] = value;
  }
  return scene.nodes > 0 ? { min, max } : { min: [0, 0, 0], max: [1, 1, 1] };
}
const boxCentre = () => [0, 1, 2].map((i) => 0.5 * (scene.box.min[i] + scene.box.max[i]));

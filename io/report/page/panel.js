// Controls beside the scene, and the cards below it.
const check = (text, checked, onChange, ...more) => element("label", {},
  element("input", { type: "checkbox", checked, onchange: (event) => onChange(event.target.checked) }), text, ...more);
const group = (title, ...children) => element("fieldset", {}, element("legend", {}, title), ...children);
const choice = (id, names, chosen, onChange) => {
  const made = element("select", { id, onchange: (event) => onChange(event.target.value) });
  for (const [value, text] of names) made.append(element("option", { value, selected: value === chosen }, text));
  return made;
};

class Controls {
  constructor(view, changed) {
    this.view = view;
    this.changed = changed;
    this.box = document.getElementById("controls");
    this.box.append(this.colours(), this.parts(), this.looks(), this.cutting());
    this.useField(view.chosen.field);
  }

  set(values, isStale = true) {
    Object.assign(this.view.chosen, values);
    this.view.showLegend();
    this.view.redraw(isStale);
    this.changed();
  }

  colours() {
    const { chosen } = this.view;
    const fields = [["", "part"], ...scene.fields.map((field) => [field.name, words(field.name)])];
    this.fieldChoice = choice("field", fields, chosen.field?.name || "", (name) =>
      this.useField(scene.fields.find((field) => field.name === name) || null));
    this.mapChoice = choice("map", Object.keys(colourMaps).map((name) => [name, name]), chosen.map, (map) => {
      this.view.painter.putMap(map);
      this.set({ map }, false);
    });
    this.view.painter.putMap(chosen.map);
    const limit = (id) => element("input", { type: "text", id, inputMode: "decimal", onchange: () => this.readRange() });
    [this.low, this.high] = [limit("range-min"), limit("range-max")];
    const take = (title, hint, frame) => element("button", { title: hint, onclick: () => {
      const field = this.view.chosen.field;
      if (field) this.useRange(usualRange(field, this.view.state.hidden, frame()));
    } }, title);
    return group("Colour", this.fieldChoice, this.mapChoice,
      element("div", { className: "pair" }, this.low, "to", this.high),
      element("div", { className: "pair" }, take("all times", "Range of the whole result, in parts that are shown", () => -1),
        take("this time", "Range at the time shown, in parts that are shown", () => Math.round(this.view.time))));
  }

  useField(field) {
    this.view.chosen.field = field;
    this.fieldChoice.value = field?.name || "";
    this.useRange(field ? usualRange(field, this.view.state.hidden) : [0, 1]);
  }

  useRange(range) {
    for (const [i, input] of [this.low, this.high].entries()) {
      input.value = this.view.chosen.field ? written(range[i], 6) : "";
      input.disabled = !this.view.chosen.field;
    }
    this.set({ range });
  }

  readRange() {
    const range = [Number(this.low.value), Number(this.high.value)];
    this.useRange(range.every(Number.isFinite) && range[1] > range[0] ? range : this.view.chosen.range);
  }

  parts() {
    const counts = new Array(scene.parts.length).fill(0);
    for (const part of cellPart) ++counts[part];
    const list = element("div", { id: "parts" });
    this.partBoxes = scene.parts.map((part, i) => {
      const label = check(part.name, true, (isOn) => this.showPart(i, isOn),
        element("span", { className: "count" }, counts[i].toLocaleString("en")));
      label.title = `${part.name}: ${counts[i]} elements seen at some time`;
      label.firstChild.after(element("span", { className: "swatch", style: `background:${css(partColour(i))}` }));
      label.firstChild.dataset.part = part.name;
      list.append(label);
      return label.firstChild;
    });
    const all = element("div", { className: "pair" });
    if (scene.parts.length > 4) for (const [text, isOn] of [["all", true], ["none", false]])
      all.append(element("button", { onclick: () => scene.parts.forEach((_, i) => this.showPart(i, isOn)) }, text));
    return group("Parts", all, list);
  }

  showPart(part, isOn) {
    if (isOn) this.view.state.hidden.delete(part);
    else this.view.state.hidden.add(part);
    this.partBoxes[part].checked = isOn;
    this.set({});
  }

  looks() {
    const { chosen, state } = this.view;
    const made = group("View", check("smooth colours", chosen.smooth, (smooth) => this.set({ smooth })),
      check("mesh lines", chosen.meshLines, (meshLines) => this.set({ meshLines }, false)),
      check("edges", chosen.featureLines, (featureLines) => this.set({ featureLines }, false)));
    if (facetKind.includes(shellFacet))
      made.append(check("thickness of shells", state.thick, (thick) => { state.thick = thick; this.set({}); }));
    made.append(check("dark", false, (isDark) => {
      document.documentElement.classList.toggle("dark", isDark);
      this.changed();
    }));
    return made;
  }

  // What is cut off lies between the eye and the rest.
  cutAcross(axis) {
    this.set({ cutAxis: axis, cutSide: axis >= 0 && this.view.camera.axes().towards[axis] < 0 ? -1 : 1 }, false);
  }

  cutting() {
    const place = element("input", { type: "range", id: "cut-place", min: 0, max: 1, step: 0.005, value: 0.5,
      style: "width:100%", ariaLabel: "Place of the cut",
      oninput: (event) => this.set({ cutPlace: Number(event.target.value) }, false) });
    const axes = [["-1", "none"], ["0", "across x"], ["1", "across y"], ["2", "across z"]];
    return group("Cut", element("div", { className: "pair" },
      choice("cut-axis", axes, "-1", (axis) => this.cutAcross(Number(axis))),
      element("button", { title: "Keep the other side", onclick: () => this.set({ cutSide: -this.view.chosen.cutSide }, false) },
        "swap")), place);
  }
}

function row(name, ...values) {
  return element("tr", {}, element("td", {}, name), ...values);
}
const numberCell = (text) => element("td", { className: "number" }, text);

// Energies at the end with bars, and how well they add up.
function showEnergy() {
  const card = document.getElementById("energy"), table = element("table"), last = head.history.rows - 1;
  const found = energyColumns.map((name) => [name, historyColumn(name)[last]]).filter(([, value]) => value);
  const largest = Math.max(...found.map(([, value]) => Math.abs(value)), 1e-300);
  found.forEach(([name, value], i) => {
    const bar = element("div", { className: "bar" });
    bar.style.cssText = `width:${100 * Math.abs(value) / largest}%;background:#${curveColours[i % curveColours.length]};`
      + (value < 0 ? "opacity:.45" : "");
    table.append(row(name, numberCell(`${written(value, 5)} ${unit("energy")}`), element("td", { style: "width:45%" }, bar)));
  });
  const errors = historyColumn("error_relative");
  if (errors.length > 0) {
    const worst = errors.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
    table.append(row("relative error", numberCell(written(errors[last], 3)),
      element("td", {}, `largest ${written(worst, 3)} in the history`)));
  }
  const ratio = head.summary?.hourglass_ratio_max;
  if (ratio?.part) table.append(row("hourglass ratio", numberCell(written(ratio.value, 3)),
    element("td", {}, `largest, of part ${ratio.part} at ${written(ratio.time)} ${unit("time")}`)));
  card.append(table);
}

function showSummary() {
  const card = document.getElementById("summary"), table = element("table"), summary = head.summary;
  const add = (name, text) => { if (text !== undefined && text !== "") table.append(row(name, element("td", {}, text))); };
  if (!summary) card.append(element("p", {}, "There is no summary: the run goes on, or was killed."));
  const sum = (counts) => Object.entries(counts || {}).filter(([, n]) => n > 0).map(([kind, n]) =>
    `${n.toLocaleString("en")} ${kind}`).join(", ");
  if (summary) {
    add("time", `${written(summary.time, 6)} ${unit("time")} after ${summary.steps?.toLocaleString("en")} steps`);
    add("time step", `${written(summary.dt?.min)} to ${written(summary.dt?.max)} ${unit("time")}`);
    add("nodes", summary.nodes?.toLocaleString("en"));
    add("elements", sum(summary.elements));
    add("deleted", sum(summary.deleted));
    add("contact", summary.contact ? `at most ${summary.contact.active_max?.toLocaleString("en")} active, `
      + `${summary.contact.missed} missed in audits` : "");
    add("wall time", `${written(summary.wall_s?.total, 3)} s on ${summary.threads} thread${summary.threads === 1 ? "" : "s"}, `
      + `${written(summary.peak_memory_mb, 3)} MB at the peak`);
    add("features", (summary.active_features || []).map(words).join(", "));
  }
  add("shown", `${frameCount} of ${scene.dumps} dumps, ${head.history.rows} of ${head.history.rows_in_result} rows of the history`);
  add("deck", head.deck_path);
  add("changed by", head.overrides.join(", "));
  add("program", `brio ${head.version}`);
  card.append(table);
}

function showHead() {
  const { summary } = head, status = document.getElementById("status"), warnings = summary?.warnings || [];
  document.getElementById("title").textContent = head.title || head.deck_path;
  document.getElementById("origin").textContent = `${head.deck_path} \u00b7 brio ${head.version}`;
  status.textContent = summary ? summary.status : "not finished";
  status.className = summary?.status === "finished" ? "good" : "bad";
  if (warnings.length > 0) {
    const box = document.getElementById("warnings");
    box.hidden = false;
    box.append(element("strong", {}, warnings.length === 1 ? "Warning" : `${warnings.length} warnings`),
      element("ul", {}, ...warnings.map((text) => element("li", {}, text))));
  }
  document.querySelector("#deck pre").textContent = head.deck_text;
}

// Which columns are drawn; those of the energy balance that are not zero at first.
function chooseColumns(chart, wanted) {
  const box = document.getElementById("columns"), list = element("div", { className: "list" });
  const names = head.history.columns.filter((name) => name !== "time");
  const isZero = (name) => historyColumn(name).every((value) => value === 0);
  const shown = new Set(wanted.length > 0 ? wanted : energyColumns.filter((name) => names.includes(name) && !isZero(name)));
  const update = () => chart.show(names.filter((name) => shown.has(name)));
  const labels = names.map((name) => {
    const label = check(words(name), shown.has(name), (isOn) => {
      if (isOn) shown.add(name);
      else shown.delete(name);
      update();
    });
    label.dataset.column = name;
    if (isZero(name)) label.style.opacity = 0.5;
    return label;
  });
  list.append(...labels);
  box.append(element("input", { type: "text", placeholder: "find a column", oninput: (event) => {
    const sought = event.target.value.toLowerCase();
    for (const label of labels) label.hidden = !words(label.dataset.column).toLowerCase().includes(sought);
    for (const label of labels) label.style.display = label.hidden ? "none" : "";
  } }), list, element("button", { onclick: () => {
    shown.clear();
    for (const label of labels) label.firstChild.checked = false;
    update();
  } }, "none"));
  update();
}

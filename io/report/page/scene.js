// The scene at a time: places of nodes, normals, values, what is seen; as tables for the graphics processor.
const nothing = -3e38;  // in place of a value where there is none
const featureCosine = Math.cos(32 * Math.PI / 180);

class Scene {
  constructor() {
    this.node = new Float32Array(4 * scene.nodes);      // x y z, half of the thickness
    this.normal = new Float32Array(4 * scene.nodes);    // normal, value
    this.facet = new Float32Array(4 * scene.facets);    // value, edges that are features, size, part
    this.flat = new Float32Array(3 * scene.facets);     // normals of facets
    this.across = new Int32Array(4 * scene.facets);     // facets beyond edges, of what is seen
    this.shares = new Float32Array(scene.nodes);
    this.hidden = new Set();
    this.thick = true;
    this.structure = "";
    for (let f = 0; f < scene.facets; ++f) {
      const cell = facetTable[5 * f + 4];
      this.facet[4 * f + 2] = this.sizeOf(f, cell);
      this.facet[4 * f + 3] = cellPart[cell];
    }
    this.findNeighbours();
    this.findChanges();
    this.largest = new Map();
  }

  // Radius of beams as the deck has their section, where the result has none.
  sizeOf(f, cell) {
    const section = scene.parts[cellPart[cell]].section;
    if (cellSize[cell] > 0 || facetKind[f] !== lineFacet || !section) return cellSize[cell];
    return section.radius || section.outer_radius || 0.5 * Math.hypot(section.width || 0, section.height || 0);
  }

  isFace(f) { return facetKind[f] <= shellFacet; }
  nodeOf(f, corner) { return facetTable[5 * f + corner]; }

  // Facets that share an edge stand beside each other in `edgeOrder`; `edgeFirst` says where.
  findNeighbours() {
    const keys = new Float64Array(4 * scene.facets), order = [];
    for (let f = 0; f < scene.facets; ++f) {
      for (let e = 0; e < 4 && this.isFace(f); ++e) {
        const a = this.nodeOf(f, e), b = this.nodeOf(f, (e + 1) % 4);
        if (a === b) continue;
        keys[4 * f + e] = 1 + Math.min(a, b) * scene.nodes + Math.max(a, b);
        order.push(4 * f + e);
      }
    }
    this.edgeOrder = Uint32Array.from(order).sort((a, b) => keys[a] - keys[b]);
    this.edgeFirst = new Int32Array(4 * scene.facets).fill(-1);
    this.edgeKeys = keys;
    for (let i = 0, first = 0; i < this.edgeOrder.length; ++i) {
      if (keys[this.edgeOrder[i]] !== keys[this.edgeOrder[first]]) first = i;
      this.edgeFirst[this.edgeOrder[i]] = first;
    }
  }

  // Frames in which what is seen differs from the frame before.
  findChanges() {
    const changes = new Uint8Array(frameCount + 1);
    for (const frame of facetLife) changes[frame] = 1;
    this.generation = new Uint32Array(frameCount);
    for (let k = 1; k < frameCount; ++k) this.generation[k] = this.generation[k - 1] + changes[k];
  }

  isAlive(f) { return facetLife[2 * f] <= this.frame && this.frame < facetLife[2 * f + 1]; }

  // \param time in frames; between two of them everything is between
  update(time, { field, range, smooth }) {
    this.frame = Math.min(Math.floor(time), frameCount - 1);
    this.next = Math.min(this.frame + 1, frameCount - 1);
    this.weight = time - this.frame;
    this.place();
    const structure = `${this.generation[this.frame]} ${[...this.hidden]} ${this.thick}`;
    this.isNew = structure !== this.structure;
    this.structure = structure;
    if (this.isNew) this.listAlive();
    this.findNormals();
    this.findFeatures();
    if (this.isNew) this.listInstances();
    this.findValues(field, range, smooth);
  }

  place() {
    const a = 3 * scene.nodes * this.frame, b = 3 * scene.nodes * this.next, w = this.weight;
    const { min, max } = scene.box;
    for (let axis = 0; axis < 3; ++axis) {
      const scale = (max[axis] - min[axis]) / quantizedSteps;
      for (let n = 0, i = axis; n < scene.nodes; ++n, i += 3)
        this.node[4 * n + axis] = min[axis] + scale * (positions[a + i] * (1 - w) + positions[b + i] * w);
    }
  }

  listAlive() {
    const alive = [];
    for (let f = 0; f < scene.facets; ++f)
      if (this.isAlive(f) && !this.hidden.has(this.facet[4 * f + 3])) alive.push(f);
    this.alive = Uint32Array.from(alive);
    this.faces = this.alive.filter((f) => this.isFace(f));
    this.isSeen = new Uint8Array(scene.facets);
    for (const f of alive) this.isSeen[f] = 1;
    for (const f of this.faces) for (let e = 0; e < 4; ++e) this.across[4 * f + e] = this.findAcross(f, e);
    this.findThickness();
  }

  findThickness() {
    this.shares.fill(0);
    for (let n = 0; n < scene.nodes; ++n) this.node[4 * n + 3] = 0;
    for (const f of this.faces) {
      if (facetKind[f] !== shellFacet) continue;
      for (let c = 0; c < 4; ++c) {
        this.node[4 * this.nodeOf(f, c) + 3] += 0.5 * this.facet[4 * f + 2];
        ++this.shares[this.nodeOf(f, c)];
      }
    }
    for (let n = 0; n < scene.nodes; ++n) if (this.shares[n] > 0) this.node[4 * n + 3] /= this.shares[n];
  }

  findNormals() {
    const p = this.node, m = this.normal;
    for (let n = 0; n < scene.nodes; ++n) m[4 * n] = m[4 * n + 1] = m[4 * n + 2] = 0;
    for (const f of this.faces) {
      const a = 4 * facetTable[5 * f], b = 4 * facetTable[5 * f + 1], c = 4 * facetTable[5 * f + 2];
      const d = 4 * facetTable[5 * f + 3];
      const ux = p[c] - p[a], uy = p[c + 1] - p[a + 1], uz = p[c + 2] - p[a + 2];
      const vx = p[d] - p[b], vy = p[d + 1] - p[b + 1], vz = p[d + 2] - p[b + 2];
      const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
      const size = Math.sqrt(x * x + y * y + z * z) || 1;
      this.flat[3 * f] = x / size;
      this.flat[3 * f + 1] = y / size;
      this.flat[3 * f + 2] = z / size;
      m[a] += x; m[a + 1] += y; m[a + 2] += z;
      m[b] += x; m[b + 1] += y; m[b + 2] += z;
      m[c] += x; m[c + 1] += y; m[c + 2] += z;
      m[d] += x; m[d + 1] += y; m[d + 2] += z;
    }
    for (let i = 0; i < m.length; i += 4) {
      const size = Math.sqrt(m[i] * m[i] + m[i + 1] * m[i + 1] + m[i + 2] * m[i + 2]) || 1;
      m[i] /= size; m[i + 1] /= size; m[i + 2] /= size;
    }
  }

  // The other facet of the same part at an edge; -1 without one, -2 where there are several, -3 of no edge.
  findAcross(f, e) {
    const first = this.edgeFirst[4 * f + e];
    if (first < 0) return -3;
    const key = this.edgeKeys[4 * f + e];
    let found = -1;
    for (let i = first; i < this.edgeOrder.length && this.edgeKeys[this.edgeOrder[i]] === key; ++i) {
      const other = this.edgeOrder[i] >> 2;
      if (other === f || !this.isSeen[other] || this.facet[4 * other + 3] !== this.facet[4 * f + 3]) continue;
      found = found === -1 ? other : -2;
    }
    return found;
  }

  // Edges at which the surface ends or is bent.
  findFeatures() {
    const m = this.flat;
    for (const f of this.faces) {
      let mask = 0;
      for (let e = 0; e < 4; ++e) {
        const o = this.across[4 * f + e];
        if (o === -3) continue;
        const cosine = o < 0 ? -1 : m[3 * f] * m[3 * o] + m[3 * f + 1] * m[3 * o + 1] + m[3 * f + 2] * m[3 * o + 2];
        // Shells may lie beside each other with normals that point to different sides.
        if ((facetKind[f] === shellFacet && o >= 0 ? Math.abs(cosine) : cosine) < featureCosine) mask |= 1 << e;
      }
      this.facet[4 * f + 1] = mask;
    }
  }

  // What is drawn: of faces pairs of facet and form (0 as it is, 1 and 2 the sides of a shell, 3 to 6 its
  // edges), of spheres of facet and node, of beams facets by part.
  listInstances() {
    const quads = [], spheres = [], lines = new Map();
    for (const f of this.alive) {
      const kind = facetKind[f], part = this.facet[4 * f + 3];
      if (kind === vertexFacet) {
        spheres.push(f, 0);
      } else if (kind === lineFacet) {
        if (!lines.has(part)) lines.set(part, []);
        lines.get(part).push(f);
        if (isRound(part)) spheres.push(f, 0, f, 1);  // joints of bent beams
      } else if (kind === solidFacet || !this.thick || !(this.facet[4 * f + 2] > 0)) {
        quads.push(f, 0);
      } else {
        quads.push(f, 1, f, 2);
        for (let e = 0; e < 4; ++e) if (this.across[4 * f + e] === -1) quads.push(f, 3 + e);
      }
    }
    this.quads = Uint32Array.from(quads);
    this.spheres = Uint32Array.from(spheres);
    this.lines = lines;
  }

  // Largest magnitude of a field of cells in each part, over all times.
  largestOf(field) {
    if (!this.largest.has(field)) {
      const found = new Float64Array(scene.parts.length), scale = (field.max - field.min) / quantizedSteps;
      for (let i = 0; i < field.codes.length; ++i) {
        const part = cellPart[i % scene.cells];
        if (field.codes[i] !== noValue) found[part] = Math.max(found[part], Math.abs(field.min + scale * field.codes[i]));
      }
      this.largest.set(field, found);
    }
    return this.largest.get(field);
  }

  // Parts that never come to a hundredth of what the colours reach to: rigid ones, or those that stay elastic. They
  // are drawn without colours of the map.
  partsWithout(field, range) {
    if (field.points) return new Set();
    const little = 0.01 * Math.max(...range.map(Math.abs)), largest = this.largestOf(field);
    return new Set([...scene.parts.keys()].filter((part) => largest[part] <= little));
  }

  valueOf(field, row) {
    const rows = field.codes.length / frameCount;
    const a = field.codes[rows * this.frame + row], b = field.codes[rows * this.next + row];
    if (a === noValue) return nothing;
    const code = b === noValue ? a : a * (1 - this.weight) + b * this.weight;
    return field.min + (field.max - field.min) * code / quantizedSteps;
  }

  findValues(field, range, smooth) {
    if (!field) return;
    if (field.points) this.findNodeValues(field);
    const without = this.partsWithout(field, range);
    for (const f of this.alive) {
      let value = nothing;
      if (field.points) {
        value = 0;
        for (let c = 0; c < 4; ++c) value += 0.25 * this.normal[4 * facetTable[5 * f + c] + 3];
      } else if (!without.has(this.facet[4 * f + 3])) {
        value = this.valueOf(field, facetTable[5 * f + 4]);
      }
      this.facet[4 * f] = value;
    }
    if (!field.points && smooth) this.averageOnNodes();
  }

  findNodeValues(field) {
    for (let n = 0; n < scene.nodes; ++n) this.normal[4 * n + 3] = this.valueOf(field, n);
  }

  averageOnNodes() {
    const m = this.normal;
    this.shares.fill(0);
    for (let n = 0; n < scene.nodes; ++n) m[4 * n + 3] = 0;
    for (const f of this.faces) {
      const value = this.facet[4 * f];
      if (value <= nothing) continue;
      for (let c = 0; c < 4; ++c) {
        const n = this.nodeOf(f, c);
        m[4 * n + 3] += value;
        ++this.shares[n];
      }
    }
    for (let n = 0; n < scene.nodes; ++n) m[4 * n + 3] = this.shares[n] > 0 ? m[4 * n + 3] / this.shares[n] : nothing;
  }
}

function isRound(part) {
  const section = scene.parts[part].section;
  return !section || section.kind === "circle" || section.kind === "tube";
}

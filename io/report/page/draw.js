// Draws the scene (WebGL 2).
const texelsAcross = 2048;

class Painter {
  constructor(canvas) {
    this.canvas = canvas;
    const gl = this.gl = canvas.getContext("webgl2", { antialias: true, alpha: true });
    if (!gl) throw new Error("This browser shows no WebGL 2: the scene cannot be drawn.");
    this.faces = this.program(faceVertexShader, faceFragmentShader);
    this.beams = this.program(beamVertexShader, faceFragmentShader);
    this.spheres = this.program(sphereVertexShader, sphereFragmentShader);
    this.textures = {
      facet_nodes: this.texture(), node_table: this.texture(), normal_table: this.texture(), facet_table: this.texture(),
      colour_map: this.texture(gl.LINEAR), part_colours: this.texture(),
    };
    this.facesArray = this.instanceArray(2);
    this.spheresArray = this.instanceArray(2);
    this.beamArrays = new Map();
    this.putFixedTables();
  }

  shader(type, text) {
    const gl = this.gl, made = gl.createShader(type);
    gl.shaderSource(made, text);
    gl.compileShader(made);
    if (!gl.getShaderParameter(made, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(made));
    return made;
  }

  program(vertex, fragment) {
    const gl = this.gl, made = gl.createProgram();
    gl.attachShader(made, this.shader(gl.VERTEX_SHADER, vertex));
    gl.attachShader(made, this.shader(gl.FRAGMENT_SHADER, fragment));
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made));
    const place = {};
    for (let i = gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS) - 1; i >= 0; --i) {
      const { name } = gl.getActiveUniform(made, i);
      place[name] = gl.getUniformLocation(made, name);
    }
    return { made, place };
  }

  texture(filter = this.gl.NEAREST) {
    const gl = this.gl, made = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, made);
    for (const name of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, name, filter);
    for (const name of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, name, gl.CLAMP_TO_EDGE);
    return made;
  }

  // Rows of 2048 texels of four numbers; the last row is filled up.
  put(name, numbers, inner, format, type) {
    const gl = this.gl, rows = Math.max(1, Math.ceil(numbers.length / 4 / texelsAcross));
    let filled = numbers;
    if (numbers.length !== 4 * texelsAcross * rows) {
      this.filled ??= {};
      this.filled[name] ??= new numbers.constructor(4 * texelsAcross * rows);
      filled = this.filled[name];
      filled.set(numbers);
    }
    gl.bindTexture(gl.TEXTURE_2D, this.textures[name]);
    gl.texImage2D(gl.TEXTURE_2D, 0, inner, texelsAcross, rows, 0, format, type, filled);
  }

  putFixedTables() {
    const gl = this.gl, nodes = new Uint32Array(4 * scene.facets);
    for (let f = 0; f < scene.facets; ++f) nodes.set(facetTable.subarray(5 * f, 5 * f + 4), 4 * f);
    this.put("facet_nodes", nodes, gl.RGBA32UI, gl.RGBA_INTEGER, gl.UNSIGNED_INT);
    const colours = new Uint8Array(4 * 1024 * Math.max(1, Math.ceil(scene.parts.length / 1024)));
    scene.parts.forEach((_, part) => colours.set([...partColour(part), 255], 4 * part));
    gl.bindTexture(gl.TEXTURE_2D, this.textures.part_colours);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 1024, colours.length / 4096, 0, gl.RGBA, gl.UNSIGNED_BYTE, colours);
  }

  putMap(name) {
    const gl = this.gl;
    gl.bindTexture(gl.TEXTURE_2D, this.textures.colour_map);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, mapTexels(name));
  }

  // An array of whole numbers, so many for each instance.
  instanceArray(count) {
    const gl = this.gl, array = gl.createVertexArray(), buffer = gl.createBuffer();
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribIPointer(0, count, gl.UNSIGNED_INT, 0, 0);
    gl.vertexAttribDivisor(0, 1);
    return { array, buffer, count: 0 };
  }

  fill(target, numbers, each) {
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, target.buffer);
    gl.bufferData(gl.ARRAY_BUFFER, numbers, gl.DYNAMIC_DRAW);
    target.count = numbers.length / each;
  }

  beamArray(part) {
    if (!this.beamArrays.has(part)) {
      const gl = this.gl, made = this.instanceArray(1), vertices = beamVertices(scene.parts[part].section);
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, vertices, gl.STATIC_DRAW);
      for (const place of [1, 2]) {
        gl.enableVertexAttribArray(place);
        gl.vertexAttribPointer(place, 3, gl.FLOAT, false, 24, 12 * (place - 1));
      }
      made.vertices = vertices.length / 6;
      this.beamArrays.set(part, made);
    }
    return this.beamArrays.get(part);
  }

  // Takes over what a scene has become.
  take(state) {
    const gl = this.gl;
    for (const [name, numbers] of [["node_table", state.node], ["normal_table", state.normal],
      ["facet_table", state.facet]]) this.put(name, numbers, gl.RGBA32F, gl.RGBA, gl.FLOAT);
    if (!state.isNew) return;
    this.fill(this.facesArray, state.quads, 2);
    this.fill(this.spheresArray, state.spheres, 2);
    for (const made of this.beamArrays.values()) made.count = 0;
    for (const [part, facets] of state.lines) this.fill(this.beamArray(part), Uint32Array.from(facets), 1);
  }

  // \param colouring see the shaders
  use(program, look, colouring = look.colouring) {
    const gl = this.gl, place = program.place;
    gl.useProgram(program.made);
    Object.keys(this.textures).forEach((name, unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, this.textures[name]);
      if (place[name]) gl.uniform1i(place[name], unit);
    });
    gl.activeTexture(gl.TEXTURE0);
    gl.uniformMatrix4fv(place.view, false, look.view);
    gl.uniformMatrix4fv(place.projection, false, look.projection);
    gl.uniform1i(place.colouring, colouring);
    gl.uniform2fv(place.range, look.range);
    gl.uniform4fv(place.cut, look.cut);
    if (place.mesh_lines) gl.uniform1i(place.mesh_lines, look.meshLines);
    if (place.feature_lines) gl.uniform1i(place.feature_lines, look.featureLines);
    if (place.least_radius) gl.uniform1f(place.least_radius, look.leastRadius);
  }

  draw(look) {
    const gl = this.gl;
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    this.use(this.faces, look, look.colouring === 1 && look.smooth ? 2 : look.colouring);
    gl.bindVertexArray(this.facesArray.array);
    gl.drawArraysInstanced(gl.TRIANGLES, 0, 6, this.facesArray.count);
    this.use(this.beams, look);
    for (const [part, made] of this.beamArrays) {
      gl.uniform3fv(this.beams.place.orientation, scene.parts[part].orientation || [0, 0, 0]);
      gl.uniform1i(this.beams.place.by_radius, isRound(part));
      gl.bindVertexArray(made.array);
      gl.drawArraysInstanced(gl.TRIANGLES, 0, made.vertices, made.count);
    }
    this.use(this.spheres, look);
    gl.bindVertexArray(this.spheresArray.array);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, this.spheresArray.count);
  }
}

// Outlines of sections as closed polygons, counterclockwise seen against the beam.
function outlineOf(section) {
  const { kind, width: w, height: h } = section;
  if (kind === "rectangle") return [[-w / 2, -h / 2], [w / 2, -h / 2], [w / 2, h / 2], [-w / 2, h / 2]];
  const t = section.web_thickness / 2, f = h / 2 - section.flange_thickness;
  return [[-w / 2, -h / 2], [w / 2, -h / 2], [w / 2, -f], [t, -f], [t, f], [w / 2, f], [w / 2, h / 2], [-w / 2, h / 2],
    [-w / 2, f], [-t, f], [-t, -f], [-w / 2, -f]];
}

// Triangles of one beam: end and place in the section, then the normal. Round ones have the radius 1.
function beamVertices(section) {
  const vertices = [];
  const round = !section || section.kind === "circle" || section.kind === "tube" || !(section.width > 0);
  const corners = round ? Array.from({ length: 16 }, (_, i) => [Math.cos(i * Math.PI / 8), Math.sin(i * Math.PI / 8)])
    : outlineOf(section);
  corners.forEach((a, i) => {
    const b = corners[(i + 1) % corners.length];
    const across = [b[1] - a[1], a[0] - b[0]], size = Math.hypot(...across) || 1;
    const [na, nb] = round ? [a, b] : [across, across].map((n) => [n[0] / size, n[1] / size]);
    const side = [[0, a, na], [0, b, nb], [1, b, nb], [0, a, na], [1, b, nb], [1, a, na]];
    for (const [end, p, n] of side) vertices.push(end, ...p, 0, ...n);
  });
  for (const end of [0, 1]) {
    for (const triangle of capTriangles(corners)) {
      for (const p of end === 1 ? triangle : [...triangle].reverse()) vertices.push(end, ...p, 2 * end - 1, 0, 0);
    }
  }
  return Float32Array.from(vertices);
}

// I sections are three rectangles, all others convex.
function capTriangles(corners) {
  const fans = corners.length === 12 ? [[0, 1, 2, 11], [10, 3, 4, 9], [8, 5, 6, 7]] : [[...corners.keys()]];
  return fans.flatMap((fan) => fan.slice(2).map((_, i) => [fan[0], fan[i + 1], fan[i + 2]].map((c) => corners[c])));
}

// Recorded scenes in motion: one view a solver, side by side, turned together. Plain WebGL; lit, coloured by strain.
(() => {
  const canvas = document.getElementById("motion-view");
  if (!canvas) return;
  const gl = canvas.getContext("webgl", {antialias: true});
  const labels = document.getElementById("motion-labels");
  if (!gl) { labels.textContent = "This browser draws no WebGL."; return; }
  const choice = document.getElementById("motion-choice"), slider = document.getElementById("motion-time");
  const play = document.getElementById("motion-play"), clock = document.getElementById("motion-clock");

  function shader(type, source) {
    const made = gl.createShader(type);
    gl.shaderSource(made, source);
    gl.compileShader(made);
    return made;
  }
  const program = gl.createProgram();
  gl.attachShader(program, shader(gl.VERTEX_SHADER, `
    attribute vec3 place, normal, tint;
    uniform mat4 view;
    varying vec3 n, c;
    void main() { n = normal; c = tint; gl_Position = view * vec4(place, 1.0); }`));
  gl.attachShader(program, shader(gl.FRAGMENT_SHADER, `
    precision mediump float;
    varying vec3 n, c;
    void main() {
      float light = 0.35 + 0.65 * abs(dot(normalize(n), normalize(vec3(0.4, 0.8, 0.5))));
      gl_FragColor = vec4(c * light, 1.0);
    }`));
  gl.linkProgram(program);
  gl.useProgram(program);
  gl.enable(gl.DEPTH_TEST);
  const attribute = Object.fromEntries(["place", "normal", "tint"].map((name) => [name, gl.getAttribLocation(program, name)]));
  const viewAt = gl.getUniformLocation(program, "view");

  // Strain over its limit, as in films: blue up to it, yellow and red beyond.
  const stops = [[0, [0.80, 0.78, 0.72]], [0.5, [0.58, 0.70, 0.80]], [1, [0.25, 0.50, 0.75]], [1.5, [0.95, 0.70, 0.25]], [4, [0.80, 0.12, 0.10]]];
  function colour(value, out, at) {
    let k = 1;
    while (k < stops.length - 1 && value > stops[k][0]) ++k;
    const [low, a] = stops[k - 1], [high, b] = stops[k];
    const part = Math.min(1, Math.max(0, (value - low) / (high - low)));
    for (let i = 0; i < 3; ++i) out[at + i] = a[i] + part * (b[i] - a[i]);
  }

  function decoded(film) {
    if (film.x) return film;
    const bytes = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));
    const whole = new Uint16Array(bytes(film.positions).buffer);
    film.strainUnits = bytes(film.strains);
    film.x = new Float32Array(whole.length);
    for (let i = 0; i < whole.length; ++i) film.x[i] = film.low[i % 3] + whole[i] / 65535 * film.span[i % 3];
    let begin = 0;
    for (const take of film.takes) { take.begin = begin; begin += take.frames * film.vertices * 3; }
    return film;
  }

  function normalsOf(x, triangles) {
    const normals = new Float32Array(x.length);
    for (const [a, b, c] of triangles) {
      const u = [0, 1, 2].map((i) => x[3 * b + i] - x[3 * a + i]), v = [0, 1, 2].map((i) => x[3 * c + i] - x[3 * a + i]);
      const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
      for (const vertex of [a, b, c]) for (let i = 0; i < 3; ++i) normals[3 * vertex + i] += n[i];
    }
    return normals;
  }

  const buffers = {};
  function send(name, values) {
    buffers[name] ??= gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, buffers[name]);
    gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
    gl.enableVertexAttribArray(attribute[name]);
    gl.vertexAttribPointer(attribute[name], 3, gl.FLOAT, false, 0, 0);
  }
  function drawMesh(x, normals, tints, indices, mode) {
    Object.entries({place: x, normal: normals, tint: tints}).forEach(([name, values]) => send(name, values));
    buffers.indices ??= gl.createBuffer();
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffers.indices);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, indices, gl.DYNAMIC_DRAW);
    gl.drawElements(mode, indices.length, gl.UNSIGNED_SHORT, 0);
  }

  let film, turn = 0.7, lift = 0.35, distance = 1.5, playing = false, frame = 0, last = 0;

  // Perspective times a look at the middle of what moves.
  function view(aspect) {
    const middle = film.low.map((low, i) => low + 0.5 * film.span[i]);
    const far = distance * Math.hypot(...film.span), f = 2.4, near = 0.05 * far, end = 4 * far, degrees = 180 / Math.PI;
    return new DOMMatrix([f / Math.max(aspect, 1), 0, 0, 0, 0, f * Math.min(aspect, 1), 0, 0,
      0, 0, (end + near) / (near - end), -1, 0, 0, 2 * end * near / (near - end), 0])
      .translate(0, 0, -far).rotateAxisAngle(1, 0, 0, lift * degrees).rotateAxisAngle(0, 1, 0, -turn * degrees)
      .translate(...middle.map((value) => -value)).toFloat32Array();
  }

  function bodyAt(frame) {
    if (!film.body_poses.length) return film.body.flat();
    const m = film.body_poses[Math.min(frame, film.body_poses.length - 1)];
    return film.body.flatMap(([x, y, z]) => [0, 4, 8].map((row) => m[row] * x + m[row + 1] * y + m[row + 2] * z + m[row + 3]));
  }

  function draw() {
    const ratio = window.devicePixelRatio || 1;
    canvas.width = canvas.clientWidth * ratio;
    canvas.height = canvas.clientHeight * ratio;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const takes = film.takes, n = film.vertices;
    const stacked = canvas.width < canvas.height * takes.length * 0.6;  // narrow screens: one above the other
    const width = Math.floor(canvas.width / (stacked ? 1 : takes.length)), height = Math.floor(canvas.height / (stacked ? takes.length : 1));
    const body = new Float32Array(bodyAt(frame)), bodyNormals = normalsOf(body, film.body_triangles);
    takes.forEach((take, number) => {
      const at = Math.min(frame, take.frames - 1), begin = take.begin + at * n * 3;
      const x = film.x.subarray(begin, begin + 3 * n);
      gl.viewport(stacked ? 0 : number * width, stacked ? (takes.length - 1 - number) * height : 0, width, height);
      gl.uniformMatrix4fv(viewAt, false, view(width / height));
      if (film.body.length) {
        drawMesh(body, bodyNormals, new Float32Array(body.length).fill(0.62), new Uint16Array(film.body_triangles.flat()), gl.TRIANGLES);
      }
      const tints = new Float32Array(3 * n);
      for (let v = 0; v < n; ++v) colour(film.strainUnits[begin / 3 + v] * film.strain_unit, tints, 3 * v);
      if (film.triangles.length) {
        drawMesh(x, normalsOf(x, film.triangles), tints, new Uint16Array(film.triangles.flat()), gl.TRIANGLES);
      } else {
        drawMesh(x, new Float32Array(3 * n).fill(1), tints, new Uint16Array(film.edges.flat()), gl.LINES);
      }
    });
    slider.value = frame;
    clock.textContent = `${(frame / film.frames_per_second).toFixed(2)} s`;
    labels.textContent = (stacked ? "From top to bottom: " : "From left to right: ") + takes.map((take) =>
      `${take.label} at ${percent(take.strain_limit)}${frame >= take.frames ? `, ended: ${take.detail}` : ""}`).join("; ");
  }

  function choose() {
    film = decoded(data.motions[Number(choice.value)]);
    slider.max = Math.max(...film.takes.map((take) => take.frames)) - 1;
    frame = 0;
    draw();
  }

  function tick(now) {
    if (!playing) return;
    if (now - last >= 1000 / film.frames_per_second) {
      last = now;
      frame = frame >= Number(slider.max) ? 0 : frame + 1;
      draw();
    }
    requestAnimationFrame(tick);
  }

  play.addEventListener("click", () => {
    playing = !playing;
    play.textContent = playing ? "Pause" : "Play";
    if (playing) requestAnimationFrame(tick);
  });
  slider.addEventListener("input", () => { frame = Number(slider.value); draw(); });
  choice.addEventListener("change", choose);
  let held = false;
  canvas.addEventListener("pointerdown", (event) => { held = true; canvas.setPointerCapture(event.pointerId); });
  canvas.addEventListener("pointerup", () => { held = false; });
  function rotate(right, up) {
    turn -= right;
    lift = Math.min(1.5, Math.max(-1.5, lift + up));
    draw();
  }
  canvas.addEventListener("pointermove", (event) => { if (held) rotate(0.01 * event.movementX, 0.01 * event.movementY); });
  canvas.addEventListener("wheel", (event) => { event.preventDefault(); closer(event.deltaY > 0 ? 1.1 : 1 / 1.1); }, {passive: false});
  function closer(factor) { distance = Math.min(20, Math.max(0.5, factor * distance)); draw(); }
  canvas.addEventListener("keydown", (event) => {
    const act = {ArrowLeft: () => rotate(-0.1, 0), ArrowRight: () => rotate(0.1, 0), ArrowUp: () => rotate(0, 0.1), ArrowDown: () => rotate(0, -0.1),
      "+": () => closer(1 / 1.1), "-": () => closer(1.1)}[event.key];
    if (act) { event.preventDefault(); act(); }
  });
  window.addEventListener("resize", draw);
  data.motions.forEach((motion, index) => choice.append(element("option", {value: index}, words(motion.scene))));
  choose();
})();

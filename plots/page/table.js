// All points, sorted by column and filtered by words.
(() => {
  const table = document.getElementById("points-table");
  if (!table) return;
  const filter = document.getElementById("points-filter"), best = document.getElementById("points-best");
  const count = document.getElementById("points-count"), more = document.getElementById("points-more");
  const portion = 100;
  let limit = portion, key = "seconds", down = false;

  const columns = [["Solver", "solver", (p) => data.labels[p.solver]], ["Scene", "scene", (p) => words(p.scene)], ["Sweep", "sweep", (p) => p.sweep],
    ["Vertices", "vertices", (p) => p.vertices], ["Limit", "limit", (p) => percent(p.limit)], ["Step", "step", (p) => stepText(p.step)],
    ["Status", "status", (p) => words(p.status)], ["Time", "seconds", (p) => timeText(p.seconds)], ["Strain", "strain", (p) => percent(p.strain)],
    ["Delivered", "delivered", (p) => percent(p.delivered)], ["Error", "error", (p) => p.error === null ? "" : p.error.toPrecision(3)],
    ["Energy gained", "energy", (p) => p.energy === null ? "" : p.energy.toPrecision(2)], ["Iterations", "iterations", (p) => p.iterations ?? ""],
    ["File", "file", (p) => data.files[p.file].name]];
  const text = points.map((p) => `${p.solver} ${data.labels[p.solver]} ${p.id} ${p.sweep} ${p.status} ${data.files[p.file].name}`.toLowerCase());

  const head = table.tHead.rows[0];
  for (const [title, name] of columns) {
    const button = element("button", {type: "button"}, title);
    button.addEventListener("click", () => { down = key === name ? !down : false; key = name; draw(); });
    head.append(element("th", {scope: "col"}, button));
  }
  head.append(element("th", {scope: "col"}, "Repeat"));

  function draw() {
    const wanted = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    const kept = points.filter((point, index) => (!best.checked || point.best) && !hidden.has(point.solver) &&
      wanted.every((word) => text[index].includes(word)));
    const sign = down ? -1 : 1;
    kept.sort((a, b) => a[key] === b[key] ? 0 : a[key] === null ? 1 : b[key] === null ? -1 : sign * (a[key] < b[key] ? -1 : 1));
    columns.forEach(([, name], index) => head.cells[index].setAttribute("aria-sort", name === key ? (down ? "descending" : "ascending") : "none"));
    table.tBodies[0].replaceChildren(...kept.slice(0, limit).map((point) => {
      const cells = columns.map(([, , show], index) => element("td", {className: index > 2 && index < 13 && index !== 6 ? "number" : ""}, String(show(point))));
      return element("tr", {title: story(point)}, ...cells, element("td", {}, repeatButton(count, point)));
    }));
    count.textContent = `${kept.length} of ${points.length} points`;
    more.hidden = kept.length <= limit;
  }

  filter.addEventListener("input", () => { limit = portion; draw(); });
  best.addEventListener("change", draw);
  more.addEventListener("click", () => { limit += 5 * portion; draw(); });
  onHide.push(draw);
  draw();
})();

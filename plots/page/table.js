// The points, of one contest and place or all, without hidden solvers, filtered by words and sorted by column.
(() => {
  const part = (name) => document.getElementById(`points-${name}`);
  const table = part("table"), contest = part("contest"), place = part("place"), filter = part("filter"), best = part("best");
  if (!table) return;
  const portion = 100, hidden = new Set();
  let limit = portion, key = "seconds", down = false, least = 1;

  // Best points of a sweep of one scene; its places are its limits or sizes.
  const contests = new Map(), sweeps = new Map();
  for (const point of points) {
    point.axis = point.sweep === "strain" ? percent(point.limit) : `${point.vertices} vertices`;
    if (point.sweep === "step" || !point.best || point.seconds === null) continue;
    const fixed = point.sweep === "strain" ? `${point.vertices} vertices` : percent(point.limit);
    const name = `${words(point.scene)} over ${point.sweep}, ${fixed}`, sweep = data.files[point.file].sweep;
    // Sweeps of a scene with other parameters are contests of their own.
    if (!sweeps.has(name)) sweeps.set(name, sweep);
    const unique = sweeps.get(name) === sweep ? name : `${name} (${data.files[point.file].name})`;
    contests.set(unique, [...contests.get(unique) ?? [], point]);
  }
  for (const name of contests.keys()) contest.append(element("option", {value: name}, name));

  const columns = [["Solver", "solver", (p) => data.labels[p.solver]], ["Scene", "scene", (p) => words(p.scene)], ["Sweep", "sweep", (p) => p.sweep],
    ["Vertices", "vertices", (p) => p.vertices], ["Limit", "limit", (p) => percent(p.limit)], ["Step", "step", (p) => stepText(p.step)],
    ["Status", "status", (p) => words(p.status)], ["Time", "seconds", (p) => timeText(p.seconds)],
    ["Times the first", "seconds", (p) => p.seconds === null ? "" : (p.seconds / least).toPrecision(3)], ["Strain", "strain", (p) => percent(p.strain)],
    ["Delivered", "delivered", (p) => percent(p.delivered)], ["Error", "error", (p) => p.error === null ? "" : p.error.toPrecision(3)],
    ["Energy gained", "energy", (p) => p.energy === null ? "" : p.energy.toPrecision(2)], ["Iterations", "iterations", (p) => p.iterations ?? ""],
    ["File", "file", (p) => data.files[p.file].name]];
  const text = new Map(points.map((p) => [p, `${p.solver} ${data.labels[p.solver]} ${p.id} ${p.sweep} ${p.status} ${data.files[p.file].name}`.toLowerCase()]));

  const head = table.tHead.rows[0];
  for (const [title, name] of columns) {
    const button = element("button", {type: "button"}, title);
    button.addEventListener("click", () => { down = key === name ? !down : false; key = name; draw(); });
    head.append(element("th", {scope: "col"}, button));
  }
  head.append(element("th", {scope: "col"}, "Repeat"));

  // The places and solvers of the contest that was chosen.
  function choose(wanted = place.value) {
    const here = contests.get(contest.value) ?? points, places = contests.has(contest.value) ? [...new Set(here.map((point) => point.axis))] : [];
    place.replaceChildren(element("option", {value: ""}, "all"), ...places.map((name) => element("option", {value: name}, name)));
    place.value = places.includes(wanted) ? wanted : "";
    const names = new Set(here.map((point) => point.solver)), box = part("solvers");
    box.replaceChildren(box.firstElementChild);
    for (const name of Object.keys(data.labels).filter((name) => names.has(name))) {
      const tick = element("input", {type: "checkbox", checked: !hidden.has(name)});
      tick.addEventListener("change", () => { if (tick.checked) hidden.delete(name); else hidden.add(name); draw(); });
      box.append(element("label", {}, tick, data.labels[name]));
    }
    draw();
  }

  function draw() {
    const wanted = filter.value.toLowerCase().split(/\s+/).filter(Boolean);
    const found = points.filter((point) => wanted.every((word) => text.get(point).includes(word)));
    const here = new Set(contests.get(contest.value) ?? points);
    const kept = found.filter((point) => here.has(point) && (!best.checked || point.best) && !hidden.has(point.solver) &&
      (!place.value || point.axis === place.value));
    least = Math.min(...kept.map((point) => point.seconds ?? Infinity));
    const sign = down ? -1 : 1;
    kept.sort((a, b) => a[key] === b[key] ? 0 : a[key] === null ? 1 : b[key] === null ? -1 : sign * (a[key] < b[key] ? -1 : 1));
    columns.forEach(([, name], index) => head.cells[index].setAttribute("aria-sort", name === key ? (down ? "descending" : "ascending") : "none"));
    table.tBodies[0].replaceChildren(...kept.slice(0, limit).map((point) => {
      const cells = columns.map(([, , show], index) => element("td", {className: index > 2 && index < 14 && index !== 6 ? "number" : ""}, String(show(point))));
      return element("tr", {title: story(point)}, ...cells, element("td", {}, repeatButton(part("command"), point)));
    }));
    part("count").textContent = `${kept.length} of ${points.length} points`;
    part("everywhere").hidden = kept.length > 0 || found.length === 0;
    part("everywhere").textContent = `Show the ${found.length} outside of this choice`;
    part("more").hidden = kept.length <= limit;
  }

  contest.addEventListener("change", () => choose());
  for (const control of [place, best]) control.addEventListener("change", draw);
  filter.addEventListener("input", () => { limit = portion; draw(); });
  part("everywhere").addEventListener("click", () => { contest.value = ""; best.checked = false; hidden.clear(); choose(""); });
  part("more").addEventListener("click", () => { limit += 5 * portion; draw(); });
  // Opens on the largest drape over strain at 1 %, or the first contest.
  const size = (name) => name.startsWith("drape over strain") ? contests.get(name)[0].vertices : 0;
  contest.value = [...contests.keys()].reduce((a, b) => size(b) > size(a) ? b : a, [...contests.keys()][0] ?? "");
  choose("1 %");
})();

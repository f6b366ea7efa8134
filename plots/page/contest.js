// The chart of best points, in which solvers can be hidden, and the ranks of those that are left.
(() => {
  const choice = document.getElementById("contest-choice");
  if (!choice) return;
  const place = document.getElementById("contest-place"), chart = document.getElementById("contest-chart");
  const detail = document.getElementById("contest-detail");
  const ranks = document.querySelector("#contest-ranks tbody");
  const left = 72, right = 740, top = 16, bottom = 380;

  const contests = new Map();
  for (const point of points) {
    if (point.sweep === "step" || !point.best || point.seconds === null) continue;
    const fixed = point.sweep === "strain" ? `${point.vertices} vertices` : percent(point.limit);
    const name = `${words(point.scene)} over ${point.sweep}, ${fixed}${point.adaptive ? ", adaptive steps" : ""} (${data.files[point.file].name})`;
    if (!contests.has(name)) contests.set(name, []);
    contests.get(name).push(point);
  }
  for (const name of contests.keys()) choice.append(element("option", {value: name}, name));

  const solversOf = (points) => [...new Set(points.map((point) => point.solver))].sort((a, b) => a - b);
  const shown = () => contests.get(choice.value).filter((point) => !hidden.has(point.solver));
  const axis = (point) => point.sweep === "strain" ? point.limit : point.vertices;
  const axisText = (point) => point.sweep === "strain" ? percent(point.limit) : `${point.vertices} vertices`;

  // A solver's mark, as in the figures: corners on a circle, by the letters of matplotlib.
  const corners = {s: [4, 45], D: [4, 0], d: [4, 0, 0.6], "^": [3, -90], v: [3, 90], "<": [3, 180], ">": [3, 0], p: [5, -90], h: [6, -90],
    H: [6, 0], "*": [5, -90, 1, 0.45], X: [4, 0, 1, 0.45], P: [4, -45, 1, 0.45]};
  function outline(marker) {
    const radius = 6.5;
    if (!(marker in corners)) return `M ${radius} 0 A ${radius} ${radius} 0 1 0 ${-radius} 0 A ${radius} ${radius} 0 1 0 ${radius} 0 Z`;
    const [count, turn, narrow = 1, inner = 0] = corners[marker];
    const steps = inner ? 2 * count : count;
    const places = Array.from({length: steps}, (_, k) => {
      const angle = (turn + 360 * k / steps) * Math.PI / 180, far = inner && k % 2 ? inner * radius : radius;
      return `${(narrow * far * Math.cos(angle)).toFixed(2)} ${(far * Math.sin(angle)).toFixed(2)}`;
    });
    return `M ${places.join(" L ")} Z`;
  }

  const symbol = (solver, more) => drawn("path", {d: outline(solver.marker), stroke: solver.color, "stroke-width": 1.5,
    fill: solver.hollow ? "transparent" : solver.color, ...more});

  function fillPlaces() {
    const texts = new Map(contests.get(choice.value).map((point) => [axis(point), axisText(point)]));
    const was = place.value;
    place.replaceChildren(...[...texts].sort((a, b) => b[0] - a[0]).map(([value, text]) => element("option", {value}, text)));
    if ([...texts.keys()].some((value) => String(value) === was)) place.value = was;
    const box = document.getElementById("contest-solvers");
    box.replaceChildren(box.firstElementChild);
    for (const number of solversOf(contests.get(choice.value))) {
      const solver = data.solvers[number];
      const tick = element("input", {type: "checkbox", checked: !hidden.has(number)});
      tick.addEventListener("change", () => {
        if (tick.checked) hidden.delete(number); else hidden.add(number);
        onHide.forEach((act) => act());
      });
      const swatch = drawn("svg", {class: "swatch", viewBox: "-8 -8 16 16", "aria-hidden": "true"}, symbol(solver));
      box.append(element("label", {}, tick, swatch, solver.label));
    }
  }

  function draw() {
    const all = shown();
    chart.replaceChildren();
    rank(all);
    if (!all.length) return;
    const xs = all.map(axis), ys = all.flatMap((point) => [point.seconds, point.high ?? point.seconds]);
    const scale = (low, high, from, to) => {
      const begin = Math.log10(low), span = Math.log10(high) - begin || 1;
      return (value) => from + (Math.log10(value) - begin) / span * (to - from);
    };
    const x = scale(Math.min(...xs) / 1.15, Math.max(...xs) * 1.15, left, right);
    const y = scale(Math.min(...ys) / 1.2, Math.max(...ys) * 1.2, bottom, top);
    for (const value of [...new Set(xs)].sort((a, b) => a - b)) {
      chart.append(drawn("line", {class: "grid", x1: x(value), x2: x(value), y1: top, y2: bottom}),
        drawn("text", {x: x(value), y: bottom + 18, "text-anchor": "middle"}, all[0].sweep === "strain" ? percent(value) : String(value)));
    }
    for (let power = Math.ceil(Math.log10(Math.min(...ys) / 1.2)); 10 ** power <= Math.max(...ys) * 1.2; ++power) {
      chart.append(drawn("line", {class: "grid", x1: left, x2: right, y1: y(10 ** power), y2: y(10 ** power)}),
        drawn("text", {x: left - 6, y: y(10 ** power) + 4, "text-anchor": "end"}, timeText(10 ** power * (1 + 1e-9))));
    }
    chart.append(drawn("text", {x: (left + right) / 2, y: bottom + 40, "text-anchor": "middle"},
      all[0].sweep === "strain" ? "strain limit" : "vertices"));
    for (const number of solversOf(all)) {
      const solver = data.solvers[number];
      const own = all.filter((point) => point.solver === number).sort((a, b) => axis(a) - axis(b));
      chart.append(drawn("polyline", {points: own.map((point) => `${x(axis(point))},${y(point.seconds)}`).join(" "), fill: "none",
        stroke: solver.color, "stroke-width": solver.hollow ? 1 : 2, "stroke-dasharray": solver.dashes.join(" ")}));
      for (const point of own) {
        if (point.high !== null) {
          chart.append(drawn("line", {stroke: solver.color, x1: x(axis(point)), x2: x(axis(point)), y1: y(point.seconds), y2: y(point.high)}));
        }
        const mark = symbol(solver, {class: "mark", tabindex: 0, role: "button", transform: `translate(${x(axis(point))} ${y(point.seconds)})`,
          "aria-label": `${solver.label}, ${axisText(point)}: ${timeText(point.seconds)}; press to copy its command`});
        for (const event of ["focus", "mouseenter"]) mark.addEventListener(event, () => tell(detail, point));
        mark.addEventListener("click", () => copy(detail, point));
        mark.addEventListener("keydown", (event) => {
          if (event.key === "Enter" || event.key === " ") { event.preventDefault(); copy(detail, point); }
        });
        chart.append(mark);
      }
    }
  }

  function rank(all) {
    const here = all.filter((point) => String(axis(point)) === place.value).sort((a, b) => a.seconds - b.seconds);
    ranks.replaceChildren(...here.map((point, index) => {
      const cells = [index + 1, data.solvers[point.solver].label, timeText(point.seconds),
        point.high === null ? "" : `${timeText(point.seconds)} to ${timeText(point.high)}`, (point.seconds / here[0].seconds).toPrecision(3),
        stepText(point.step), percent(point.delivered ?? point.strain), point.error === null ? "" : point.error.toPrecision(3)];
      return element("tr", {}, ...cells.map((cell, number) => element("td", {className: number === 1 ? "" : "number"}, String(cell))));
    }));
  }

  choice.addEventListener("change", () => { fillPlaces(); draw(); });
  place.addEventListener("change", draw);
  onHide.push(draw);
  // Opens on the largest drape over strain at 1 %, where there is one.
  const most = (name) => Math.max(...contests.get(name).map((point) => point.vertices));
  const drapes = [...contests.keys()].filter((name) => name.startsWith("drape over strain"));
  if (drapes.length) choice.value = drapes.reduce((a, b) => most(b) > most(a) ? b : a);
  if (contests.size) {
    fillPlaces();
    if ([...place.options].some((option) => option.value === "0.01")) place.value = "0.01";
    draw();
  }
})();

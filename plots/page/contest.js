// Ranks of the best points at one place of a sweep, without hidden solvers.
(() => {
  const choice = document.getElementById("contest-choice");
  if (!choice) return;
  const place = document.getElementById("contest-place"), detail = document.getElementById("contest-detail");
  const ranks = document.querySelector("#contest-ranks tbody");

  const contests = new Map();
  for (const point of points) {
    if (point.sweep === "step" || !point.best || point.seconds === null) continue;
    const fixed = point.sweep === "strain" ? `${point.vertices} vertices` : percent(point.limit);
    const name = `${words(point.scene)} over ${point.sweep}, ${fixed} (${data.files[point.file].name})`;
    if (!contests.has(name)) contests.set(name, []);
    contests.get(name).push(point);
  }
  for (const name of contests.keys()) choice.append(element("option", {value: name}, name));

  const axis = (point) => point.sweep === "strain" ? point.limit : point.vertices;
  const axisText = (point) => point.sweep === "strain" ? percent(point.limit) : `${point.vertices} vertices`;

  function fill() {
    const contest = contests.get(choice.value), was = place.value;
    const texts = new Map(contest.map((point) => [axis(point), axisText(point)]));
    place.replaceChildren(...[...texts].sort((a, b) => b[0] - a[0]).map(([value, text]) => element("option", {value}, text)));
    if ([...texts.keys()].some((value) => String(value) === was)) place.value = was;
    const box = document.getElementById("contest-solvers");
    box.replaceChildren(box.firstElementChild);
    for (const name of Object.keys(data.labels).filter((name) => contest.some((point) => point.solver === name))) {
      const tick = element("input", {type: "checkbox", checked: !hidden.has(name)});
      tick.addEventListener("change", () => {
        if (tick.checked) hidden.delete(name); else hidden.add(name);
        onHide.forEach((act) => act());
      });
      box.append(element("label", {}, tick, data.labels[name]));
    }
  }

  function rank() {
    const here = contests.get(choice.value).filter((point) => !hidden.has(point.solver) && String(axis(point)) === place.value)
      .sort((a, b) => a.seconds - b.seconds);
    ranks.replaceChildren(...here.map((point, index) => {
      const cells = [index + 1, data.labels[point.solver], timeText(point.seconds),
        point.high === null ? "" : `${timeText(point.seconds)} to ${timeText(point.high)}`, (point.seconds / here[0].seconds).toPrecision(3),
        stepText(point.step), percent(point.delivered ?? point.strain), point.error === null ? "" : point.error.toPrecision(3)];
      return element("tr", {title: story(point)}, ...cells.map((cell, number) => element("td", {className: number === 1 ? "" : "number"}, String(cell))),
        element("td", {}, repeatButton(detail, point)));
    }));
  }

  choice.addEventListener("change", () => { fill(); rank(); });
  place.addEventListener("change", rank);
  if (!contests.size) return;
  onHide.push(rank);
  // Opens on the largest drape over strain at 1 %, where there is one.
  const most = (name) => Math.max(...contests.get(name).map((point) => point.vertices));
  const drapes = [...contests.keys()].filter((name) => name.startsWith("drape over strain"));
  if (drapes.length) choice.value = drapes.reduce((a, b) => most(b) > most(a) ? b : a);
  fill();
  if ([...place.options].some((option) => option.value === "0.01")) place.value = "0.01";
  rank();
})();

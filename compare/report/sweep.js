// Curves of error and cost along an axis, from the results of `arealab sweep`. Drawn with d3 (https://d3js.org).
"use strict";
(() => {
const results = JSON.parse(document.getElementById("results").textContent);
const scenes = results.scenes, axis = scenes[0].sweep;
const known = (v) => typeof v === "number" && Number.isFinite(v);
const curveName = (v) => axis.axis === "samples" ? v.short_name.split("+samples=")[0] : v.short_name;
const names = [...new Set(scenes.flatMap((s) => s.variants.filter((v) => v.supported).map(curveName)))];
const color = d3.scaleOrdinal(names, ["#2f7ed8", "#c2571a", "#2a9d6f", "#a3489f", "#8a7a12", "#d1495b", "#3b9fb5", "#7a6fd0", "#6b8e23", "#888f99"]);
const gpus = [...new Set(scenes.flatMap((s) => s.variants.flatMap((v) => Object.keys(v.isa))))];
const where = results.software ? ", measured on a CPU rasteriser, not a GPU" : ", measured";
const figures = [
  { title: "relative RMSE, %", value: (s, v) => 100 * v.error.total.rel_rmse },
  { title: `time of the pass, ms${where}`, value: (s, v) => known(v.time.ns_per_pixel) ? v.time.ns_per_pixel * s.lit_pixels * 1e-6 : null,
    bar: (s, v) => v.time.ns_interval ? v.time.ns_interval.map((t) => t * s.lit_pixels * 1e-6) : null },
  { title: `time over a point light's${where}`, value: (s, v) => v.time.ratio_to_point, bar: (s, v) => v.time.ratio_interval },
  ...gpus.map((gpu) => ({ title: `cycles on ${gpu}, the technique alone, estimated`, value: (s, v) => v.isa[gpu] ? v.isa[gpu].core.cycles : null })),
];
const hidden = new Set();

function draw(host, figure) {
  const curves = names.filter((n) => !hidden.has(n)).map((name) => ({ name, points: scenes.flatMap((s) => s.variants.filter((v) => v.supported && curveName(v) === name)
    .map((v) => ({ x: s.sweep.value, y: figure.value(s, v), bar: figure.bar ? figure.bar(s, v) : null }))).filter((p) => known(p.y) && p.y > 0 && (p.x > 0 || !axis.logarithmic)) })).filter((c) => c.points.length);
  host.replaceChildren();
  if (!curves.length) { host.append("Nothing was measured here."); return; }
  const width = Math.max(280, host.clientWidth), height = 320, box = { left: 60, right: width - 14, top: 12, bottom: height - 44 };
  const all = curves.flatMap((c) => c.points), [x0, x1] = d3.extent(all, (p) => p.x), [y0, y1] = d3.extent(all, (p) => p.y);
  const X = (axis.logarithmic ? d3.scaleLog() : d3.scaleLinear()).domain(x0 === x1 ? [x0 * 0.9, x1 * 1.1] : [x0, x1]).range([box.left + 6, box.right - 6]);
  const Y = d3.scaleLog().domain([y0 / 1.2, y1 * 1.2]).range([box.bottom, box.top]);
  const svg = d3.select(host).append("svg").attr("viewBox", `0 0 ${width} ${height}`).attr("width", width).attr("height", height);
  const format = (v) => Number(v.toPrecision(3)).toLocaleString("en");
  const few = (scale, most) => { const t = scale.ticks(most); return t.length > 2 * most ? t.filter((v) => /^1(\.0+)?$|^1e/.test(v.toExponential(0).split("e")[0])) : t; };
  const xTicks = width < 600 || scenes.length > 14 ? few(X, 5) : scenes.map((s) => s.sweep.value).filter((v) => v > 0 || !axis.logarithmic), yTicks = few(Y, 6);
  svg.append("g").attr("class", "grid").selectAll("line").data(yTicks).join("line").attr("x1", box.left).attr("x2", box.right).attr("y1", Y).attr("y2", Y);
  svg.append("g").attr("class", "axis").attr("transform", `translate(0 ${box.bottom})`).call(d3.axisBottom(X).tickValues(xTicks).tickFormat(format).tickSize(4));
  svg.append("g").attr("class", "axis").attr("transform", `translate(${box.left} 0)`).call(d3.axisLeft(Y).tickValues(yTicks).tickFormat(format).tickSize(0).tickPadding(8));
  svg.append("text").attr("x", (box.left + box.right) / 2).attr("y", height - 6).attr("text-anchor", "middle").text(axis.title);
  for (const c of curves) {
    const g = svg.append("g").attr("class", "curve").attr("data-name", c.name).style("color", color(c.name));
    g.append("path").attr("fill", "none").attr("stroke", "currentColor").attr("stroke-width", 2).attr("stroke-dasharray", /@published$/.test(c.name) ? "5 4" : null)
      .attr("d", d3.line().x((p) => X(p.x)).y((p) => Y(p.y))(c.points));
    for (const p of c.points) {
      if (p.bar) g.append("line").attr("stroke", "currentColor").attr("x1", X(p.x)).attr("x2", X(p.x)).attr("y1", Y(Math.max(p.bar[0], Y.domain()[0]))).attr("y2", Y(Math.min(p.bar[1], Y.domain()[1])));
      g.append("circle").attr("cx", X(p.x)).attr("cy", Y(p.y)).attr("r", 3.5).attr("fill", "currentColor")
        .append("title").text(`${c.name}: ${format(p.y)}${p.bar ? ` (${format(p.bar[0])} to ${format(p.bar[1])})` : ""} at ${format(p.x)}`);
    }
  }
}

const element = (tag, text, className) => { const e = document.createElement(tag); if (text) e.textContent = text; if (className) e.className = className; return e; };
document.getElementById("masthead").append(element("h1", `How error and cost grow: ${axis.title}`), element("p", `${results.renderer}${results.software ? " (CPU rasteriser, not a GPU)" : ""} · ${results.date || ""}`, "lede"));
const legend = element("div", "", "toolbar"), main = document.getElementById("main");
for (const name of names) {
  const exponent = results.exponents[name], chip = element("button", name + (known(exponent) && axis.logarithmic ? ` · time ∝ ${axis.axis}^${exponent.toFixed(2)}` : ""), "chip-toggle");
  chip.type = "button";
  chip.style.borderColor = color(name);
  chip.setAttribute("aria-pressed", "true");
  chip.addEventListener("click", () => { if (!hidden.delete(name)) hidden.add(name); chip.setAttribute("aria-pressed", String(!hidden.has(name))); drawAll(); });
  legend.append(chip);
}
main.append(legend);
const charts = figures.map((figure) => {
  const section = element("section"), card = element("div", "", "card chart");
  section.append(element("h3", figure.title), card);
  main.append(section);
  return [card, figure];
});
const drawAll = () => { for (const [host, figure] of charts) draw(host, figure); };
new ResizeObserver(drawAll).observe(main);
drawAll();
const links = element("p");
links.innerHTML = 'Figures for programs: <a href="results.json">results.json</a>, <a href="curves.csv">curves.csv</a>.';
document.getElementById("footer").append(element("p", results.command, "mono"), links);
})();

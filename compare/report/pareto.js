// Error over cost as a picture: a mark per variant with its name, the frontier of those that nothing beats in both, curves
// through families, error bars. Drawn with d3 (https://d3js.org); knows nothing of the report.
"use strict";
window.arealabPareto = (() => {
// What nothing beats in both, from the cheapest on.
function frontier(marks) {
  const order = [...marks].sort((p, q) => p.x - q.x || p.y - q.y);
  let least = Infinity;
  return order.filter((m) => m.y < least && ((least = m.y), true));
}

// 1-2-5 steps of a logarithmic axis; of a linear one, or of one that spans little, d3's.
function ticks(scale, log) {
  const [lo, hi] = scale.domain(), steps = [];
  if (log) {
    for (let e = Math.floor(Math.log10(lo)); e <= Math.ceil(Math.log10(hi)); ++e) {
      for (const s of [1, 2, 5]) if (s * 10 ** e >= lo * 0.999 && s * 10 ** e <= hi * 1.001) steps.push(s * 10 ** e);
    }
    const most = Math.abs(scale.range()[1] - scale.range()[0]) / 46;
    if (steps.length > most) return steps.filter((v) => Math.abs(Math.log10(v) - Math.round(Math.log10(v))) < 1e-9);
    if (steps.length > 2) return steps;
  }
  return d3.scaleLinear().domain([lo, hi]).ticks(Math.abs(scale.range()[1] - scale.range()[0]) / 80).filter((v) => v >= lo && v <= hi);
}

// Where the names go: beside their marks where there is room, else a little further off with a line back.
function placeNames(marks, X, Y, box, lines) {
  const context = document.createElement("canvas").getContext("2d");
  context.font = `12px ${getComputedStyle(document.body).fontFamily}`;
  const taken = [...marks.map((m) => [X(m.x) - 6, Y(m.y) - 6, 12, 12]), ...lines];
  const offsets = [[9, -7, 0], [-9, -7, 1], [0, -22, 0.5], [0, 8, 0.5], [8, -19, 0], [8, 5, 0], [-8, -19, 1], [-8, 5, 1]];
  for (const radius of [30, 44, 60, 80, 104]) {
    for (let i = 0; i < 16; ++i) {
      const a = (i + 0.5) * Math.PI / 8, c = Math.cos(a);
      offsets.push([radius * c, -7 + radius * Math.sin(a), c > 0.4 ? 0 : c < -0.4 ? 1 : 0.5, true]);
    }
  }
  const places = new Map();
  for (const m of marks) {
    const w = context.measureText(m.label).width + 3, cx = X(m.x), cy = Y(m.y);
    for (const [dx, dy, anchor, far] of offsets) {
      const x = cx + dx - anchor * w, y = cy + dy;
      if (x < box.left + 2 || x + w > box.right || y < box.top || y + 15 > box.bottom) continue;
      if (taken.some((t) => x < t[0] + t[2] && t[0] < x + w && y < t[1] + t[3] && t[1] < y + 15)) continue;
      taken.push([x, y, w, 15]);
      places.set(m, { x, y: y + 11.5, back: far ? [Math.min(Math.max(cx, x), x + w), cy < y ? y : y + 15] : null });
      break;
    }
  }
  return places;
}

// host: an element of some width. plot: { marks: [{ id, label, x, y, xBar, yBar, hollow, text }], links: [[id, id]],
// chains: [[id …]], x and y: { title, log, format }, limit: { y, text } or null, name, onpick(id), onhover(mark or null) }.
function draw(host, plot) {
  host.replaceChildren();
  const width = Math.max(280, host.clientWidth), height = Math.round(Math.min(470, Math.max(330, width * 0.55)));
  const box = { left: 66, right: width - 12, top: 26, bottom: height - 46 };
  const svg = d3.select(host).append("svg").attr("viewBox", `0 0 ${width} ${height}`).attr("width", width).attr("height", height)
    .attr("role", "group").attr("aria-label", plot.name);
  const axis = (key, range) => {
    const values = plot.marks.flatMap((m) => [m[key], ...(m[key + "Bar"] || [])]).filter((v) => Number.isFinite(v) && (v > 0 || !plot[key].log));
    if (key === "y" && plot.limit) values.push(plot.limit.y);
    const [lo, hi] = d3.extent(values), room = plot[key].log ? Math.max(1.12, (hi / lo) ** 0.07) : 0;
    return plot[key].log ? d3.scaleLog().domain([lo / room, hi * room]).range(range) : d3.scaleLinear().domain([Math.min(0, lo), hi * 1.06]).range(range);
  };
  const X = axis("x", [box.left, box.right]), Y = axis("y", [box.bottom, box.top]);
  const at = new Map(plot.marks.map((m) => [m.id, m])), front = frontier(plot.marks), best = new Set(front);
  const xTicks = ticks(X, plot.x.log), yTicks = ticks(Y, plot.y.log);
  svg.append("g").attr("class", "grid").selectAll("line").data([...xTicks.map((v) => [X(v), X(v), box.top, box.bottom]), ...yTicks.map((v) => [box.left, box.right, Y(v), Y(v)])])
    .join("line").attr("x1", (d) => d[0]).attr("x2", (d) => d[1]).attr("y1", (d) => d[2]).attr("y2", (d) => d[3]);
  const format = (axisOf, key) => axisOf.tickFormat(plot[key].format).tickSize(0).tickPadding(8);
  svg.append("g").attr("class", "axis").attr("transform", `translate(0 ${box.bottom})`).call(format(d3.axisBottom(X).tickValues(xTicks), "x"));
  svg.append("g").attr("class", "axis").attr("transform", `translate(${box.left} 0)`).call(format(d3.axisLeft(Y).tickValues(yTicks), "y"));
  svg.append("text").attr("x", (box.left + box.right) / 2).attr("y", height - 6).attr("text-anchor", "middle").text(plot.x.title);
  svg.append("text").attr("x", 2).attr("y", 13).text(plot.y.title);
  if (plot.limit) {
    svg.append("line").attr("class", "limit").attr("x1", box.left).attr("x2", box.right).attr("y1", Y(plot.limit.y)).attr("y2", Y(plot.limit.y));
    svg.append("text").attr("x", box.right - 4).attr("y", Y(plot.limit.y) - 5).attr("text-anchor", "end").text(plot.limit.text);
  }
  // Down from where each next better one begins to pay.
  const steps = front.map((m, i) => (i ? `H${X(m.x)}V${Y(m.y)}` : `M${X(m.x)} ${Y(m.y)}`)).join("");
  svg.append("path").attr("class", "front").attr("d", steps + (front.length ? `H${box.right}` : ""));
  for (const chain of plot.chains) {
    const points = chain.map((id) => at.get(id)).filter(Boolean).sort((p, q) => p.x - q.x);
    svg.append("path").attr("class", "chain").attr("d", d3.line().x((m) => X(m.x)).y((m) => Y(m.y))(points));
  }
  for (const [from, to] of plot.links) {
    const a = at.get(from), b = at.get(to);
    if (a && b) svg.append("line").attr("class", "link-line").attr("x1", X(a.x)).attr("y1", Y(a.y)).attr("x2", X(b.x)).attr("y2", Y(b.y));
  }
  const inside = (v, lo, hi) => Math.min(hi, Math.max(lo, v));
  for (const m of plot.marks) {
    const group = svg.append("g").attr("class", `mark ${best.has(m) ? "best" : "beaten"}${m.hollow ? " hollow" : ""}`).attr("data-id", m.id)
      .attr("tabindex", 0).attr("role", "button").attr("aria-label", m.text);
    if (m.xBar) group.append("line").attr("class", "bar").attr("x1", X(m.xBar[0])).attr("x2", X(m.xBar[1])).attr("y1", Y(m.y)).attr("y2", Y(m.y));
    if (m.yBar) group.append("line").attr("class", "bar").attr("x1", X(m.x)).attr("x2", X(m.x)).attr("y1", inside(Y(Math.max(m.yBar[0], Y.domain()[0])), box.top, box.bottom)).attr("y2", Y(m.yBar[1]));
    group.append("circle").attr("cx", X(m.x)).attr("cy", Y(m.y)).attr("r", 5);
    group.append("title").text(m.text);
    const pick = () => plot.onpick(m.id);
    group.on("click", pick).on("pointerenter focus", () => plot.onhover(m)).on("pointerleave blur", () => plot.onhover(null))
      .on("keydown", () => { if (d3.event.key === "Enter" || d3.event.key === " ") { d3.event.preventDefault(); pick(); } });
  }
  // Names keep off the frontier's steps.
  const lines = front.slice(1).flatMap((m, i) => {
    const p = front[i];
    return [[X(p.x), Y(p.y) - 1, X(m.x) - X(p.x), 2], [X(m.x) - 1, Y(p.y), 2, Y(m.y) - Y(p.y)]];
  });
  const order = [...plot.marks].sort((p, q) => best.has(q) - best.has(p));
  for (const [m, place] of placeNames(order, X, Y, box, lines)) {
    if (place.back) svg.insert("line", "g.mark").attr("class", "leader").attr("x1", X(m.x)).attr("y1", Y(m.y)).attr("x2", place.back[0]).attr("y2", place.back[1]);
    svg.append("text").attr("class", `name ${best.has(m) ? "best" : "beaten"}`).attr("data-name", m.id).attr("x", place.x).attr("y", place.y).text(m.label);
  }
  return front;
}

return { draw, frontier };
})();

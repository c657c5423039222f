// The report's page: everything shown is computed here from results.json and the half floats in data/. No network.
"use strict";
(() => {
const results = JSON.parse(document.getElementById("results").textContent);
const LOBES = ["total", "diffuse", "specular"];
const TRUTH = "truth", SHADOWED = "truth-shadowed";
const reduceMotion = matchMedia("(prefers-reduced-motion: reduce)").matches;

// ---------------------------------------------------------------- small tools

// An element; text only ever enters as text, never as markup.
function h(tag, attributes, ...children) {
  const svg = ["svg", "g", "path", "circle", "line", "text", "rect", "title"].includes(tag);
  const e = svg ? document.createElementNS("http://www.w3.org/2000/svg", tag) : document.createElement(tag);
  for (const [key, value] of Object.entries(attributes || {})) {
    if (value === undefined || value === null || value === false) continue;
    if (key === "text") e.textContent = value;
    else if (key.startsWith("on")) e.addEventListener(key.slice(2), value);
    else if (key === "style") for (const [p, v] of Object.entries(value)) e.style.setProperty(p, v);
    else e.setAttribute(key, value === true ? "" : value);
  }
  e.append(...children.flat().filter((c) => c !== null && c !== undefined && c !== false));
  return e;
}
const $ = (selector, root = document) => root.querySelector(selector);
const clamp = (v, lo, hi) => Math.min(hi, Math.max(lo, v));
const known = (v) => typeof v === "number" && Number.isFinite(v);
const variantsOf = (scene) => scene.variants.filter((v) => v.stem);
const variantNamed = (scene, name) => scene.variants.find((v) => v.name === name);
const shadowOf = (scene) => scene.truth.shadow && scene.truth.shadow.stem ? scene.truth.shadow : null;
const label = (scene, name) => name === TRUTH ? (scene.truth.visibility ? "truth, with shadows" : "truth") : name === SHADOWED ? "truth, shadowed" : (variantNamed(scene, name) || { short_name: name }).short_name || name;
// The same where a narrow column may break it: before an option, not within a word.
const breakable = (text) => text.replace(/[@+]/g, "\u200b$&");

// The source whose technique a variant is: what its citation names, as `compare --source` takes it.
const OTHERS = "Others and yardsticks";
const SOURCES = [...(results.sources || []), OTHERS];
const sourceOf = (v) => SOURCES.find((s) => `; ${v.citation || ""}`.includes(`; ${s}`)) || OTHERS;
const bySource = (variants) => SOURCES.map((s) => [s, variants.filter((v) => sourceOf(v) === s)]).filter(([, list]) => list.length);
const chosen = (v) => !state.source || sourceOf(v) === state.source;

// Percent with about three figures; `tight` for matrix cells, at most four characters.
function percent(v, tight) {
  if (!known(v)) return "–";
  const p = 100 * v, m = Math.abs(p);
  if (m === 0) return "0";
  if (tight) return m >= 9950 ? `${(p / 1000).toFixed(0)}k` : m >= 999.5 ? `${(p / 1000).toFixed(1)}k` : m >= 9.95 ? p.toFixed(0) : m >= 0.995 ? p.toFixed(1) : m >= 0.005 ? p.toFixed(2) : "0.00";
  if (m >= 1e4) return p.toExponential(1).replace("e+", "e");
  return m >= 99.95 ? p.toFixed(0) : m >= 9.995 ? p.toFixed(1) : m >= 0.9995 ? p.toFixed(2) : m >= 0.0995 ? p.toFixed(3) : m >= 1e-4 ? p.toPrecision(2) : p.toExponential(1);
}
function figure(v, digits = 3) {
  if (!known(v)) return "–";
  if (v === 0) return "0";
  const m = Math.abs(v);
  if (m >= 1e5 || m < 1e-3) return v.toExponential(digits - 1).replace("e+", "e");
  return v.toPrecision(digits).includes("e") ? Math.round(v).toString() : v.toPrecision(digits);
}
const signed = (text) => /^[-–]/.test(text) || text === "0" ? text.replace("-", "−") : "+" + text;
const seconds = (s) => !known(s) ? "not timed" : s < 0.1 ? `${(1000 * s).toFixed(0)} ms` : s < 100 ? `${s.toFixed(2)} s` : `${(s / 60).toFixed(1)} min`;
// 0 at 0.01 %, 1 at 100 %, by decades.
const heat = (v) => known(v) && v > 0 ? clamp(Math.log10(v / 1e-4) / 4, 0, 1) ** 1.4 : 0;
const hot = (v) => heat(v) > 0.8 ? " hottest" : heat(v) > 0.6 ? " hot" : "";

// ---------------------------------------------------------------- colour

// OKLCH (hue in degrees) to 8-bit sRGB; chroma is reduced until the colour exists [Ottosson 2020].
function oklch(L, C, H) {
  const linear = (c) => {
    const a = c * Math.cos(H * Math.PI / 180), b = c * Math.sin(H * Math.PI / 180);
    const l = (L + 0.3963377774 * a + 0.2158037573 * b) ** 3;
    const m = (L - 0.1055613458 * a - 0.0638541728 * b) ** 3;
    const s = (L - 0.0894841775 * a - 1.2914855480 * b) ** 3;
    return [4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
            -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
            -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s];
  };
  const fits = (c) => linear(c).every((v) => v >= -1e-6 && v <= 1 + 1e-6);
  let lo = 0, hi = C;
  if (fits(C)) lo = C;
  else for (let i = 0; i < 24; ++i) { const mid = (lo + hi) / 2; if (fits(mid)) lo = mid; else hi = mid; }
  return linear(lo).map((v) => Math.round(255 * encodeSrgb(clamp(v, 0, 1))));
}
function encodeSrgb(v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055; }

// Signed map: near black at 0, lightness linear in |t|, blue below and orange above. t in [−1, 1].
function signedColor(t) {
  const u = Math.abs(t), chroma = 0.17 * Math.pow(u, 0.55) * (1 - 0.4 * u * u);
  return t >= 0 ? oklch(0.17 + 0.73 * u, chroma, 50 + 40 * u) : oklch(0.17 + 0.73 * u, chroma, 262 - 42 * u);
}
// Magnitude map: black, violet, red, orange, pale yellow; lightness linear. t in [0, 1].
function magnitudeColor(t) {
  return oklch(0.14 + 0.83 * t, 0.205 * Math.sin(Math.PI * (0.1 + 0.78 * t)), 288 + 174 * t);
}
const MAP_STEPS = 512;
const maps = {
  signed: Array.from({ length: 2 * MAP_STEPS + 1 }, (_, i) => signedColor((i - MAP_STEPS) / MAP_STEPS)),
  magnitude: Array.from({ length: MAP_STEPS + 1 }, (_, i) => magnitudeColor(i / MAP_STEPS)),
};
const NONFINITE = [255, 0, 255];
const UNLIT = [84, 88, 95];
const css = (c) => `rgb(${c[0]} ${c[1]} ${c[2]})`;

// How far along the scale a relative difference lies: linear, or by the two decades below the range's end.
function position(d, range, log) {
  const u = Math.abs(d) / range;
  const t = log ? (u > 0 ? clamp((Math.log10(u) + 2) / 2, 0, 1) : 0) : Math.min(u, 1);
  return d < 0 ? -t : t;
}
function mapColor(kind, d, range, log) {
  if (Number.isNaN(d)) return NONFINITE;
  const t = position(d, range, log);
  return kind === "signed" ? maps.signed[Math.round(t * MAP_STEPS) + MAP_STEPS] : maps.magnitude[Math.round(Math.abs(t) * MAP_STEPS)];
}

const SRGB_STEPS = 16384;
const srgbTable = Uint8Array.from({ length: SRGB_STEPS + 1 }, (_, i) => Math.round(255 * encodeSrgb(i / SRGB_STEPS)));

// ---------------------------------------------------------------- images

const halfTable = (() => {
  const table = new Float32Array(65536);
  for (let i = 0; i < 65536; ++i) {
    const sign = i & 0x8000 ? -1 : 1, exponent = (i >> 10) & 31, fraction = i & 1023;
    table[i] = sign * (exponent === 31 ? (fraction ? NaN : Infinity) : exponent === 0 ? fraction * 2 ** -24 : (fraction + 1024) * 2 ** (exponent - 25));
  }
  return table;
})();

const loaded = new Map();  // "folder/stem" → promise of an image
const waiting = new Map();  // "folder/stem" → {resolve, reject}

// Called by the files in data/; the format is described in AreaLab's compare/page_data.h.
window.arealabImage = (key, header, data) => {
  const entry = waiting.get(key);
  if (entry) decode(key, header, data).then(entry.resolve, entry.reject);
};

// windows-1252 gives the bytes 0x80 to 0x9f characters of their own.
const byteOf = new Map([...new TextDecoder("windows-1252").decode(Uint8Array.from({ length: 32 }, (_, i) => 128 + i))].map((c, i) => [c.charCodeAt(0), 128 + i]));

async function decode(key, header, data) {
  const packed = new Uint8Array(data.length);
  for (let i = 0; i < data.length; ++i) {
    const code = data.charCodeAt(i);
    packed[i] = code < 128 || (code > 159 && code < 256) ? code : byteOf.get(code);
  }
  const truth = header.planes.some((mode) => mode[1] === "t") ? await load(key.split("/")[0], "truth") : null;
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  const bytes = new Uint8Array(await new Response(stream).arrayBuffer());
  const { width, height, exponent, shift } = header, size = width * height, planes = [];
  let at = 0;
  for (let lobe = 0; lobe < 2; ++lobe) {
    for (const channel of [1, 0, 2]) {
      const mode = header.planes[3 * lobe + channel], green = planes[3 * lobe + 1];
      const base = mode[1] === "g" ? green : mode[1] === "t" ? truth.planes[3 * lobe + channel].map((v) => v >>> shift) : null;
      if (mode[0] === "=") { planes[3 * lobe + channel] = base; continue; }
      const plane = new Uint16Array(size);
      for (let i = 0, y = 0; y < height; ++y) {
        for (let x = 0; x < width; ++x, ++i) {
          const z = bytes[at + i] | (bytes[at + size + i] << 8);
          const left = x ? plane[i - 1] : 0, up = y ? plane[i - width] : 0, corner = x && y ? plane[i - width - 1] : 0;
          plane[i] = ((z >>> 1) ^ -(z & 1)) + left + up - corner;
        }
      }
      at += 2 * size;
      if (base) for (let i = 0; i < size; ++i) plane[i] += base[i];
      planes[3 * lobe + channel] = plane;
    }
  }
  return { width, height, planes: planes.map((plane) => shift ? plane.map((v) => v << shift) : plane), scale: 2 ** exponent };
}

function load(folder, stem) {
  const key = `${folder}/${stem}`;
  if (!loaded.has(key)) {
    loaded.set(key, new Promise((resolve, reject) => {
      waiting.set(key, { resolve, reject });
      const file = `data/${encodeURIComponent(folder)}/${encodeURIComponent(stem)}.js`;
      if (location.protocol.startsWith("http")) {  // a server may claim another encoding: read the bytes
        fetch(file).then((r) => r.ok ? r.arrayBuffer() : Promise.reject(new Error(`${file}: ${r.status}`)))
          .then((bytes) => Function(new TextDecoder("windows-1252").decode(bytes))()).catch(reject);
        return;
      }
      const script = h("script", { src: file, charset: "windows-1252", onerror: () => reject(new Error(`${file} is missing: the report's folder moves as a whole`)) });
      script.addEventListener("load", () => script.remove());
      document.head.append(script);
    }));
  }
  return loaded.get(key);
}

// The three values of a lobe at pixel i.
function radiance(image, lobe, i, out) {
  const p = image.planes, s = image.scale;
  for (let c = 0; c < 3; ++c) {
    out[c] = lobe === "diffuse" ? halfTable[p[c][i]] * s : lobe === "specular" ? halfTable[p[c + 3][i]] * s
      : halfTable[p[c][i]] * s + halfTable[p[c + 3][i]] * s;
  }
  return out;
}
const luminance = (v) => 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2];
const finite3 = (v) => Number.isFinite(v[0] + v[1] + v[2]);

// The relative difference at a pixel: NaN where not finite, undefined where neither is lit.
function difference(kind, va, vb, floor) {
  if (!finite3(va) || !finite3(vb)) return NaN;
  if (!va[0] && !va[1] && !va[2] && !vb[0] && !vb[1] && !vb[2]) return undefined;
  const yb = luminance(vb), base = Math.max(yb, floor);
  const d = kind === "signed" ? luminance(va) - yb
    : Math.max(Math.abs(va[0] - vb[0]), Math.abs(va[1] - vb[1]), Math.abs(va[2] - vb[2]));
  return d === 0 ? 0 : base > 0 ? d / base : d > 0 ? Infinity : -Infinity;
}

function newCanvas(width, height) {
  const canvas = document.createElement("canvas");
  canvas.width = width;
  canvas.height = height;
  return canvas;
}

function paintPicture(canvas, image, emission, lobe, ev) {
  const context = canvas.getContext("2d"), pixels = context.createImageData(canvas.width, canvas.height);
  const step = image.width / canvas.width, gain = 2 ** ev * SRGB_STEPS, v = [0, 0, 0], out = pixels.data;
  for (let y = 0, o = 0; y < canvas.height; ++y) {
    const row = Math.floor((y + 0.5) * step) * image.width;
    for (let x = 0; x < canvas.width; ++x, o += 4) {
      const i = row + Math.floor((x + 0.5) * step);
      radiance(image, lobe, i, v);
      for (let c = 0; c < 3; ++c) {
        const light = emission ? v[c] + halfTable[emission.planes[c][i]] * emission.scale : v[c];
        out[o + c] = srgbTable[Math.round(clamp(light * gain, 0, SRGB_STEPS))];
      }
      if (!finite3(v)) [out[o], out[o + 1], out[o + 2]] = NONFINITE;
      out[o + 3] = 255;
    }
  }
  context.putImageData(pixels, 0, 0);
}

function paintMap(canvas, kind, a, b, lobe, floor, range, log) {
  const context = canvas.getContext("2d"), pixels = context.createImageData(canvas.width, canvas.height);
  const step = a.width / canvas.width, va = [0, 0, 0], vb = [0, 0, 0], out = pixels.data;
  for (let y = 0, o = 0; y < canvas.height; ++y) {
    const row = Math.floor((y + 0.5) * step) * a.width;
    for (let x = 0; x < canvas.width; ++x, o += 4) {
      const i = row + Math.floor((x + 0.5) * step);
      const d = difference(kind, radiance(a, lobe, i, va), radiance(b, lobe, i, vb), floor);
      const color = d === undefined ? UNLIT : mapColor(kind, d, range, log);
      out[o] = color[0]; out[o + 1] = color[1]; out[o + 2] = color[2]; out[o + 3] = 255;
    }
  }
  context.putImageData(pixels, 0, 0);
}

// ---------------------------------------------------------------- state, kept in the address

const state = { scene: "", a: "", b: TRUTH, lobe: "total", map: "signed", log: true, range: 0, ev: 0, wipe: 0.5,
                zoom: 0, x: 0, y: 0, px: -1, py: -1, thumbs: "pictures", sort: "total", down: false,
                cost: "", metric: "rel_rmse", xlog: true, ylog: true, off: "", source: "", fit: "polygon", fitbrdf: "ggx" };
const DEFAULTS = { ...state };
let scene = null;
let images = new Map();  // variant name, TRUTH or "emission" → decoded image of the current scene
let generation = 0;

function readHash() {
  const query = new URLSearchParams(location.hash.slice(1));
  for (const key of Object.keys(DEFAULTS)) {
    const text = query.get(key), fallback = DEFAULTS[key];
    if (typeof fallback === "number") state[key] = text !== null && Number.isFinite(Number(text)) ? Number(text) : fallback;
    else if (typeof fallback === "boolean") state[key] = text === null ? fallback : text === "1";
    else state[key] = text === null ? fallback : text;
  }
  if (!LOBES.includes(state.lobe)) state.lobe = "total";
  if (!SOURCES.includes(state.source)) state.source = "";
  if (!FIT_METRICS.some(([m]) => m === state.fit)) state.fit = "polygon";
  if (!(results.fit || []).some((m) => m.brdf === state.fitbrdf)) state.fitbrdf = "ggx";
  if (!["signed", "magnitude"].includes(state.map)) state.map = "signed";
  if (!["pictures", "signed", "magnitude"].includes(state.thumbs)) state.thumbs = "pictures";
  if (!ERRORS.some(([key]) => key === state.metric)) state.metric = "rel_rmse";
  state.wipe = clamp(state.wipe, 0, 1);
  state.zoom = clamp(state.zoom, 0, 64);
  state.range = state.range > 0 ? state.range : 0;
}
function hashOf(changes) {
  const query = new URLSearchParams(), next = { ...state, ...changes };
  for (const [key, fallback] of Object.entries(DEFAULTS)) {
    let value = next[key];
    if (value === fallback && key !== "scene") continue;
    if (typeof value === "boolean") value = value ? "1" : "0";
    else if (typeof value === "number") value = String(Number(value.toFixed(4)));
    query.set(key, value);
  }
  return "#" + query.toString();
}
let hashTimer = 0;
function rememberState() {
  clearTimeout(hashTimer);
  hashTimer = setTimeout(() => { history.replaceState(null, "", hashOf({})); }, 150);
}
const sceneLink = (name, changes) => hashOf({ scene: name, a: "", b: TRUTH, zoom: 0, x: 0, y: 0, px: -1, py: -1, ev: 0, range: 0, ...changes });

function settle() {
  if (!results.scenes.length) return;
  scene = results.scenes.find((s) => s.name === state.scene) || results.scenes[0];
  state.scene = scene.name;
  const usable = (name) => name === TRUTH ? scene.truth.stem : name === SHADOWED ? shadowOf(scene) : (variantNamed(scene, name) || {}).stem;
  if (!usable(state.a)) {
    const ranked = variantsOf(scene).filter((v) => !v.within_truth_error && known(v.error.total.rel_rmse));
    ranked.sort((p, q) => p.error.total.rel_rmse - q.error.total.rel_rmse);
    state.a = (ranked[0] || variantsOf(scene)[0] || { name: TRUTH }).name;
  }
  if (!usable(state.b)) state.b = scene.truth.stem ? TRUTH : state.a;
  if (state.px < 0 || state.py < 0) {  // something to read from the start: where A is furthest off
    const v = variantNamed(scene, state.a);
    [state.px, state.py] = (v && v.error.total.max_pixel) || [scene.width >> 1, scene.height >> 1];
  }
}

// ---------------------------------------------------------------- page furniture

function segments(name, options, current, choose) {
  const box = h("div", { class: "segments", role: "group", "aria-label": name });
  for (const [value, text] of options) {
    box.append(h("button", { type: "button", "data-value": value, "aria-pressed": String(value === current), onclick: () => choose(value), text }));
  }
  return box;
}
function press(box, value) {
  for (const button of box.children) button.setAttribute("aria-pressed", String(button.dataset.value === String(value)));
}

function buildMasthead() {
  const techniques = new Set(results.scenes.flatMap((s) => s.variants.map((v) => v.name)));
  const count = (n, one, many) => `${n} ${n === 1 ? one : many}`;
  const theme = h("button", { type: "button", class: "button theme", text: "Light / dark", onclick: () => {
    const root = document.documentElement;
    const dark = root.dataset.theme ? root.dataset.theme === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
    root.dataset.theme = dark ? "light" : "dark";
    try { localStorage.setItem("arealab-theme", root.dataset.theme); } catch { /* a page from disk may have no storage */ }
  } });
  $("#masthead").append(
    h("div", { class: "brand" }, h("span", { class: "mark", "aria-hidden": "true" }), h("span", { text: `AreaLab ${results.version || ""}` }), theme),
    h("h1", { text: `${count(techniques.size, "area-light variant", "area-light variants")} against ground truth, in ${count(results.scenes.length, "scene", "scenes")}` }),
    h("p", { class: "lede" }, `${(results.date || "").replace("T", " ").replace("Z", " UTC")} · ${results.renderer || "renderer unknown"} `,
      results.software ? h("span", { class: "badge", text: "CPU rasteriser, not a GPU" }) : null));
  try {
    const kept = localStorage.getItem("arealab-theme");
    if (kept === "light" || kept === "dark") document.documentElement.dataset.theme = kept;
  } catch { /* as above */ }
}

function buildOverview() {
  const scenes = results.scenes, names = [];
  for (const s of scenes) for (const v of s.variants) if (!names.includes(v.name)) names.push(v.name);
  const section = h("section", { id: "overview", "aria-labelledby": "overview-heading" });
  const lobes = segments("Lobe of the overview", LOBES.map((l) => [l, l]), state.lobe, (l) => set({ lobe: l }));
  const holderOf = (name) => scenes.map((s) => variantNamed(s, name)).find(Boolean);
  const present = bySource(names.map(holderOf)).map(([s]) => s);
  const source = h("select", { "aria-label": "Source", onchange: (e) => set({ source: e.target.value }) }, h("option", { value: "", text: "all sources" }), present.map((s) => h("option", { value: s, text: s })));
  const matrix = h("div", { class: "matrix" + (scenes.length > 14 ? " vertical many" : ""), role: "table" });
  section.append(h("div", { class: "head" }, h("h2", { id: "overview-heading", text: "Error at a glance" }), lobes, source,
    h("p", { class: "note", text: "Relative RMSE against ground truth, in percent; the deeper the colour, the larger the error, by decades from 0.01 to 100 %. Choose a cell to see where the error is." })),
    h("div", { class: "card" }, matrix));

  section.refresh = () => {
    press(lobes, state.lobe);
    source.value = state.source;
    const wide = !matchMedia("(max-width: 720px)").matches;
    matrix.style.gridTemplateColumns = (wide ? "minmax(7rem, 15rem) " : "") + `repeat(${scenes.length}, minmax(0, 1fr))`;
    const error = (s, name) => { const v = variantNamed(s, name); return v && v.supported ? v.error[state.lobe].rel_rmse : undefined; };
    // Ordered by the mean of the logarithms over the scenes that a variant can shade.
    const score = (name) => {
      const values = scenes.map((s) => error(s, name)).filter(known);
      return values.length ? values.reduce((sum, v) => sum + Math.log(Math.max(v, 1e-9)), 0) / values.length : Infinity;
    };
    const rows = [...names].sort((p, q) => score(p) - score(q));
    matrix.replaceChildren(h("span", { class: "corner" }));
    for (const s of scenes) {
      matrix.append(h("span", { class: "column", "aria-current": String(s === scene) }, h("a", { href: sceneLink(s.name), text: s.name, title: s.question })));
    }
    for (const [group, members] of bySource(rows.map(holderOf).filter(chosen))) {
      matrix.append(h("span", { class: "source", text: group }));
      for (const { name } of members) {
        const holder = holderOf(name);
        matrix.append(h("span", { class: "name", title: `${holder.summary} ${holder.name !== holder.short_name ? holder.name : ""}`, text: holder.short_name || name }));
        for (const s of scenes) {
          const v = variantNamed(s, name);
          if (!v || !v.supported) {
            matrix.append(h("span", { class: "cell none", title: v ? v.reason : "not run", text: "–", "aria-label": "not supported" }));
            continue;
          }
          const value = v.error[state.lobe].rel_rmse;
          matrix.append(h("a", { class: "cell" + (v.within_truth_error ? " tied" : "") + hot(value), href: sceneLink(s.name, { a: name }), style: { "--t": heat(value) },
          title: `${s.name}, ${holder.short_name}: ${known(value) ? percent(value) + " %" : "not measured"}${v.within_truth_error ? ", within truth's own error" : ""}`,
          onclick: () => scrollToScene(), text: known(value) ? percent(value, true) : v.nonfinite_pixels ? "NaN" : "–" }));
        }
      }
    }
    matrix.append(h("span", { class: "rule" }));
    const quiet = (title, text, hint) => {
      matrix.append(h("span", { class: "name", text: title, title: hint }));
      for (const s of scenes) matrix.append(h("span", { class: "cell quiet", title: `${s.name}: ${hint}`, text: text(s) }));
    };
    quiet("truth's own error", (s) => percent(s.truth.relative_error, true), "estimated relative error of the ground truth, %");
    quiet("truth took, s", (s) => known(s.truth.seconds) ? (s.truth.seconds >= 100 ? s.truth.seconds.toFixed(0) : s.truth.seconds.toPrecision(2)) : "–", "seconds of computing, in the run that made it");
  };
  return section;
}

function scrollToScene() {
  requestAnimationFrame(() => $("#scene").scrollIntoView({ behavior: reduceMotion ? "auto" : "smooth" }));
}

// ---------------------------------------------------------------- the scene

const ui = {};  // elements of the current scene

function buildScene() {
  const section = h("section", { id: "scene", "aria-labelledby": "scene-heading" });
  const s = scene;
  const fact = (name, value) => h("span", {}, `${name} `, h("b", { text: value }));
  section.append(
    h("nav", { class: "tabs", "aria-label": "Scenes" }, results.scenes.map((t) =>
      h("a", { href: sceneLink(t.name, { lobe: state.lobe }), "aria-current": String(t === s), text: t.name }))),
    h("p", { class: "kicker", text: `Scene ${results.scenes.indexOf(s) + 1} of ${results.scenes.length}: ${s.name}` }),
    h("h2", { class: "question", id: "scene-heading", tabindex: "-1", text: s.question || s.name }),
    h("div", { class: "facts" },
      fact("size", `${s.width} × ${s.height}`), fact("lit pixels", s.lit_pixels.toLocaleString("en")), fact("unit", s.unit || "–"),
      s.effects.length ? fact("effects", s.effects.map((e) => e.replace(/^EFFECT_/, "").toLowerCase().replaceAll("_", " ")).join(", ")) : null,
      fact("truth good to", known(s.truth.relative_error) ? percent(s.truth.relative_error) + " %" : "–"),
      fact("truth took", seconds(s.truth.seconds) + (s.truth.cached ? " (now from the cache)" : "")),
      s.truth.visibility ? fact("visibility", "baked apertures, ranked against truth with shadows") : null,
      s.file ? fact("file", s.file) : null));

  // Controls
  const names = [...(s.truth.stem ? [TRUTH] : []), ...(shadowOf(s) ? [SHADOWED] : []), ...variantsOf(s).map((v) => v.name)];
  const picker = (key) => h("select", { "aria-label": `Image ${key.toUpperCase()}`, onchange: (e) => set({ [key]: e.target.value }) },
    names.filter((n) => !variantNamed(s, n)).map((n) => h("option", { value: n, text: label(s, n) })),
    bySource(variantsOf(s)).map(([group, list]) => h("optgroup", { label: group }, list.map((v) => h("option", { value: v.name, text: label(s, v.name) })))));
  ui.a = picker("a");
  ui.b = picker("b");
  ui.lobe = segments("Lobe", LOBES.map((l) => [l, l]), state.lobe, (l) => set({ lobe: l }));
  ui.map = segments("Map", [["signed", "signed"], ["magnitude", "magnitude"]], state.map, (m) => set({ map: m, thumbs: state.thumbs === "pictures" ? "pictures" : m }));
  ui.log = segments("Scale", [["0", "linear"], ["1", "log"]], state.log ? "1" : "0", (v) => set({ log: v === "1" }));
  const steps = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1];
  ui.range = h("select", { "aria-label": "End of the maps' scale", onchange: (e) => set({ range: Number(e.target.value) }) },
    h("option", { value: "0", text: `±${Number((100 * s.scale).toPrecision(2))} % (this scene's)` }), steps.map((v) => h("option", { value: v, text: `±${Number((100 * v).toPrecision(2))} %` })));
  ui.ev = h("input", { type: "range", min: "-8", max: "8", step: "0.25", "aria-label": "Exposure, stops from the scene's own", oninput: (e) => set({ ev: Number(e.target.value) }) });
  ui.evText = h("output", {});
  ui.zoom = segments("Zoom", [["0", "fit"], ["1", "1×"], ["2", "2×"], ["4", "4×"], ["8", "8×"], ["16", "16×"]], String(state.zoom), (z) => zoomTo(Number(z)));
  section.append(h("div", { class: "toolbar" },
    h("div", { class: "group pair" }, h("span", { class: "tag a", text: "A" }), ui.a, h("span", { class: "tag b", text: "B" }), ui.b,
      h("button", { type: "button", class: "button swap", text: "swap", title: "Exchange A and B (key s)", onclick: () => set({ a: state.b, b: state.a }) })),
    h("div", { class: "group" }, h("span", { class: "label", text: "lobe" }), ui.lobe),
    h("div", { class: "group" }, h("span", { class: "label", text: "map" }), ui.map, ui.log, ui.range),
    h("div", { class: "group" }, h("span", { class: "label", text: "exposure" }), ui.ev, ui.evText,
      h("button", { type: "button", class: "button", text: "reset", onclick: () => set({ ev: 0 }) })),
    h("div", { class: "group" }, h("span", { class: "label", text: "zoom" }), ui.zoom)));

  // Panes
  ui.left = newView("Pictures A and B under a wipe", true);
  ui.right = newView("Map of the difference between A and B", false);
  ui.leftA = h("span", {});
  ui.leftB = h("span", {});
  ui.rightText = h("span", {});
  ui.bar = newCanvas(512, 1);
  ui.ticks = h("div", { class: "ticks" });
  ui.legendText = h("p", {});
  ui.busy = h("div", { class: "busy", role: "status", text: "Loading …" });
  ui.left.box.append(ui.busy);
  ui.where = h("span", { class: "where" });
  ui.values = h("div", { class: "values" });
  section.append(h("div", { class: "stage" },
    h("figure", { class: "pane", id: "pictures" }, h("figcaption", {}, ui.leftA, ui.leftB), ui.left.box,
      h("div", { class: "under" }, "Drag the wipe, or use ", h("kbd", { text: "←" }), " ", h("kbd", { text: "→" }),
        "; double-click, pinch or Ctrl-scroll to zoom; drag to pan once zoomed. Emitters are shown here and count in no metric.")),
    h("figure", { class: "pane", id: "difference" }, h("figcaption", {}, ui.rightText), ui.right.box,
      h("div", { class: "under legend" }, h("div", { class: "bar" }, ui.bar), ui.ticks, ui.legendText,
        h("div", { class: "keys" }, h("span", {}, h("span", { class: "chip", style: { background: css(UNLIT) } }), "lit in neither"),
          h("span", {}, h("span", { class: "chip", style: { background: css(NONFINITE) } }), "NaN or infinite")))),
    h("figure", { class: "pane inspector" }, h("figcaption", {}, h("span", { text: "Value under the pointer" }), ui.where), ui.values)));

  section.append(buildThumbs(s), buildTable(s));
  delete ui.shadow;
  if (s.truth.shadow) section.append(buildShadow(s));
  const pairs = buildPairs(s);
  ui.plot = buildPareto([s], "Accuracy against cost", "on this scene");
  if (ui.plot) section.append(ui.plot);
  if (pairs) section.append(pairs);
  const split = buildSplit(s);
  if (split) section.append(split);
  const refused = s.variants.filter((v) => !v.supported);
  if (refused.length) {
    section.append(h("section", {}, h("div", { class: "head" }, h("h3", { text: "Not supported here" })),
      h("ul", { class: "refused card" }, refused.map((v) => h("li", {}, h("b", { text: v.short_name || v.name }), ": ", v.reason)))));
  }
  return section;
}

function buildThumbs(s) {
  ui.thumbMode = segments("Show in the grid", [["pictures", "pictures"], ["signed", "signed error"], ["magnitude", "magnitude"]], state.thumbs,
    (t) => set(t === "pictures" ? { thumbs: t } : { thumbs: t, map: t }));
  ui.thumbs = new Map();
  const grid = h("div", { class: "thumbs" });
  const entries = [...(s.truth.stem ? [{ name: TRUTH, stem: "truth" }] : []),
    ...(shadowOf(s) ? [{ name: SHADOWED, stem: shadowOf(s).stem, summary: "ground truth with visibility: nothing is ranked against it" }] : []), ...bySource(variantsOf(s)).flatMap(([, list]) => list)];
  let group = null;
  for (const v of entries) {
    if (v.citation !== undefined && sourceOf(v) !== group) grid.append(h("h4", { class: "source", text: group = sourceOf(v) }));
    const path = `images/${encodeURIComponent(s.folder)}/${encodeURIComponent(v.stem)}.png`;
    const picture = h("img", { class: "shot", src: path, width: s.width, height: s.height, style: { height: "auto" }, decoding: "async", alt: `${label(s, v.name)}: picture` });
    const map = newCanvas(Math.ceil(s.width / 2), Math.ceil(s.height / 2));
    map.className = "shot";
    const error = h("span", { class: "err" });
    const box = h("div", { class: "thumb" },
      h("button", { type: "button", class: "open", title: v.summary || "ground truth", onclick: () => set({ a: v.name }) }, picture, map,
        h("span", { class: "cap" }, h("span", { class: "who", text: breakable(label(s, v.name)) }), error)),
      h("button", { type: "button", class: "pick", text: "B", title: `Show ${label(s, v.name)} as B`, "aria-label": `Show ${label(s, v.name)} as B`, onclick: () => set({ b: v.name }) }));
    ui.thumbs.set(v.name, { box, picture, map, error, painted: "" });
    grid.append(box);
  }
  return h("section", {}, h("div", { class: "head" }, h("h3", { text: "All variants side by side" }), ui.thumbMode,
    h("p", { class: "note", text: "Choose a picture to see it as A; its B button puts it on the other side of the wipe. Error maps are against truth, on the scale above." })), grid);
}

// What shadows take, as a map of its own: techniques cast none, so it counts against nobody.
function buildShadow(s) {
  const shadow = s.truth.shadow, head = h("div", { class: "head" }, h("h3", { text: "The missing shadow" }));
  if (!shadow.stem) {
    head.append(h("p", { class: "note", text: "No shadow in this scene: " +
      (shadow.rel_rmse > 0 ? `what stands between the lights and the pixels changes truth by ${percent(shadow.rel_rmse)} % (relative RMSE).` : "nothing stands between the lights and the pixels.") }));
    return h("section", { class: "shadow" }, head);
  }
  head.append(h("p", { class: "note" },
    `Shadows take ${percent(shadow.light_lost)} % of this scene's light. Techniques cast none and are ranked against truth without them; against truth with them, truth itself has a relative RMSE of ${percent(shadow.rel_rmse)} % and a bias of ${signed(percent(shadow.bias))} %. ` +
    `Where rays were needed, shadowed truth has a standard error of ${percent(shadow.error.mean)} % on average and ${percent(shadow.error.p99)} % at the 99th percentile, relative to the pixel without shadows. It took ${seconds(shadow.seconds)}${shadow.cached ? " (now from the cache)" : ""}. `,
    h("button", { type: "button", class: "link", text: "Open the pair above", onclick: () => { set({ a: TRUTH, b: SHADOWED, range: SHADOW_RANGE, map: "signed", log: true }); scrollToScene(); } })));
  const map = newCanvas(s.width, s.height), bar = newCanvas(512, 1), ticks = h("div", { class: "ticks" });
  paintScale(bar, ticks, "signed", SHADOW_RANGE, true);
  ui.shadow = { map, painted: "" };
  return h("section", { class: "shadow" }, head, h("figure", { class: "pane" },
    h("figcaption", {}, h("span", { text: "truth relative to truth, shadowed" })), map,
    h("div", { class: "under legend" }, h("div", { class: "bar" }, bar), ticks,
      h("p", { text: "Orange: the missing shadow leaves truth too bright. Logarithmic, the same scale in every scene." }))));
}
const SHADOW_RANGE = 1;

const COLUMNS = [
  ["name", "variant", (v) => v.short_name || v.name],
  ["total", "total %", (v) => v.error.total.rel_rmse],
  ["diffuse", "diffuse %", (v) => v.error.diffuse.rel_rmse],
  ["specular", "specular %", (v) => v.error.specular.rel_rmse],
  ["bias", "bias %", (v) => v.error.total.bias],
  ["relmse", "relMSE", (v) => v.error.total.relmse],
  ["mae", "MAE", (v) => v.error.total.mae],
  ["p99", "p99", (v) => v.error.total.p99],
  ["max", "max", (v) => v.error.total.max],
  ["flip", "FLIP", (v) => v.error.total.flip],
  ["nonfinite", "NaN, ∞", (v) => v.nonfinite_pixels],
  ["model", "model %", (v) => v.error.split.model],
  ["approximation", "approx. %", (v) => v.error.split.approximation],
  ["rounding", "rounding %", (v) => v.error.split.rounding],
  ["time", "time × point", (v) => v.time.ratio_to_point],
];
const SPLIT = ["model", "approximation", "rounding"];
const withSpread = (value, interval) => known(value) && interval ? `${value.toFixed(value < 10 ? 2 : 1)} ± ${((interval[1] - interval[0]) / 2).toFixed(value < 10 ? 2 : 1)}` : "–";

// What stands behind a figure of cost.
function costHint(key, v) {
  if (key === "time" && v.time.ratio_interval) {
    return `95 % interval ${v.time.ratio_interval.map((x) => x.toFixed(2)).join(" to ")}, ${v.time.rounds} rounds` + (v.time.net_refusal ? `; no net ratio: ${v.time.net_refusal}` : "");
  }
  const isa = v.isa && v.isa[key];
  if (!isa) return null;
  const paths = Object.entries(isa.core.paths || {}).map(([path, cost]) => `light ${path} the horizon ${cost.cycles}`);
  return [`technique alone: ${isa.core.instructions} instructions, ${isa.core.registers} registers, ${isa.core.spills} spills`, `whole pass: ${isa.full.cycles} cycles`,
    ...(known(isa.core.estimated_ms_1080p) ? [`${isa.core.estimated_ms_1080p.toFixed(2)} ms at 1080p, estimated from ${key} ISA`] : []), ...paths].join("; ");
}

function buildTable(s) {
  const shown = variantsOf(s);
  const gpus = gpusOf([s]);
  const columns = [...COLUMNS.filter(([key, , value]) => !["time", "flip", ...SPLIT].includes(key) || shown.some((v) => known(value(v)))),
    ...gpus.map((gpu) => [gpu, gpu, (v) => v.isa && v.isa[gpu] ? v.isa[gpu].core.cycles : null])];
  const head = h("tr"), body = h("tbody");
  for (const [key, title] of columns) {
    head.append(h("th", { scope: "col", "data-key": key }, h("button", { type: "button", text: title, onclick: () => set({ sort: key, down: state.sort === key ? !state.down : false }) })));
  }
  const select = h("select", { "aria-label": "Sort the table by", onchange: (e) => set({ sort: e.target.value, down: false }) },
    columns.map(([key, title]) => h("option", { value: key, text: title })));
  ui.table = () => {
    select.value = columns.some(([key]) => key === state.sort) ? state.sort : "total";
    for (const th of head.children) {
      if (th.dataset.key === state.sort) th.setAttribute("aria-sort", state.down ? "descending" : "ascending");
      else th.removeAttribute("aria-sort");
    }
    const value = (columns.find(([key]) => key === state.sort) || columns[1])[2];
    const size = (v) => { const x = value(v); return typeof x === "string" ? x : known(x) ? (state.sort === "bias" ? Math.abs(x) : x) : Infinity; };
    const rows = shown.filter(chosen).sort((p, q) => {
      const x = size(p), y = size(q), order = typeof x === "string" ? x.localeCompare(y) : x === y ? 0 : x < y ? -1 : 1;
      return state.down ? -order : order;
    });
    body.replaceChildren(...rows.map((v) => {
      const e = v.error, cells = {
        total: percent(e.total.rel_rmse), diffuse: percent(e.diffuse.rel_rmse), specular: percent(e.specular.rel_rmse),
        bias: signed(percent(e.total.bias)), relmse: figure(e.total.relmse), mae: figure(e.total.mae), p99: figure(e.total.p99),
        flip: figure(e.total.flip), nonfinite: String(v.nonfinite_pixels),
        time: [withSpread(v.time.ratio_to_point, v.time.ratio_interval),
          known(v.time.net_ratio_to_point) ? h("span", { class: "sub" }, `net ${withSpread(v.time.net_ratio_to_point, v.time.net_ratio_interval)}`) : null] };
      for (const part of SPLIT) cells[part] = known(e.split[part]) ? Number((100 * e.split[part]).toPrecision(2)).toString() : "–";
      for (const gpu of gpus) cells[gpu] = v.isa && v.isa[gpu] ? String(v.isa[gpu].core.cycles) : "–";
      return h("tr", { class: v.within_truth_error ? "tied" : null }, columns.map(([key, title]) => {
        if (key === "name") {
          return h("td", {}, h("button", { type: "button", class: "link", text: v.short_name || v.name, onclick: () => { set({ a: v.name }); scrollToScene(); } }),
            v.within_truth_error ? h("span", { class: "sub", text: "within truth's error, not ranked" }) : null,
            h("details", {}, h("summary", { class: "sub", text: v.summary || "about" }),
              v.name !== v.short_name ? h("span", { class: "sub mono", text: v.name }) : null,
              v.citation ? h("span", { class: "sub", text: v.citation }) : null, v.note ? h("span", { class: "sub", text: v.note }) : null));
        }
        if (key === "max") {
          const at = e.total.max_pixel;
          return h("td", { "data-label": title }, h("span", {}, figure(e.total.max), " ", at ? h("button", { type: "button", class: "link at", text: `(${at[0]}, ${at[1]})`,
            title: "Show this pixel", onclick: () => { set({ a: v.name, b: scene.truth.stem ? TRUTH : state.b, px: at[0], py: at[1] }); zoomTo(8, at[0] + 0.5, at[1] + 0.5); scrollToScene(); } }) : ""));
        }
        return h("td", { "data-label": title, class: key === "nonfinite" && v.nonfinite_pixels ? "bad" : key === "time" ? "time" : null,
          title: costHint(key, v) }, Array.isArray(cells[key]) ? h("span", {}, cells[key]) : cells[key]);
      }));
    }));
  };
  return h("section", {}, h("div", { class: "head" }, h("h3", { text: "Figures against truth" }), h("label", { class: "group sortby" }, h("span", { class: "label", text: "sort by" }), select),
    h("p", { class: "note", text: `Total, diffuse and specular are relative RMSE; MAE, p99 and max are in ${s.unit || "the scene's unit"}.${gpus.length ? ` ${gpus.join(", ")}: cycles per wave of 64, of the technique alone, estimated by the GPU's compiler; nothing was run.` : ""} Choose a heading to sort, a pixel to go there.` })),
    h("div", { class: "card" }, h("table", { class: "metrics" }, h("thead", {}, head), body)));
}

// Of each variant three maps: whose error it is. Their pixels come ready-made: half floats do not hold a rounding error.
function buildSplit(s) {
  const split = variantsOf(s).filter((v) => known(v.error.split.rounding));
  if (!split.length) return null;
  const said = { model: "ideal form against truth", approximation: "double against ideal form", rounding: "float against double" };
  const scale = (color) => h("span", { class: "split-bar", style: { background: `linear-gradient(90deg, ${Array.from({ length: 17 }, (_, i) => css(color(i / 16))).join(", ")})` } });
  const file = (v, part) => `images/${encodeURIComponent(s.folder)}/${encodeURIComponent(v.stem)}-${part}.png`;
  const causes = split.filter((v) => v.error.split.causes.length);
  return h("section", { id: "split", "aria-labelledby": "split-heading" },
    h("div", { class: "head" }, h("h3", { id: "split-heading", text: "Whose error it is" }),
      h("p", { class: "note" }, "The mathematics', its shortcuts', rounding's: relative to the reference, the largest of each few pixels. ", h("span", { class: "unbroken" }, "1e-7 ", scale(magnitudeColor), " 1"))),
    h("div", { class: "split card" }, split.map((v) => h("div", {}, h("b", { text: v.short_name || v.name }),
      SPLIT.map((part) => h("figure", {}, h("img", { src: file(v, part), loading: "lazy", alt: `${part} error of ${v.short_name || v.name}` }),
        h("figcaption", { text: `${part}: ${Number((100 * v.error.split[part]).toPrecision(2))} % (${said[part]})` })))))),
    causes.length ? h("div", { class: "head" }, h("h3", { text: "Cause by cause" }),
      h("p", { class: "note" }, "Of transformed cosines, signed, over the truth: what the fitted lobe misses, its table between the nodes, the horizon as it is treated, the edge's form, the texture's filter, float; and what is left of the whole. The percentages are each picture's root mean square over the truth's, in brackets its sum, and these add up. ",
        h("span", { class: "unbroken" }, "−1 ", scale((t) => signedColor(2 * t - 1)), " 1"), ", logarithmic from 1e-6 on both sides.")) : null,
    causes.length ? h("div", { class: "causes card" }, causes.map((v) => h("div", {}, h("b", { text: v.short_name || v.name }),
      v.error.split.causes.map((cause) => h("figure", {}, h("img", { src: file(v, `cause-${cause.name}`), loading: "lazy", alt: `${cause.name} error of ${v.short_name || v.name}` }),
        h("figcaption", { text: `${cause.name}: ${Number((100 * cause.rel_rmse).toPrecision(2))} % (${signed(Number((100 * cause.bias).toPrecision(2)).toString())})` })))))) : null);
}

function buildPairs(s) {
  if (!s.pairs.length) return null;
  const names = [...(s.truth.stem ? [TRUTH] : []), ...variantsOf(s).sort((p, q) => (p.error.total.rel_rmse ?? Infinity) - (q.error.total.rel_rmse ?? Infinity)).map((v) => v.name)];
  const value = new Map(s.pairs.map((p) => [JSON.stringify([p.a, p.b]), p.rel_rmse]));
  for (const v of variantsOf(s)) value.set(JSON.stringify([v.name, TRUTH]), v.error.total.rel_rmse);
  const matrix = h("div", { class: "matrix vertical", role: "table" });
  ui.cells = [];
  matrix.append(h("span", { class: "corner" }));
  for (const b of names) matrix.append(h("span", { class: "column", text: label(s, b) }));
  for (const a of names.filter((n) => n !== TRUTH)) {
    matrix.append(h("span", { class: "name", text: label(s, a) }));
    for (const b of names) {
      const v = value.get(JSON.stringify([a, b]));
      if (a === b) { matrix.append(h("span", { class: "cell quiet", text: "·" })); continue; }
      const cell = h("button", { type: "button", class: "cell" + hot(v), style: { "--t": heat(v) }, text: percent(v, true),
        title: `${label(s, a)} relative to ${label(s, b)}: ${known(v) ? percent(v) + " %" : "not measured"}`, onclick: () => { set({ a, b }); scrollToScene(); } });
      ui.cells.push({ cell, a, b });
      matrix.append(cell);
    }
  }
  ui.pairMatrix = () => {
    const wide = !matchMedia("(max-width: 720px)").matches;
    matrix.style.gridTemplateColumns = (wide ? "minmax(6rem, 11rem) " : "") + `repeat(${names.length}, minmax(0, 1fr))`;
    matrix.classList.toggle("dense", names.length > (wide ? 34 : 13));  // colour only: figures would not fit
    for (const { cell, a, b } of ui.cells) cell.classList.toggle("chosen", a === state.a && b === state.b);
  };
  return h("section", {}, h("div", { class: "head" }, h("h3", { text: "Every pair" }),
    h("p", { class: "note", text: "Relative RMSE of the row with the column as reference, %. A cell opens the pair." })), h("div", { class: "card" }, matrix));
}

// ---------------------------------------------------------------- accuracy against cost

const ERRORS = [["rel_rmse", "relative RMSE"], ["bias", "bias, without its sign"], ["relmse", "relMSE"], ["mae", "MAE"], ["p99", "p99"], ["max", "max"], ["flip", "FLIP"]];
const inPercent = (metric) => metric === "rel_rmse" || metric === "bias";
const techniqueOf = (name) => name.split(/[+@]/)[0];
const gpusOf = (scenes) => [...new Set(scenes.flatMap((s) => s.variants.flatMap((v) => Object.keys(v.isa || {}))))];

// What a variant's cost can be read as, where some scene has it: value and interval of a variant, how to write it.
function costAxes(scenes) {
  const here = results.software ? ", measured here on a CPU rasteriser, not a GPU" : ", measured here";
  const times = (x) => `${x < 9.95 ? x.toFixed(2) : x.toFixed(1)} × a point light`;
  const axes = [
    { key: "time", title: `time of the lighting pass over point's${here}`, short: "time × point", value: (v) => v.time.ratio_to_point, interval: (v) => v.time.ratio_interval, say: times },
    { key: "net", title: `time over point's, both less reading and writing the G-buffer${here}`, short: "net time × point", value: (v) => v.time.net_ratio_to_point, interval: (v) => v.time.net_ratio_interval, say: times },
  ];
  for (const gpu of gpusOf(scenes)) {
    for (const [part, name] of [["core", "the technique alone"], ["full", "the whole pass"]]) {
      axes.push({ key: part === "core" ? gpu : `${gpu}.${part}`, title: `cycles per wave on ${gpu}, ${name}: estimated by its compiler`, short: `cycles on ${gpu}, ${part === "core" ? "technique" : "pass"}`,
        value: (v) => v.isa && v.isa[gpu] ? v.isa[gpu][part].cycles : null, interval: () => null, say: (x) => `${Math.round(x)} cycles on ${gpu}` });
    }
  }
  return axes.filter((axis) => scenes.some((s) => variantsOf(s).filter((v) => known(axis.value(v))).length > 1));
}

// A variant's place in one scene. What is within truth's error stands at it: nobody knows how much better it is.
function placeIn(s, name, axis) {
  const v = variantNamed(s, name);
  if (!v || !v.stem) return null;
  const limit = s.truth.relative_error, total = state.metric === "rel_rmse" && state.lobe === "total";
  const tied = total && v.within_truth_error && known(limit);
  const error = v.error[state.lobe][state.metric], x = axis.value(v), y = tied ? limit : known(error) ? Math.abs(error) : NaN;
  if (!known(x) || !known(y) || !(x > 0) || !(y > 0)) return null;
  return { x, y, xBar: axis.interval(v), yBar: state.metric === "rel_rmse" && known(limit) ? [Math.max(y - limit, 0), y + limit] : null, tied, variant: v };
}

// The marks of some scenes: of several, geometric means over those that every mark has; who shades fewer than half is left out.
function paretoMarks(scenes, axis) {
  const hidden = new Set(state.off.split(",")), names = [];
  for (const s of scenes) for (const v of variantsOf(s)) if (chosen(v) && !names.includes(v.name) && !hidden.has(techniqueOf(v.name))) names.push(v.name);
  const count = (name) => scenes.filter((s) => placeIn(s, name, axis)).length;
  const kept = names.filter((name) => 2 * count(name) >= scenes.length && count(name) > 0);
  const common = scenes.filter((s) => kept.every((name) => placeIn(s, name, axis)));
  const mean = (values) => Math.exp(values.reduce((sum, v) => sum + Math.log(v), 0) / values.length);
  const marks = common.length === 0 ? [] : kept.map((name) => {
    const places = common.map((s) => placeIn(s, name, axis)), v = places[0].variant, bars = places.map((p) => p.xBar).filter(Boolean);
    const mark = { id: name, label: v.short_name || name, x: mean(places.map((p) => p.x)), y: mean(places.map((p) => p.y)), hollow: /@published$/.test(v.short_name || ""),
      xBar: bars.length === places.length ? [mean(bars.map((b) => b[0])), mean(bars.map((b) => b[1]))] : null, yBar: places.length === 1 ? places[0].yBar : null };
    const spread = mark.xBar ? ` (95 % interval ${mark.xBar.map((x) => figure(x)).join(" to ")})` : "";
    mark.text = `${mark.label}: ${errorText(mark.y)} ${ERRORS.find(([key]) => key === state.metric)[1]}${places.some((p) => p.tied) ? " or less, within truth's own error" : ""}, ${axis.say(mark.x)}${spread}`;
    return mark;
  });
  return { marks, common, left: names.filter((name) => !kept.includes(name)) };
}
const errorText = (y) => inPercent(state.metric) ? percent(y) + " %" : figure(y);

// The frontier in words: who is the cheapest within a bound, and what the next step buys.
function paretoSentences(front, axis, where) {
  if (!front.length) return [];
  const name = (m) => h("b", { text: m.label }), point = front.find((m) => techniqueOf(m.id) === "point"), list = [];
  const cost = (m) => axis.say(m.x) + (m.xBar ? ` (${m.xBar.map((x) => x.toFixed(2)).join(" to ")})` : "") + (point && m !== point && !axis.key.match(/^(time|net)$/) ? `, ${(m.x / point.x).toFixed(1)} × a point light` : "");
  if (inPercent(state.metric)) {
    const bounds = [0.5, 0.25, 0.1, 0.05, 0.02, 0.01, 0.005, 0.001], tightest = new Map();
    for (const bound of bounds) {
      const first = front.find((m) => m.y <= bound);
      if (first) tightest.set(first, bound);
    }
    for (const [m, bound] of tightest) list.push(h("li", {}, `Within ${Number((100 * bound).toPrecision(2))} % of truth ${where}: `, name(m), `, ${cost(m)}.`));
  }
  front.slice(1).forEach((m, i) => {
    const p = front[i], more = m.x / p.x;
    list.push(h("li", {}, "From ", name(p), " to ", name(m), `: ${more < 9.95 ? more.toFixed(2) : more.toFixed(0)} × the cost leaves ${percent(m.y / p.y)} % of the error.`));
  });
  return list;
}

// What the sources say, by source: how many of their claims hold, each list on a page of its own.
function buildClaims() {
  const pages = results.claims || [];
  if (!pages.length) return null;
  const tally = (count, mark, words) => count ? h("span", { class: "tally" }, h("b", { "aria-hidden": "true", text: mark }), ` ${count} ${words}`) : null;
  return h("section", { id: "claims", "aria-labelledby": "claims-heading" },
    h("div", { class: "head" }, h("h3", { id: "claims-heading", text: "What the sources claim" }),
      h("p", { class: "note", text: "Each claim of a source's text in a sentence, our figure beside it, and whether it holds." })),
    h("ul", { class: "claims card" }, pages.map((page) => h("li", {},
      h("a", { href: `claims-${encodeURIComponent(page.source)}.html`, text: page.citation }), h("span", { class: "title", text: page.title }),
      h("span", { class: "tallies" }, tally(page.holds, "✓", page.holds === 1 ? "holds" : "hold"), tally(page.partly, "~", page.partly === 1 ? "holds partly" : "hold partly"),
        tally(page.fails, "✗", page.fails === 1 ? "does not hold" : "do not hold"), tally(page.unknown, "?", "not measured"))))));
}

// The page of the hard cases, or how to make it.
function buildHardCases() {
  const hard = results.hard_cases;
  return h("section", { id: "hard-cases", "aria-labelledby": "hard-heading" },
    h("div", { class: "head" }, h("h3", { id: "hard-heading", text: "Hard cases" }),
      hard ? h("p", { class: "note" }, h("a", { href: "hard-cases.html", text: "Techniques by families" }),
        ` where formulas break: lights at the horizon, in contact, far, thin, mirrors. ${hard.cases.toLocaleString("en")} cases of each of ${hard.techniques} techniques, ` +
        (hard.failures ? `${hard.failures} bounds exceeded.` : "every bound kept."))
        : h("p", { class: "note" }, "Not in this report: ", h("code", { text: "arealab compare --hard-cases" }), " adds the page of techniques by families, ", h("code", { text: "arealab stress --out DIR" }), " writes it alone.")));
}

function buildPareto(scenes, title, where) {
  const axes = costAxes(scenes);
  if (!axes.length) return null;
  const host = h("div", { class: "chart" }), said = h("p", { class: "hovered", role: "status" }), words = h("ul", { class: "words" }), aside = h("p", { class: "note" });
  const cost = h("select", { "aria-label": "Cost", onchange: (e) => set({ cost: e.target.value }) }, axes.map((axis) => h("option", { value: axis.key, text: axis.short })));
  const metric = h("select", { "aria-label": "Error", onchange: (e) => set({ metric: e.target.value }) },
    ERRORS.filter(([key]) => scenes.some((s) => variantsOf(s).some((v) => known(v.error.total[key])))).map(([key, name]) => h("option", { value: key, text: name })));
  const lobe = segments("Lobe of the plot", LOBES.map((l) => [l, l]), state.lobe, (l) => set({ lobe: l }));
  const scale = (axis, key) => segments(`Scale of the ${axis} axis`, [["1", "log"], ["0", "linear"]], state[key] ? "1" : "0", (v) => set({ [key]: v === "1" }));
  const xLog = scale("cost", "xlog"), yLog = scale("error", "ylog");
  const techniques = [...new Set(scenes.flatMap((s) => variantsOf(s).map((v) => techniqueOf(v.name))))];
  const chips = techniques.map((t) => h("button", { type: "button", class: "chip-toggle", "data-technique": t, text: t, onclick: () => {
    const off = new Set(state.off.split(",").filter(Boolean));
    if (!off.delete(t)) off.add(t);
    set({ off: [...off].sort().join(",") });
  } }));
  const section = h("section", { class: "plot" },
    h("div", { class: "head" }, h("h3", { text: title }), h("p", { class: "note", text: "Down and to the left is better. The line joins what nothing beats in both; the rest is grey. Hollow: the form its author published, tied to ours. Bars: 95 % of the measured time, truth's own error. Choose a mark to see its picture." })),
    h("div", { class: "toolbar" }, h("div", { class: "group" }, h("span", { class: "label", text: "cost" }), cost, xLog), h("div", { class: "group" }, h("span", { class: "label", text: "error" }), metric, yLog, lobe),
      h("div", { class: "group" }, h("span", { class: "label", text: "show" }), chips)),
    h("div", { class: "card" }, host, said, words, aside));
  section.refresh = () => {
    const axis = axes.find((a) => a.key === state.cost) || axes[0];
    cost.value = axis.key;
    metric.value = state.metric;
    press(lobe, state.lobe);
    press(xLog, state.xlog ? "1" : "0");
    press(yLog, state.ylog ? "1" : "0");
    const hidden = new Set(state.off.split(","));
    for (const chip of chips) chip.setAttribute("aria-pressed", String(!hidden.has(chip.dataset.technique)));
    const { marks, common, left } = paretoMarks(scenes, axis);
    const rest = "Point at a mark to read it.";
    if (marks.length < 2) {
      host.replaceChildren(h("p", { class: "note", text: "Fewer than two variants have both figures here." }));
      words.replaceChildren();
      said.textContent = "";
    } else {
      const families = new Map();
      for (const m of marks) if (techniqueOf(m.id) === "monte_carlo") families.set("monte_carlo", [...(families.get("monte_carlo") || []), m.id]);
      const limit = scenes.length === 1 && state.metric === "rel_rmse" && state.lobe === "total" && marks.some((m) => m.y <= scenes[0].truth.relative_error) ? scenes[0].truth.relative_error : null;
      const front = window.arealabPareto.draw(host, {
        name: title, marks, links: marks.filter((m) => m.hollow).map((m) => [m.id, techniqueOf(m.id)]), chains: [...families.values()].filter((c) => c.length > 1),
        x: { title: `${axis.short}${state.xlog ? ", logarithmic" : ""}`, log: state.xlog, format: (x) => /^(time|net)$/.test(axis.key) ? `${Number(x.toPrecision(2))}×` : Number(x.toPrecision(3)).toLocaleString("en") },
        y: { title: `${ERRORS.find(([key]) => key === state.metric)[1]}, ${state.lobe}`, log: state.ylog, format: (y) => inPercent(state.metric) ? `${Number((100 * y).toPrecision(2))} %` : figure(y, 2) },
        limit: limit ? { y: limit, text: "truth's own error" } : null,
        onpick: (id) => { const s = common.includes(scene) ? null : common[0]; if (s) location.hash = sceneLink(s.name, { a: id }); else set({ a: id }); scrollToScene(); },
        onhover: (m) => { said.textContent = m ? m.text : rest; },
      });
      said.textContent = rest;
      words.replaceChildren(...paretoSentences(front, axis, where));
    }
    aside.textContent = `Cost: ${axis.title}.` + (scenes.length > 1 && common.length ? ` Geometric means over the ${common.length} scenes that all of these shade: ${common.map((s) => s.name).join(", ")}.` : "") +
      (left.length ? ` Left out, with figures in fewer than half of the scenes: ${left.map((n) => label(scenes.find((s) => variantNamed(s, n)), n)).join(", ")}.` : "") +
      (axis.key === "time" && results.scenes.some((s) => s.variants.some((v) => v.time.net_refusal)) ? " Net times are refused in some scenes: point's own is lost in its spread." : "") + (results.no_isa ? ` No cycles: ${results.no_isa}.` : "");
  };
  return section;
}

// ---------------------------------------------------------------- the two views

function newView(name, wipe) {
  const canvas = h("canvas", {});
  const grip = wipe ? h("div", { class: "grip" }) : null;
  const box = h("div", { class: "view", tabindex: "0", role: wipe ? "slider" : "img", "aria-label": name,
    "aria-valuemin": wipe ? "0" : null, "aria-valuemax": wipe ? "100" : null, "aria-orientation": wipe ? "horizontal" : null, style: { "aspect-ratio": `${scene.width} / ${scene.height}` } }, canvas, grip);
  const view = { box, canvas, grip, wipe };
  box.addEventListener("pointerdown", (e) => startDrag(view, e));
  box.addEventListener("pointermove", (e) => { if (e.pointerType === "mouse" && !e.buttons) pointAt(view, e); });
  box.addEventListener("dblclick", (e) => { const [x, y] = toImage(view, e); zoomTo(state.zoom ? 0 : 4, x, y); });
  box.addEventListener("wheel", (e) => {
    if (!e.ctrlKey && !e.metaKey) return;
    e.preventDefault();
    zoomAbout(view, e, Math.exp(-e.deltaY * 0.01));
  }, { passive: false });
  box.addEventListener("keydown", (e) => viewKey(view, e));
  return view;
}

// Canvas pixels per image pixel, and the image point in the middle.
function placement(view) {
  const { width, height } = view.canvas;
  const fit = width / scene.width;
  const scale = state.zoom > 0 ? state.zoom : fit;
  const half = [width / scale / 2, height / scale / 2];
  const middle = (v, h2, size) => 2 * h2 >= size ? size / 2 : clamp(v, h2, size - h2);
  const x = state.zoom > 0 ? middle(state.x, half[0], scene.width) : scene.width / 2;
  const y = state.zoom > 0 ? middle(state.y, half[1], scene.height) : scene.height / 2;
  // Whole canvas pixels, so that at whole zooms each image pixel is a square of one size.
  return { scale, left: Math.round(width / 2 - x * scale), top: Math.round(height / 2 - y * scale), x, y };
}
function toImage(view, e) {
  const box = view.box.getBoundingClientRect(), p = placement(view), ratio = view.canvas.width / box.width;
  return [((e.clientX - box.left) * ratio - p.left) / p.scale, ((e.clientY - box.top) * ratio - p.top) / p.scale];
}
function pointAt(view, e) {
  const [x, y] = toImage(view, e), px = Math.floor(x), py = Math.floor(y);
  if (px < 0 || py < 0 || px >= scene.width || py >= scene.height || (px === state.px && py === state.py)) return;
  state.px = px;
  state.py = py;
  rememberState();
  drawViews();
  drawValues();
}
function zoomTo(zoom, x, y) {
  const p = placement(ui.left);
  const inside = state.px >= 0 && state.zoom === 0 && x === undefined;
  set({ zoom: clamp(zoom, 0, 64), x: x ?? (inside ? state.px + 0.5 : p.x), y: y ?? (inside ? state.py + 0.5 : p.y) });
}
function zoomAbout(view, e, factor) {
  const p = placement(view), fit = view.canvas.width / scene.width, [x, y] = toImage(view, e);
  const scale = clamp(p.scale * factor, fit, 64);
  if (scale <= fit * 1.001) { set({ zoom: 0 }); return; }
  // The point under the pointer stays there.
  set({ zoom: scale, x: x + (p.x - x) * p.scale / scale, y: y + (p.y - y) * p.scale / scale });
}

const touches = new Map();
function startDrag(view, e) {
  if (e.pointerType === "mouse" && e.button !== 0) return;
  touches.set(e.pointerId, e);
  const box = view.box.getBoundingClientRect(), start = { x: e.clientX, y: e.clientY, cx: placement(view).x, cy: placement(view).y };
  const onLine = view.wipe && Math.abs((e.clientX - box.left) / box.width - state.wipe) * box.width < (e.pointerType === "touch" ? 28 : 14);
  let mode = onLine ? "wipe" : state.zoom > 0 ? "pan" : view.wipe ? "wipe" : "point";
  let moved = false, spread = 0;
  view.box.setPointerCapture(e.pointerId);
  const move = (m) => {
    touches.set(m.pointerId, m);
    if (touches.size === 2) {  // pinch
      const [p, q] = [...touches.values()], now = Math.hypot(p.clientX - q.clientX, p.clientY - q.clientY);
      if (spread > 0) zoomAbout(view, { clientX: (p.clientX + q.clientX) / 2, clientY: (p.clientY + q.clientY) / 2 }, now / spread);
      spread = now;
      moved = true;
      return;
    }
    if (m.pointerId !== e.pointerId) return;
    if (!moved && Math.hypot(m.clientX - start.x, m.clientY - start.y) < 4) return;
    moved = true;
    if (mode === "wipe") {
      view.box.classList.add("wiping");
      set({ wipe: clamp((m.clientX - box.left) / box.width, 0, 1) });
    } else if (mode === "pan") {
      view.box.classList.add("panning");
      const ratio = view.canvas.width / box.width / placement(view).scale;
      set({ x: start.cx - (m.clientX - start.x) * ratio, y: start.cy - (m.clientY - start.y) * ratio });
    } else {
      pointAt(view, m);
    }
  };
  const end = (m) => {
    touches.delete(m.pointerId);
    if (m.pointerId !== e.pointerId) return;
    if (!moved && m.type === "pointerup") pointAt(view, m);
    view.box.classList.remove("wiping", "panning");
    view.box.removeEventListener("pointermove", move);
    view.box.removeEventListener("pointerup", end);
    view.box.removeEventListener("pointercancel", end);
  };
  view.box.addEventListener("pointermove", move);
  view.box.addEventListener("pointerup", end);
  view.box.addEventListener("pointercancel", end);
}

function viewKey(view, e) {
  const step = e.shiftKey ? 10 : 1;
  const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[e.key];
  if (e.ctrlKey || e.metaKey) return;
  if (arrows && view.wipe && !e.altKey && arrows[1] === 0) set({ wipe: clamp(state.wipe + arrows[0] * step / 100, 0, 1) });
  else if (arrows && view.wipe && e.altKey) return;
  else if (arrows) {  // moves the marked pixel
    state.px = clamp((state.px < 0 ? scene.width >> 1 : state.px) + arrows[0] * step, 0, scene.width - 1);
    state.py = clamp((state.py < 0 ? scene.height >> 1 : state.py) + arrows[1] * step, 0, scene.height - 1);
    set(state.zoom > 0 ? { x: state.px + 0.5, y: state.py + 0.5 } : {});
  } else if (e.key === "Home" && view.wipe) set({ wipe: 0 });
  else if (e.key === "End" && view.wipe) set({ wipe: 1 });
  else return;
  e.preventDefault();
  e.stopPropagation();
}

document.addEventListener("keydown", (e) => {
  if (e.ctrlKey || e.metaKey || e.altKey || /^(INPUT|SELECT|TEXTAREA)$/.test(e.target.tagName) || !scene) return;
  const names = variantsOf(scene).map((v) => v.name), at = names.indexOf(state.a), index = results.scenes.indexOf(scene);
  const keys = {
    s: () => set({ a: state.b, b: state.a }),
    m: () => set({ map: state.map === "signed" ? "magnitude" : "signed" }),
    l: () => set({ log: !state.log }),
    1: () => set({ lobe: "total" }), 2: () => set({ lobe: "diffuse" }), 3: () => set({ lobe: "specular" }),
    "+": () => zoomTo(state.zoom ? Math.min(state.zoom * 2, 64) : 2), "-": () => zoomTo(state.zoom > 1 ? state.zoom / 2 : 0), 0: () => zoomTo(0),
    "]": () => set({ a: names[(at + 1) % names.length] }), "[": () => set({ a: names[(at - 1 + names.length) % names.length] }),
    ".": () => { location.hash = sceneLink(results.scenes[(index + 1) % results.scenes.length].name, { lobe: state.lobe }); },
    ",": () => { location.hash = sceneLink(results.scenes[(index - 1 + results.scenes.length) % results.scenes.length].name, { lobe: state.lobe }); },
    e: () => set({ ev: clamp(state.ev + 0.5, -8, 8) }), E: () => set({ ev: clamp(state.ev - 0.5, -8, 8) }),
  };
  if (keys[e.key]) { keys[e.key](); e.preventDefault(); }
});

// ---------------------------------------------------------------- drawing

const painted = { a: { canvas: null, key: "" }, b: { canvas: null, key: "" }, map: { canvas: null, key: "" } };
const range = () => state.range || scene.scale;
const floorOf = () => scene.floor[state.lobe];

function paintAll() {
  const picture = (slot, name) => {
    const image = images.get(name), emission = state.lobe === "total" ? images.get("emission") : null;
    const key = image ? [scene.name, name, state.lobe, state.ev, !!emission].join("\n") : "";
    if (slot.key === key) return;
    slot.key = key;
    slot.canvas = image ? newCanvas(image.width, image.height) : null;
    if (image) paintPicture(slot.canvas, image, emission, state.lobe, scene.exposure + state.ev);
  };
  picture(painted.a, state.a);
  picture(painted.b, state.b);
  const a = images.get(state.a), b = images.get(state.b);
  const key = a && b ? [scene.name, state.a, state.b, state.lobe, state.map, state.log, range()].join("\n") : "";
  if (painted.map.key !== key) {
    painted.map.key = key;
    painted.map.canvas = a && b ? newCanvas(a.width, a.height) : null;
    if (a && b) paintMap(painted.map.canvas, state.map, a, b, state.lobe, floorOf(), range(), state.log);
  }
}

function drawViews() {
  for (const view of [ui.left, ui.right]) {
    const ratio = window.devicePixelRatio || 1;
    const width = Math.max(1, Math.round(view.box.clientWidth * ratio)), height = Math.max(1, Math.round(view.box.clientHeight * ratio));
    if (view.canvas.width !== width || view.canvas.height !== height) { view.canvas.width = width; view.canvas.height = height; }
    const context = view.canvas.getContext("2d"), p = placement(view);
    context.clearRect(0, 0, width, height);
    context.imageSmoothingEnabled = p.scale < 1;
    context.imageSmoothingQuality = "high";
    const put = (source, from, to) => {
      if (!source || to <= from) return;
      context.save();
      context.beginPath();
      context.rect(from, 0, to - from, height);
      context.clip();
      context.drawImage(source, p.left, p.top, scene.width * p.scale, scene.height * p.scale);
      context.restore();
    };
    if (view.wipe) {
      const line = Math.round(state.wipe * width);
      put(painted.a.canvas, 0, line);
      put(painted.b.canvas, line, width);
      view.grip.style.left = `${100 * state.wipe}%`;
      view.box.setAttribute("aria-valuenow", String(Math.round(100 * state.wipe)));
      view.box.setAttribute("aria-valuetext", `${Math.round(100 * state.wipe)} % of ${label(scene, state.a)}, the rest ${label(scene, state.b)}`);
    } else {
      put(painted.map.canvas, 0, width);
    }
    view.box.classList.toggle("zoomed", state.zoom > 0);
    if (state.px >= 0 && state.px < scene.width && state.py < scene.height) {  // the marked pixel
      const size = Math.max(p.scale, 7 * ratio), x = p.left + (state.px + 0.5) * p.scale - size / 2, y = p.top + (state.py + 0.5) * p.scale - size / 2;
      context.lineWidth = ratio;
      context.strokeStyle = "#000";
      context.strokeRect(x - 1.5 * ratio, y - 1.5 * ratio, size + 3 * ratio, size + 3 * ratio);
      context.strokeStyle = "#fff";
      context.strokeRect(x - 0.5 * ratio, y - 0.5 * ratio, size + ratio, size + ratio);
    }
  }
}

function paintScale(canvas, ticks, kind, r, log) {
  const bar = canvas.getContext("2d"), pixels = bar.createImageData(512, 1);
  for (let i = 0; i < 512; ++i) {
    const t = i / 511, color = kind === "signed" ? maps.signed[Math.round((2 * t - 1) * MAP_STEPS) + MAP_STEPS] : maps.magnitude[Math.round(t * MAP_STEPS)];
    pixels.data.set([...color, 255], 4 * i);
  }
  bar.putImageData(pixels, 0, 0);
  const text = (v) => `${Number((100 * v).toPrecision(3))}`;
  let marks = log ? [[1, r], [0.5, r / 10]] : [[1, r], [0.5, r / 2]];
  if (kind === "signed") marks = [...marks.map(([t, v]) => [0.5 - t / 2, -v]), [0.5, log ? r / 100 : 0], ...marks.map(([t, v]) => [0.5 + t / 2, v])];
  else marks = [[0, log ? r / 100 : 0], ...marks];
  ticks.replaceChildren(...marks.map(([t, v]) => {
    const least = log && t === (kind === "signed" ? 0.5 : 0);
    return h("span", { style: { left: `${100 * t}%` }, text: (least ? "< " : v > 0 && kind === "signed" ? "+" : v < 0 ? "−" : "") + text(Math.abs(v)) + " %" });
  }));
}

function drawLegend() {
  paintScale(ui.bar, ui.ticks, state.map, range(), state.log);
  const b = label(scene, state.b), a = label(scene, state.a), f = floorOf();
  ui.legendText.textContent = (state.map === "signed"
    ? `(Y(A) − Y(B)) / max(Y(B), floor), Y luminance: blue where ${a} is darker than ${b}, orange where brighter. `
    : `Largest channel of |A − B| / max(Y(B), floor), Y luminance. `) +
    `Floor ${figure(f)} ${scene.unit || ""}, 1 % of truth's mean.${state.log ? " Logarithmic, two decades." : ""} Beyond the ends: the end's colour.`;
}

function drawValues() {
  const inside = state.px >= 0 && state.px < scene.width && state.py >= 0 && state.py < scene.height;
  ui.where.textContent = inside ? `x ${state.px}, y ${state.py}` : "point at a picture";
  const i = inside ? state.py * scene.width + state.px : 0, truth = images.get(TRUTH), v = [0, 0, 0], t = [0, 0, 0];
  const reference = images.get(state.b) || truth;
  const rows = [h("div", { class: "top" }, h("span"), h("span", { text: state.lobe }), h("span", { class: "num", text: "luminance" }), h("span", { class: "num", text: "vs B" }))];
  for (const name of ui.thumbs.keys()) {
    const image = images.get(name), role = name === state.a ? " is-a" : name === state.b ? " is-b" : "";
    const swatch = h("span", { class: "swatch" });
    let value = "…", relative = "";
    if (!inside) value = "–";
    else if (image) {
      radiance(image, state.lobe, i, v);
      const gain = 2 ** (scene.exposure + state.ev);
      const emission = state.lobe === "total" ? images.get("emission") : null;
      swatch.style.background = finite3(v) ? css([0, 1, 2].map((c) => srgbTable[Math.round(clamp((v[c] + (emission ? halfTable[emission.planes[c][i]] * emission.scale : 0)) * gain, 0, 1) * SRGB_STEPS)])) : css(NONFINITE);
      value = finite3(v) ? figure(luminance(v), 4) : "NaN";
      if (reference && name !== state.b) {
        const d = difference("signed", v, radiance(reference, state.lobe, i, t), floorOf());
        relative = d === undefined ? "unlit" : Number.isNaN(d) ? "NaN" : signed(percent(d)) + " %";
      }
    }
    rows.push(h("div", { class: "row" + role, "data-variant": name, title: inside && image ? `R ${figure(radiance(image, state.lobe, i, v)[0], 5)}, G ${figure(v[1], 5)}, B ${figure(v[2], 5)} ${scene.unit}` : null, onclick: () => set({ a: name }) },
      swatch, h("span", { class: "who", text: breakable(label(scene, name)) }), h("span", { class: "num", text: value }), h("span", { class: "num", text: relative })));
  }
  ui.values.replaceChildren(...rows);
}

function drawThumbs() {
  for (const [name, thumb] of ui.thumbs) {
    const v = variantNamed(scene, name);
    thumb.box.classList.toggle("is-a", name === state.a);
    thumb.box.classList.toggle("is-b", name === state.b);
    thumb.error.textContent = name === SHADOWED ? "not ranked" : name === TRUTH ? (known(scene.truth.relative_error) ? `± ${percent(scene.truth.relative_error)} %` : "") : known(v.error[state.lobe].rel_rmse) ? percent(v.error[state.lobe].rel_rmse) + " %" : v.nonfinite_pixels ? "non-finite" : "–";
    const pictures = state.thumbs === "pictures" && state.lobe === "total" && state.ev === 0;
    thumb.picture.hidden = !pictures;
    thumb.map.hidden = pictures;
    if (pictures) continue;
    const image = images.get(name), truth = images.get(TRUTH);
    if (!image || (state.thumbs !== "pictures" && !truth)) continue;
    const key = [scene.name, state.thumbs, state.lobe, state.thumbs === "pictures" ? state.ev + !!images.get("emission") : [state.log, range()]].join("\n");
    if (thumb.painted === key) continue;
    thumb.painted = key;
    if (state.thumbs === "pictures") paintPicture(thumb.map, image, state.lobe === "total" ? images.get("emission") : null, state.lobe, scene.exposure + state.ev);
    else paintMap(thumb.map, state.thumbs, image, truth, state.lobe, floorOf(), range(), state.log);
  }
}

let framed = false;
function draw() {
  if (framed) return;
  framed = true;
  requestAnimationFrame(() => { framed = false; drawNow(); });
}
function drawNow() {
  if (!scene) return;
  ui.a.value = state.a;
  ui.b.value = state.b;
  press(ui.lobe, state.lobe);
  press(ui.map, state.map);
  press(ui.log, state.log ? "1" : "0");
  press(ui.zoom, String(state.zoom));
  press(ui.thumbMode, state.thumbs);
  ui.range.value = String(state.range);
  if (ui.range.selectedIndex < 0) ui.range.value = "0";
  ui.ev.value = String(state.ev);
  ui.evText.textContent = `${signed(state.ev.toFixed(2).replace(/\.?0+$/, "") || "0")} EV`;
  ui.leftA.replaceChildren(h("span", { class: "tag a", text: "A" }), label(scene, state.a));
  ui.leftB.replaceChildren(label(scene, state.b), h("span", { class: "tag b", text: "B" }));
  ui.rightText.replaceChildren(`${label(scene, state.a)} relative to ${label(scene, state.b)}, ${state.lobe}`);
  paintAll();
  drawViews();
  drawLegend();
  drawValues();
  drawThumbs();
  drawShadow();
}

function drawShadow() {
  const truth = images.get(TRUTH), shadowed = images.get(SHADOWED), key = `${scene.name} ${state.lobe}`;
  if (!ui.shadow || !truth || !shadowed || ui.shadow.painted === key) return;
  ui.shadow.painted = key;
  paintMap(ui.shadow.map, "signed", truth, shadowed, state.lobe, floorOf(), SHADOW_RANGE, true);
}

function set(changes) {
  const before = { ...state };
  Object.assign(state, changes);
  rememberState();
  draw();
  if (before.sort !== state.sort || before.down !== state.down || before.source !== state.source) ui.table();
  if (before.lobe !== state.lobe || before.source !== state.source) overview.refresh();
  if (fit && (before.fit !== state.fit || before.fitbrdf !== state.fitbrdf)) fit.refresh();
  if (["source", "lobe", "cost", "metric", "xlog", "ylog", "off"].some((key) => before[key] !== state[key])) drawPlots();
  if ((before.a !== state.a || before.b !== state.b) && ui.pairMatrix) ui.pairMatrix();
}

function drawPlots() {
  if (ui.plot) ui.plot.refresh();
  if (overallPlot) overallPlot.refresh();
}

// Loads the scene's images, those on the stage first.
async function loadScene(mine) {
  document.documentElement.removeAttribute("data-ready");
  const wanted = [...new Set([state.a, state.b, TRUTH, "emission", SHADOWED, ...variantsOf(scene).map((v) => v.name)])];
  let done = 0;
  for (const name of wanted) {
    const stem = name === TRUTH ? scene.truth.stem : name === SHADOWED ? (shadowOf(scene) || {}).stem : name === "emission" ? (scene.emission ? "emission" : null) : (variantNamed(scene, name) || {}).stem;
    if (!stem) continue;
    try {
      const image = await load(scene.folder, stem);
      if (mine !== generation) return;
      images.set(name, image);
      ++done;
      ui.busy.textContent = `Loading ${done} of ${wanted.length} …`;
      draw();
    } catch (error) {
      if (mine !== generation) return;
      loaded.delete(`${scene.folder}/${stem}`);
      ui.busy.textContent = String(error.message || error);
      document.documentElement.dataset.failed = String(error.message || error);
      return;
    }
  }
  ui.busy.hidden = true;
  drawNow();
  document.documentElement.dataset.ready = scene.name;
}

let shown = null;
const recent = [];
const overview = buildOverview();
const overallPlot = results.scenes.length > 1 ? buildPareto(results.scenes, "Accuracy against cost over the scenes", "over these scenes") : null;
if (overallPlot) overview.append(overallPlot);
const claims = buildClaims();
if (claims) overview.append(claims);
overview.append(buildHardCases());
function show() {
  readHash();
  settle();
  if (!scene) { $("#main").append(h("p", { class: "notice", text: "This report holds no scene." })); return; }
  overview.refresh();
  if (shown !== scene) {
    shown = scene;
    const mine = ++generation;
    images = new Map();
    for (const slot of Object.values(painted)) slot.key = "-";
    delete ui.pairMatrix;
    const section = buildScene();
    const old = $("#scene");
    if (old) old.replaceWith(section);
    else $("#overview").after(section);
    resizes.disconnect();
    resizes.observe(ui.left.box);
    // Decoded images of two scenes are kept, about 35 MB each; older ones are read again when needed.
    const at = recent.indexOf(scene);
    if (at >= 0) recent.splice(at, 1);
    recent.push(scene);
    if (recent.length > 2) {
      const gone = recent.shift();
      for (const key of [...loaded.keys()]) if (key.startsWith(gone.folder + "/")) { loaded.delete(key); waiting.delete(key); }
    }
    document.title = `${scene.name} · AreaLab report`;
    loadScene(mine);
  }
  ui.table();
  if (ui.pairMatrix) ui.pairMatrix();
  drawPlots();
  drawNow();
}

const TERMS = [
  ["Reading an error map", "Black is right. In the signed map blue is too dark and orange too bright; in the magnitude map the paler, the further off, in either direction and in any channel. All maps of a scene share one printed scale, so two of them may be compared by eye; between scenes read the ticks."],
  ["Relative difference", "(A − B) divided by B's luminance, or by the floor where B is darker than that: 1 % of the truth's mean luminance over the pixels it lights. Without a floor, the darkest pixels would shout loudest."],
  ["Relative RMSE", "√(Σ(a−b)² / Σb²) over the RGB values of all pixels that truth or the variant lights. It weighs bright pixels most: highlights decide."],
  ["Bias", "Σ(a−b) / Σb: the share of light that is too much (+) or missing (−)."],
  ["relMSE", "Mean of (a−b)² / (b² + ε), ε = (1 % of the truth's mean luminance)²: dark and bright pixels count alike."],
  ["MAE, p99, max", "Mean absolute difference; the largest channel's difference that 99 % of the pixels stay below; and the largest of all, with its pixel."],
  ["FLIP", "HDR-FLIP at 67 pixels per degree: 0 where a viewer who flips between two pictures sees nothing, 1 for the strongest difference; mean over the picture."],
  ["Truth's own error", "Ground truth is integrated too, and estimates its own relative error. A variant whose error is below four times that is within truth's error: its place in the ranking would be chance, so it has none."],
  ["Time", "Time of the lighting pass alone as a ratio to the point variant, in interleaved rounds, with half the width of its 95 % interval. Net: both less a pass that only reads the G-buffer and writes it through; refused where point's net time is within three times its spread."],
  ["Cycles", "Of a wave of 64 pixels on one SIMD of a GPU that is not here, as Mesa's compiler for it counts them: estimated from the instructions, nothing was run. Memory and divergence are not in them. The technique alone has its inputs as varyings and uniforms; the whole pass reads the G-buffer. Both are of a lit pixel; of text that branches on the horizon it is the compiler's average over the paths, which discounts what may be skipped (point at a figure in the table for each path)."],
  ["Accuracy against cost", "The frontier joins the variants that no other beats in both error and cost. Over several scenes a mark is the geometric mean over the scenes that every variant shown can shade."],
  ["Published and default", "name@published is the form its author published; the plain name is the best form we know. Both are shown, so that nobody is judged by our changes or robbed of theirs."],
  ["Emitters", "Lights seen directly are added to the pictures and are part of no metric and no map. Techniques cast no shadows, and neither does the truth they are ranked against, but where a scene asks for apertures: there both have visibility."],
  ["Truth, shadowed", "What the lights do past the scene's surfaces, by rays: the unshadowed integrals times the visible share. Lights hide nothing themselves. It stands beside truth as a picture like any other, in no ranking; the missing shadow is its own map."],
  ["Files", "data/ holds what this page shows, as half floats that are rounded to keep the folder small: truth in steps of 0.8 %; differences to it as finely as halves hold them, but below a quarter of the truth's mean luminance (four times it in finely textured scenes) to the step that halves have there, and a variant's values to an eighth of its own relative RMSE, in steps of at most 0.8 %; shadowed truth in steps of 1.6 %, less than its own error. images/SCENE/VARIANT.exr is for other viewers: the layers diffuse and specular (one Y channel where a layer is grey), compressed by DWA, which moves values by 0.1 to 0.5 % in the mean, single dark ones beside sharp edges by up to a quarter; arealab render writes full floats. .png is a small picture at the scene's exposure. Every metric was computed from the full floats."],
];

// How far the built-in tables' lobes are from the BRDFs', over roughness and view angle.
const FIT_METRICS = [["polygon", "polygons"], ["lobe", "lobe"], ["below", "below horizon"]];
const FIT_KINDS = [["polygon", "ours: fitted on polygons (fit=polygon)"], ["l3", "the published kind: |difference|³ of the density (fit=l3)"], ["cosine", "ours, beside a share of the cosine lobe (lobes=cosine)"], ["two", "ours, two lobes (lobes=two)"], ["horizon", "ours, for a second clip at the surface's horizon (horizon=true)"]];
const FIT_NOTES = {
  polygon: (map) => `Relative RMSE of a polygon light's specular integral, ${map.rectangles} rectangles (seed ${map.seed}): centres at distance 1, uniform over the upper hemisphere, turned at random, half sides log-uniform from 0.1 to 2, clipped at the horizon.`,
  lobe: () => "Relative L1 distance of the lobe, above the surface's horizon: the integral of |BRDF × cosine − fitted lobe| over that of BRDF × cosine, Fresnel 1, every direction weighted alike.",
  below: () => "The share of the fitted lobe that lies below the surface's horizon, where the BRDF has none: light from below that shows as impossible reflections (with horizon=true it is clipped away).",
};
function buildFit() {
  const maps = results.fit || [];
  if (!maps.length) return null;
  const brdfs = [...new Set(maps.map((m) => m.brdf))];
  const brdf = h("select", { "aria-label": "BRDF", onchange: (e) => set({ fitbrdf: e.target.value }) }, brdfs.map((b) => h("option", { value: b, text: b.replaceAll("_", " ") })));
  const metric = segments("Measure of the fit", FIT_METRICS, state.fit, (m) => set({ fit: m }));
  const note = h("p", { class: "note" }), grids = h("div", { class: "fits" });
  const section = h("section", { id: "fit", "aria-labelledby": "fit-heading" },
    h("div", { class: "head" }, h("h2", { id: "fit-heading", text: "How well the lobes are fitted" }), metric, h("label", { class: "field" }, "BRDF ", brdf), note), grids);
  section.refresh = () => {
    press(metric, state.fit);
    brdf.value = state.fitbrdf;
    const shown = FIT_KINDS.map(([kind, title]) => [maps.find((m) => m.brdf === state.fitbrdf && m.table.endsWith("_" + kind)), title]).filter(([m]) => m);
    note.textContent = `${FIT_NOTES[state.fit](shown[0][0])} Look-up as in the shader, between the nodes of the table. In percent; colours by decades from 0.01 to 100 %.`;
    grids.replaceChildren(...shown.map(([map, title]) => {
      const grid = h("div", { class: "fit-grid", role: "img", "aria-label": `${title}: roughness by view angle`, style: { "--columns": map.degrees.length } });
      grid.append(h("span"), ...map.degrees.map((d) => h("span", { class: "tick", text: `${d}°` })));
      map.roughness.forEach((r, row) => grid.append(h("span", { class: "tick row", text: String(r) }), ...map.degrees.map((d, column) => {
        const v = map[state.fit][row * map.degrees.length + column];
        return h("span", { class: "cell" + hot(v), style: { "--t": heat(v) }, title: `roughness ${r}, view ${d}°: ${percent(v)} %`, text: percent(v, true) });
      })));
      return h("figure", { class: "card" }, h("figcaption", { text: title }), grid, h("p", { class: "axes", text: "down: roughness (alpha = roughness²); across: angle of the view from the normal" }));
    }));
  };
  return section;
}

// What simulating only the effects that scenes call for saves: the pruned program over the one with every effect, and what asking each pixel
// costs over that.
function savingOf(v, key, way) {
  const saving = v && v.saving && (way === "pruned" ? v.saving : (v.saving.per_pixel || {})[way]);
  if (!saving) return null;
  if (key === "time") return saving.time_ratio;
  if (way !== "pruned") return saving.cycles_ratio[key] ?? null;
  const cycles = saving.cycles[key];
  return cycles ? cycles.pruned / cycles.every_effect : null;
}
function savingHint(v, key, way) {
  const saving = way === "pruned" ? v.saving : v.saving.per_pixel[way];
  if (key === "time") return saving.interval ? `95 % interval ${saving.interval.map((x) => x.toFixed(2)).join(" to ")}, ${v.saving.rounds} rounds` : "";
  if (way !== "pruned") return "estimated from how many tiles are of which class";
  const cycles = v.saving.cycles[key];
  return cycles ? `${cycles.pruned} of ${cycles.every_effect} cycles` : "";
}
// Where a way of asking pixels pays, in a sentence a renderer.
function whatPays(scenes) {
  const said = ["time", ...gpusOf(scenes)].map((key) => {
    const counts = [["tiles", "tiles"], ["branch", "a branch"]].map(([way, name]) => {
      const asked = scenes.flatMap((s) => s.variants).filter((v) => known(savingOf(v, key, way)));
      const pays = asked.filter((v) => { const of = v.saving.per_pixel[way]; return key === "time" ? of.interval && of.interval[1] < 1 : savingOf(v, key, way) < 1; });
      return asked.length ? `${name} in ${pays.length} of ${asked.length}` : null;
    }).filter(Boolean);
    return counts.length ? `${key === "time" ? "here" : "on " + key} ${counts.join(", ")}` : null;
  }).filter(Boolean);
  return said.length ? `Asking each pixel what it needs pays, of variants and scenes: ${said.join("; ")}; elsewhere one program is cheaper.` : "";
}
const TILE_CLASSES = [["black: no light faces it", [38, 38, 46]], ["lights clear of every horizon", [120, 190, 170]], ["a light's stand-in may cross it", [235, 200, 110]], ["a light may cross it", [205, 95, 75]]];
function tilePicture(s) {
  const { columns, needs, bits, size } = s.tiles, canvas = h("canvas", { class: "tiles" });
  canvas.width = columns; canvas.height = needs.length / columns;
  const image = new ImageData(canvas.width, canvas.height), counts = new Map();
  for (let i = 0; i < needs.length; ++i) {
    const n = needs.charCodeAt(i) - 65, kind = !(n & bits.light) ? 0 : n & bits.horizon ? 3 : n & bits.proxy_horizon ? 2 : 1;
    const lacks = kind ? ["diffuse", "specular"].filter((lobe) => s.effects.includes(lobe) && !(n & bits[lobe])) : [];
    const name = TILE_CLASSES[kind][0] + lacks.map((lobe) => `, no ${lobe}`).join(""), color = TILE_CLASSES[kind][1].map((c) => lacks.length ? Math.round(c * 0.62) : c);
    image.data.set([...color, 255], 4 * i);
    counts.set(name, { color, count: (counts.get(name) || { count: 0 }).count + 1 });
  }
  canvas.getContext("2d").putImageData(image, 0, 0);
  canvas.setAttribute("role", "img");
  canvas.setAttribute("aria-label", `tiles of ${size} pixels of ${s.name} by what they need`);
  return h("figure", {}, canvas, h("figcaption", {}, h("b", { text: s.name }), [...counts].sort((a, b) => b[1].count - a[1].count).map(([name, c]) =>
    h("span", {}, h("i", { style: { background: `rgb(${c.color})` } }), `${name} ${Math.round(100 * c.count / needs.length)} %`))));
}
function buildSavings() {
  const scenes = results.scenes.filter((s) => s.variants.some((v) => v.saving));
  if (!scenes.length) return null;
  const names = [...new Map(scenes.flatMap((s) => variantsOf(s).map((v) => [v.name, v.short_name || v.name])))];
  let key = "time", way = "pruned";
  const measures = segments("Saved in", [["time", "time here"], ...gpusOf(scenes).map((gpu) => [gpu, `cycles on ${gpu}`])], key, (k) => { key = k; refresh(); });
  const ways = segments("Saved by", [["pruned", "the scene's effects"], ["tiles", "tiles"], ["branch", "a branch"]], way, (w) => { way = w; refresh(); });
  const matrix = h("div", { class: "matrix vertical" + (scenes.length > 14 ? " many" : ""), role: "table" });
  const mean = (variants) => {
    const logs = variants.map((v) => savingOf(v, key, way)).filter((x) => x > 0).map(Math.log);
    return h("span", { class: "cell quiet", text: logs.length ? Math.exp(logs.reduce((sum, x) => sum + x, 0) / logs.length).toFixed(2) : "–" });
  };
  const refresh = () => {
    press(measures, key);
    press(ways, way);
    const wide = !matchMedia("(max-width: 720px)").matches;
    matrix.style.gridTemplateColumns = (wide ? "minmax(7rem, 15rem) " : "") + `repeat(${scenes.length + 1}, minmax(0, 1fr))`;
    matrix.replaceChildren(h("span", { class: "corner" }), ...scenes.map((s) => h("span", { class: "column", text: s.name })), h("span", { class: "column", text: "mean" }));
    for (const [name, shown] of names) {
      const variants = scenes.map((s) => variantNamed(s, name));
      matrix.append(h("span", { class: "name", text: shown }), ...variants.map((v, i) => {
        const x = savingOf(v, key, way);
        return known(x) ? h("span", { class: "cell" + (x > 0.8 ? " hottest" : x > 0.6 ? " hot" : ""), style: { "--t": clamp(x, 0, 1) }, text: x.toFixed(2), title: `${scenes[i].name}, ${shown}: ${savingHint(v, key, way)}` })
          : h("span", { class: "cell none", text: "–" });
      }), mean(variants));
    }
    matrix.append(h("span", { class: "rule" }), h("span", { class: "name", text: "mean" }), ...scenes.map((s) => mean(s.variants)), mean(scenes.flatMap((s) => s.variants)));
  };
  const tiled = scenes.filter((s) => s.tiles);
  const section = h("section", { id: "savings", "aria-labelledby": "savings-heading" },
    h("div", { class: "head" }, h("h2", { id: "savings-heading", text: "What only the needed effects cost" }), ways, measures,
      h("p", { class: "note", text: "The lighting pass with the effects that the scene calls for, over the same pass with every effect, which draws the same picture; means are geometric. The paler the cell, the more is saved. The command arealab explain prices each effect of a scene by itself." }),
      h("p", { class: "note", text: "Tiles and a branch ask in each picture anew which pixels may do without the horizon, a lobe, or any light; they are set over the program that the scene calls for, and what it costs to ask is in them. " + whatPays(scenes) })),
    h("div", { class: "card" }, matrix),
    tiled.length ? h("div", { class: "card tile-pictures" }, tiled.map(tilePicture)) : null);
  section.refresh = refresh;
  return section;
}

function buildGlossary() {
  const keys = [["s", "swap A and B"], ["1 2 3", "total, diffuse, specular"], ["m", "signed or magnitude"], ["l", "linear or log"], ["[ ]", "previous, next variant"], [", .", "previous, next scene"], ["+ − 0", "zoom in, out, fit"], ["e E", "exposure up, down"]];
  return h("section", { id: "glossary" }, h("div", { class: "head" }, h("h2", { text: "How to read this page" })),
    h("dl", { class: "glossary" }, TERMS.map(([term, text]) => h("div", {}, h("dt", { text: term }), h("dd", { text }))),
      h("div", {}, h("dt", { text: "Keys" }), keys.map(([key, text]) => h("dd", {}, h("kbd", { text: key }), " ", text)))));
}

function buildFooter() {
  const rows = [["command", results.command], ["context", [results.platform, results.gl_version].filter(Boolean).join(", OpenGL ")], ["renderer", results.renderer + (results.software ? " (CPU rasteriser, not a GPU)" : "")],
                ["AreaLab", results.version], ["made", results.date], ...Object.entries(results.machine || {})];
  $("#footer").append(h("h2", { text: "How this was made" }),
    h("dl", { class: "machine" }, rows.filter((r) => r[1]).flatMap(([key, value]) => [h("dt", { text: key }), h("dd", { class: key === "command" ? "mono" : null, text: value })])),
    h("p", { style: { "margin-top": "1rem" } }, "Figures for programs: ", h("a", { href: "results.json", text: "results.json" }), ", ", h("a", { href: "results.csv", text: "results.csv" }), "."));
}

const resizes = new ResizeObserver(() => { if (scene && shown) { overview.refresh(); if (ui.pairMatrix) ui.pairMatrix(); drawPlots(); draw(); } });
buildMasthead();
const savings = buildSavings(), fit = buildFit();
$("#main").append(...[overview, savings, fit, buildGlossary()].filter(Boolean));
for (const section of [savings, fit]) if (section) section.refresh();
buildFooter();
show();
addEventListener("hashchange", show);

// For tests: the state, and what a pixel of the map is made of.
window.arealab = { state, set, results,
  pixel: (x, y) => {
    const i = y * scene.width + x, a = radiance(images.get(state.a), state.lobe, i, [0, 0, 0]), b = radiance(images.get(state.b), state.lobe, i, [0, 0, 0]);
    const d = difference(state.map, a, b, floorOf()), box = ui.right.canvas.getBoundingClientRect(), p = placement(ui.right);
    const cx = Math.floor(p.left + (x + 0.5) * p.scale), cy = Math.floor(p.top + (y + 0.5) * p.scale);
    return { a, b, difference: d === undefined ? null : Number.isNaN(d) ? "NaN" : d, range: range(), floor: floorOf(), width: box.width,
             color: [...ui.right.canvas.getContext("2d").getImageData(cx, cy, 1, 1).data].slice(0, 3) };
  },
  pictureAt: (fx, fy) => [...ui.left.canvas.getContext("2d").getImageData(Math.floor(fx * ui.left.canvas.width), Math.floor(fy * ui.left.canvas.height), 1, 1).data].slice(0, 3),
};
})();

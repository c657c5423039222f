#!/usr/bin/python3
"""The report's page in headless Chromium, opened from disk.

usage: report_page_test.py COMPARE_TESTS FOLDER
COMPARE_TESTS writes the sample report (Report.WritesTheSampleForThePageTest) to FOLDER first.
"""
import base64
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from urllib.parse import quote

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait

FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
         "--disable-component-update", "--disable-sync", "--force-device-scale-factor=1", "--hide-scrollbars"]
PROGRAM = FOLDER = None


# The maps' colours, written again from their definition in the page's glossary of formulas (report.js, "colour").
def srgb(v):
    return 12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055


def oklch(lightness, chroma, hue):
    def linear(c):
        a, b = c * math.cos(math.radians(hue)), c * math.sin(math.radians(hue))
        l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3
        m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3
        s = (lightness - 0.0894841775 * a - 1.2914855480 * b) ** 3
        return [4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
                -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
                -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s]
    low, high = 0.0, chroma
    inside = lambda c: all(-1e-6 <= v <= 1 + 1e-6 for v in linear(c))
    if inside(chroma):
        low = chroma
    else:
        for _ in range(24):
            middle = (low + high) / 2
            low, high = (middle, high) if inside(middle) else (low, middle)
    return [round(255 * srgb(min(max(v, 0), 1))) for v in linear(low)]


def map_color(kind, difference, scale, log):
    u = abs(difference) / scale
    t = (max(0, min(1, (math.log10(u) + 2) / 2)) if u > 0 else 0) if log else min(u, 1)
    t = round(t * 512) / 512
    if kind == "signed":
        chroma = 0.17 * t ** 0.55 * (1 - 0.4 * t * t)
        return oklch(0.17 + 0.73 * t, chroma, 262 - 42 * t if difference < 0 else 50 + 40 * t)
    return oklch(0.14 + 0.83 * t, 0.205 * math.sin(math.pi * (0.1 + 0.78 * t)), 288 + 174 * t)


class Page(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        shutil.rmtree(FOLDER, ignore_errors=True)
        FOLDER.mkdir(parents=True)
        subprocess.run([PROGRAM, "--gtest_filter=Report.WritesTheSampleForThePageTest", "--gtest_brief=1"], check=True,
                       env={**os.environ, "AREALAB_REPORT_SAMPLE": str(FOLDER)})
        cls.expected = json.loads((FOLDER / "expected.json").read_text())
        cls.results = json.loads((FOLDER / "report/results.json").read_text())
        cls.profile = tempfile.mkdtemp(prefix="arealab-chromium-")
        options = Options()
        options.binary_location = "/usr/bin/chromium"
        for flag in [*FLAGS, f"--user-data-dir={cls.profile}"]:
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        cls.driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        cls.driver.set_script_timeout(60)

    @classmethod
    def tearDownClass(cls):
        cls.driver.quit()
        shutil.rmtree(cls.profile, ignore_errors=True)

    def setUp(self):
        self.size(1280)

    def tearDown(self):
        # Whatever a test did, the console stayed empty and no injected text ran.
        # That reading pixels back is slow is said of these tests: the page itself never does.
        messages = [m for m in self.driver.get_log("browser")
                    if m["level"] in ("SEVERE", "WARNING") and "willReadFrequently" not in m["message"]]
        self.assertEqual(messages, [])
        self.assertIsNone(self.js("return window.injected ?? null"))

    def js(self, code, *arguments):
        return self.driver.execute_script(code, *arguments)

    def size(self, width, height=900):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                    {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})

    def open(self, fragment=""):
        self.driver.get("about:blank")
        self.driver.get((FOLDER / "report/index.html").as_uri() + fragment)
        self.wait_ready()

    def wait_ready(self):
        WebDriverWait(self.driver, 30, 0.02).until(lambda d: self.js(
            "const s = document.documentElement.dataset; return s.failed || s.ready === window.arealab.state.scene"))
        self.assertIsNone(self.js("return document.documentElement.dataset.failed ?? null"))

    def settle(self):
        self.driver.execute_async_script("const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => done()))")

    def set(self, **changes):
        self.js("window.arealab.set(arguments[0])", changes)
        self.settle()

    def text(self, selector):
        return self.driver.find_element(By.CSS_SELECTOR, selector).text

    def test_every_image_loads(self):
        for scene in self.results["scenes"]:
            self.open("#scene=" + quote(scene["name"], safe=""))
            broken = self.driver.execute_async_script("""
                const done = arguments[0], images = [...document.images];
                Promise.all(images.map((i) => i.decode().then(() => null, () => i.src)))
                  .then((list) => done([images.length, list.filter(Boolean)]));""")
            shadow = scene["truth"]["shadow"]
            shaded = sum(v["supported"] for v in scene["variants"]) + 1 + bool(shadow and shadow["present"])
            self.assertEqual(broken, [shaded, []])

    def test_nothing_is_fetched_from_elsewhere(self):
        self.open()
        names = self.js("return performance.getEntriesByType('resource').map((e) => e.name)")
        self.assertEqual([n for n in names if not n.startswith(("file:", "data:"))], [])

    def test_map_pixels_equal_the_stored_values(self):
        self.open()
        distinct = set()
        for e in self.expected:
            for kind in ("signed", "magnitude"):
                log = (e["x"] + e["y"]) % 2 == 0
                self.set(a=e["a"], b=e["b"], lobe=e["lobe"], map=kind, log=log, zoom=4, x=e["x"], y=e["y"], px=0, py=0)
                shown = self.js("return window.arealab.pixel(arguments[0], arguments[1])", e["x"], e["y"])
                self.assertAlmostEqual(shown["floor"], e["floor"], delta=1e-6 * e["floor"])
                self.assertAlmostEqual(shown["difference"], e[kind], delta=1e-6 + 1e-5 * abs(e[kind]), msg=str(e))
                color = map_color(kind, e[kind], shown["range"], log)
                for ours, theirs in zip(color, shown["color"]):
                    self.assertLessEqual(abs(ours - theirs), 3, msg=f"{e} {kind} {color} {shown}")  # a table step is at most 3 codes
                distinct.add(tuple(shown["color"]))
        self.assertGreater(len(distinct), 20)

    def test_wipe_moves_by_mouse_and_keys(self):
        self.open("#a=point&b=truth")
        view = self.driver.find_element(By.CSS_SELECTOR, "#pictures .view")
        self.js("arguments[0].scrollIntoView({block: 'center'})", view)
        # One column of the visible canvas, right of the middle: B before, A once the wipe has passed it.
        column = """const c = document.querySelector('#pictures canvas'), x = Math.floor(0.7 * c.width);
                    return [...c.getContext('2d').getImageData(x, 0, 1, c.height).data]"""
        before = self.js(column)
        width = view.size["width"]
        ActionChains(self.driver, duration=0).move_to_element(view).click_and_hold().move_by_offset(5, 0).move_by_offset(
            int(0.4 * width) - 5, 0).release().perform()
        self.settle()
        self.assertAlmostEqual(self.js("return window.arealab.state.wipe"), 0.9, delta=0.01)
        after = self.js(column)
        self.assertNotEqual(before, after)
        self.assertIn(str(self.js("return Math.round(100 * window.arealab.state.wipe)")), view.get_attribute("aria-valuenow"))
        wipe = self.js("return window.arealab.state.wipe")
        self.js("arguments[0].focus()", view)
        view.send_keys(Keys.ARROW_LEFT)
        self.settle()
        self.assertAlmostEqual(self.js("return window.arealab.state.wipe"), wipe - 0.01, delta=1e-6)
        view.send_keys(Keys.HOME)
        self.settle()
        self.assertEqual(self.js(column), before)
        view.send_keys(Keys.END)
        self.settle()
        self.assertEqual(self.js(column), after)

    def test_pointer_shows_the_value_in_every_variant(self):
        self.open("#a=ltc&b=truth")
        view = self.driver.find_element(By.CSS_SELECTOR, "#difference .view")
        self.js("arguments[0].scrollIntoView({block: 'center'})", view)
        ActionChains(self.driver, duration=0).move_to_element_with_offset(view, 0, int(0.3 * view.size["height"])).perform()
        self.settle()
        x, y = self.js("return [window.arealab.state.px, window.arealab.state.py]")
        self.assertEqual([x, y], [24, 28])
        self.assertIn(f"x {x}, y {y}", self.text(".inspector figcaption"))
        rows = self.driver.find_elements(By.CSS_SELECTOR, ".values .row")
        self.assertEqual(len(rows), 2 + sum(v["supported"] for v in self.results["scenes"][0]["variants"]))  # two truths
        shown = self.js("return window.arealab.pixel(arguments[0], arguments[1])", x, y)
        luminance = sum(w * c for w, c in zip((0.2126, 0.7152, 0.0722), shown["a"]))
        value = float(self.text(".values .row[data-variant=ltc] .num"))
        self.assertAlmostEqual(value, luminance, delta=6e-4 * luminance)

    def test_missing_shadow_is_a_map_of_its_own_and_ranked_nowhere(self):
        self.open()
        shadow = self.results["scenes"][0]["truth"]["shadow"]
        note = self.text("section.shadow .note")
        self.assertIn(f"Shadows take {100 * shadow['light_lost']:.1f} %", note)
        self.assertIn("Techniques cast none and are ranked against truth without them", note)
        self.assertIn("1.02 % on average and 1.98 %", note)
        # Row 28: lit floor throughout. Free on the left, without light on the right.
        left, right = self.js("""const c = document.querySelector('section.shadow canvas').getContext('2d');
            return [2, 46].map((x) => [...c.getImageData(x, 28, 1, 1).data].slice(0, 3));""")
        for ours, theirs in zip(map_color("signed", 0, 1, True), left):
            self.assertLessEqual(abs(ours - theirs), 3)
        for ours, theirs in zip(map_color("signed", 10, 1, True), right):
            self.assertLessEqual(abs(ours - theirs), 3)
        self.assertNotIn("shadowed", self.text("table.metrics"))
        self.assertNotIn("shadowed", self.text("#overview"))
        self.assertIn("not ranked", next(t.text for t in self.driver.find_elements(By.CSS_SELECTOR, ".thumb") if "shadowed" in t.text))
        self.js("document.querySelector('section.shadow .link').click()")
        self.settle()
        self.assertIn("truth relative to truth, shadowed", self.text("#difference figcaption"))
        self.open("#scene=warm&b=truth-shadowed")
        self.assertEqual(self.js("return window.arealab.state.b"), "truth")
        self.assertIn("No shadow in this scene", self.text("section.shadow .note"))
        self.assertEqual(self.js("return document.querySelectorAll('section.shadow canvas').length"), 0)

    def test_address_keeps_the_state(self):
        self.open("#scene=warm&a=oat&b=hill&lobe=specular&map=magnitude&zoom=2&x=20&y=18&ev=1&wipe=0.25")
        state = self.js("return window.arealab.state")
        self.assertEqual({k: state[k] for k in ("scene", "a", "b", "lobe", "map", "zoom", "ev", "wipe")},
                         {"scene": "warm", "a": "oat", "b": "hill", "lobe": "specular", "map": "magnitude", "zoom": 2, "ev": 1, "wipe": 0.25})
        self.set(a="point", lobe="diffuse")
        WebDriverWait(self.driver, 5, 0.02).until(lambda d: "lobe=diffuse" in d.current_url and "a=point" in d.current_url)
        self.open("#scene=nothing&a=nobody&zoom=NaN&lobe=%3Cb%3E&range=-1")
        state = self.js("return window.arealab.state")
        self.assertEqual([state["scene"], state["lobe"], state["zoom"], state["b"]], ["gloss", "total", 0, "truth"])

    def test_cells_open_their_pair_and_scene(self):
        self.open()
        click = "document.querySelector(arguments[0]).click()"  # found and clicked at once: the tables are drawn anew at will
        self.js(click, "button.cell[title^='oat relative to hill:']")
        self.settle()
        self.assertEqual(self.js("return [window.arealab.state.a, window.arealab.state.b]"), ["oat", "hill"])
        self.assertIn("oat relative to hill", self.text("#difference figcaption"))
        self.js(click, "#overview a.cell[title^='warm, ltc:']")
        WebDriverWait(self.driver, 10, 0.02).until(lambda d: self.js("return window.arealab.state.scene") == "warm")
        self.wait_ready()
        self.assertEqual(self.js("return window.arealab.state.a"), "ltc")
        self.assertIn("Does colour survive?", self.text("#scene-heading"))

    def test_table_sorts_by_error_and_names_ties(self):
        self.open()
        def column(index):
            return [float(c.text) for c in self.driver.find_elements(By.CSS_SELECTOR, f"table.metrics tbody td:nth-child({index})")]
        self.assertEqual(column(2), sorted(column(2)))
        self.assertIn("within truth's error, not ranked", self.text("table.metrics tbody tr.tied"))
        heading = self.driver.find_element(By.CSS_SELECTOR, "th[data-key=flip] button")
        self.js("arguments[0].click()", heading)
        self.settle()
        index = self.js("return [...document.querySelectorAll('.metrics th')].findIndex((t) => t.dataset.key === 'flip') + 1")
        self.assertEqual(column(index), sorted(column(index)))
        self.js("arguments[0].click()", heading)
        self.settle()
        self.assertEqual(column(index), sorted(column(index), reverse=True))
        jump = self.driver.find_element(By.CSS_SELECTOR, "table.metrics tbody tr:first-child .at")
        x, y = (int(n) for n in jump.text.strip("()").split(","))
        self.js("arguments[0].click()", jump)
        self.settle()
        self.assertEqual(self.js("return [window.arealab.state.px, window.arealab.state.py, window.arealab.state.zoom]"), [x, y, 8])

    def test_says_what_is_not_supported_and_what_is_broken(self):
        self.open("#scene=warm")
        self.assertIn("lightfield shades rectangles only", self.text(".refused"))
        row = next(r for r in self.driver.find_elements(By.CSS_SELECTOR, "table.metrics tbody tr") if r.text.startswith("drobot\n"))
        self.assertIn("48", row.find_element(By.CSS_SELECTOR, ".bad").text)
        self.set(a="drobot", b="truth", zoom=4, x=24, y=24)
        self.assertEqual(self.js("return window.arealab.pixel(24, 24)")["color"], [255, 0, 255])

    def test_says_how_it_was_made(self):
        self.open()
        footer = self.text("#footer")
        for text in (self.results["command"], self.results["renderer"], self.results["machine"]["cpu"], "CPU rasteriser, not a GPU"):
            self.assertIn(text, footer)
        for link in self.driver.find_elements(By.CSS_SELECTOR, "#footer a"):
            self.assertTrue((FOLDER / "report" / link.get_attribute("href").rsplit("/", 1)[1]).is_file())

    def test_hostile_text_stays_text(self):
        scene = self.results["scenes"][2]
        self.open("#scene=" + quote(scene["name"], safe=""))
        self.assertIn("</script><img src=x onerror=\"window.injected=1\">", self.text("#scene-heading"))
        self.assertEqual(self.js("return document.querySelectorAll('img[src=x], main b b, h2 b').length"), 0)
        self.assertIn("<img", self.driver.title)

    def test_nothing_is_cut_off(self):
        # Every piece of visible text lies inside the window and inside each ancestor that hides what overflows it.
        probe = """
            const width = document.documentElement.clientWidth, cut = [];
            if (document.documentElement.scrollWidth > width) cut.push(`page ${document.documentElement.scrollWidth} wide`);
            const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
            for (let node; (node = walk.nextNode());) {
              const parent = node.parentElement;
              if (!node.data.trim() || parent.closest('script, style, noscript, .skip, option, title')) continue;
              const range = document.createRange();
              range.selectNodeContents(node);
              for (const r of range.getClientRects()) {
                if (!r.width || !r.height) continue;
                if (r.left < -0.5 || r.right > width + 0.5) cut.push(`window: ${node.data} ${r.left} to ${r.right}`);
                for (let e = parent; e && e !== document.body; e = e.parentElement) {
                  if (getComputedStyle(e).overflowX === 'visible') continue;
                  const b = e.getBoundingClientRect();
                  if (r.left < b.left - 0.5 || r.right > b.right + 0.5 || r.top < b.top - 3 || r.bottom > b.bottom + 3) cut.push(`${e.tagName}.${e.className}: ${node.data}`);
                }
              }
            }
            // A matrix cell or a button is as wide as its text.
            for (const e of document.querySelectorAll('.cell, button, select, .tag')) {
              if (e.offsetParent && e.scrollWidth > e.clientWidth + 1) cut.push(`narrow ${e.tagName}.${e.className}: ${e.textContent.slice(0, 40)} ${e.scrollWidth} > ${e.clientWidth}`);
            }
            return cut;"""
        for width in (1280, 390):
            self.size(width)
            for scene in self.results["scenes"]:
                for fragment in ("", "&map=magnitude&log=0&thumbs=magnitude&lobe=specular&ev=-2.25"):
                    self.open("#scene=" + quote(scene["name"], safe="") + fragment)
                    self.js("document.querySelectorAll('details').forEach((d) => { d.open = true; })")
                    self.settle()
                    self.assertEqual(self.js(probe), [], msg=f"at {width} pixels")

    def marks(self, plot):
        """id -> (x, y, on the frontier) of each mark, in the plot's own units."""
        return {m[0]: m[1:] for m in self.js("""
            return [...arguments[0].querySelectorAll('.mark')].map((m) => { const c = m.querySelector('circle');
              return [m.dataset.id, Number(c.getAttribute('cx')), Number(c.getAttribute('cy')), m.classList.contains('best')]; })""", plot)}

    @staticmethod
    def place(scene, variant, cost):
        tied = variant["within_truth_error"]
        return cost(variant), scene["truth"]["relative_error"] if tied else variant["error"]["total"]["rel_rmse"]

    @staticmethod
    def frontier(places):
        return {n for n, (x, y) in places.items() if not any((q[0] <= x and q[1] <= y and q != (x, y)) for q in places.values())}

    def test_accuracy_against_cost_is_a_picture(self):
        self.open("#a=ltc&b=truth")
        plot = self.driver.find_element(By.CSS_SELECTOR, "#scene section.plot")
        scene = self.results["scenes"][0]
        axes = {"time": lambda v: v["time"]["ratio_to_point"], "net": lambda v: v["time"]["net_ratio_to_point"],
                "bonaire": lambda v: v["isa"]["bonaire"]["core"]["cycles"], "navi21.full": lambda v: v["isa"]["navi21"]["full"]["cycles"]}
        for cost, value in axes.items():
            self.set(cost=cost)
            known = [v for v in scene["variants"] if v["supported"] and (v["isa"] or cost in ("time", "net"))]
            places = {v["name"]: self.place(scene, v, value) for v in known}
            marks = self.marks(plot)
            self.assertEqual(set(marks), set(places))
            best = self.frontier(places)
            self.assertEqual({n for n, m in marks.items() if m[2]}, best)
            self.assertGreater(len(best), 2)
            self.assertLess(len(best), len(places))
            for a in places:  # logarithmic axes: equal factors are equal ways
                for b in places:
                    if abs(math.log(places[a][0] / places[b][0])) > 0.2:
                        self.assertAlmostEqual((marks[a][0] - marks[b][0]) / math.log(places[a][0] / places[b][0]),
                                               (marks["ltc"][0] - marks["point"][0]) / math.log(places["ltc"][0] / places["point"][0]), delta=0.5)
            names = self.js("return [...arguments[0].querySelectorAll('.name')].map((t) => [t.dataset.name, t.textContent, t.getBBox().x, t.getBBox().y, t.getBBox().width, t.getBBox().height])", plot)
            self.assertEqual({n[0] for n in names}, set(places), msg="every mark has its name")
            for i, p in enumerate(names):
                for q in names[:i]:
                    apart = p[2] + p[4] <= q[2] or q[2] + q[4] <= p[2] or p[3] + p[5] <= q[3] + 2 or q[3] + q[5] <= p[3] + 2
                    self.assertTrue(apart, msg=f"{p} over {q}")
            cheapest = min((x, n) for n, (x, y) in places.items() if y <= 0.05)[1]
            words = self.text("#scene .plot .words")
            if cost == "time":
                short = next(v["short_name"] for v in known if v["name"] == cheapest)
                self.assertRegex(words, rf"Within \d+(\.\d+)? % of truth on this scene: {short}, {places[cheapest][0]:.2f} × a point light")
            elif cost == "bonaire":
                self.assertRegex(words, r"\d+ cycles on bonaire, \d+\.\d × a point light")
            self.assertIn("not a GPU" if cost in ("time", "net") else "estimated", self.text("#scene .plot .card .note"))
        self.assertEqual(self.js("return arguments[0].querySelectorAll('.link-line').length", plot), 3)  # published forms tied to ours

    def test_the_plot_answers(self):
        self.open("#a=ltc&b=truth")
        plot = self.driver.find_element(By.CSS_SELECTOR, "#scene section.plot")
        self.js("arguments[0].querySelector('.chart').scrollIntoView({block: 'center'})", plot)
        mark = plot.find_element(By.CSS_SELECTOR, ".mark[data-id=oat] circle")
        ActionChains(self.driver, duration=0).move_to_element(mark).perform()
        oat = next(v for v in self.results["scenes"][0]["variants"] if v["name"] == "oat")
        hovered = plot.find_element(By.CSS_SELECTOR, ".hovered").text
        self.assertIn("oat:", hovered)
        self.assertIn(f"{oat['time']['ratio_to_point']:.2f} × a point light", hovered)
        self.assertIn("95 % interval", hovered)
        ActionChains(self.driver, duration=0).click(mark).perform()
        self.settle()
        self.assertEqual(self.js("return window.arealab.state.a"), "oat")
        before = self.marks(plot)
        self.js("arguments[0].querySelector('.chip-toggle[data-technique=ltc]').click()", plot)
        self.settle()
        self.assertEqual(set(before) - set(self.marks(plot)), {"ltc", "ltc+clip=switch+edge=rational"})
        WebDriverWait(self.driver, 5, 0.02).until(lambda d: "off=ltc" in d.current_url)
        self.js("arguments[0].querySelector('.chip-toggle[data-technique=ltc]').click()", plot)
        self.set(xlog=False, metric="flip", lobe="total")
        linear = self.marks(plot)
        ratio = {v["name"]: v["time"]["ratio_to_point"] for v in self.results["scenes"][0]["variants"] if v["supported"]}
        self.assertAlmostEqual((linear["ltc"][0] - linear["point"][0]) / (linear["reference"][0] - linear["point"][0]),
                               (ratio["ltc"] - ratio["point"]) / (ratio["reference"] - ratio["point"]), delta=1e-3)
        self.assertIn("FLIP", self.text("#scene .plot svg"))

    def test_the_plot_over_all_scenes_takes_geometric_means(self):
        self.open("#cost=bonaire&off=drobot")  # in one scene drobot has no figure, and only scenes that all have count
        plot = self.driver.find_element(By.CSS_SELECTOR, "#overview section.plot")
        note = plot.find_element(By.CSS_SELECTOR, ".card .note").text
        scenes = [s for s in self.results["scenes"] if s["name"] in note]
        self.assertGreater(len(scenes), 1)
        cost = lambda v: v["isa"]["bonaire"]["core"]["cycles"]
        places = {}
        for name in self.marks(plot):
            each = [self.place(s, next(v for v in s["variants"] if v["name"] == name), cost) for s in scenes]
            places[name] = tuple(math.exp(sum(math.log(p[i]) for p in each) / len(each)) for i in (0, 1))
        self.assertGreater(len(places), 4)
        self.assertEqual({n for n, m in self.marks(plot).items() if m[2]}, self.frontier(places))
        label = plot.find_element(By.CSS_SELECTOR, ".mark[data-id=point]").get_attribute("aria-label")
        self.assertIn(f"{round(places['point'][0])} cycles on bonaire", label)

    def test_a_family_is_a_curve(self):
        self.open()
        curve = self.js("""
            const host = document.createElement('div');
            document.querySelector('#main').append(host);
            const mark = (id, x, y) => ({ id, label: id, x, y, xBar: [0.9 * x, 1.1 * x], yBar: null, text: id });
            window.arealabPareto.draw(host, { marks: [mark('n16', 4, 0.2), mark('n1', 1, 0.8), mark('n64', 16, 0.1), mark('bad', 20, 0.9)], links: [], chains: [['n16', 'n1', 'n64']],
              x: { title: 'x', log: true, format: String }, y: { title: 'y', log: true, format: String }, limit: null, name: 'test', onpick: () => {}, onhover: () => {} });
            const at = (id) => { const c = host.querySelector(`[data-id=${id}] circle`); return [Number(c.getAttribute('cx')), Number(c.getAttribute('cy'))]; };
            const found = [host.querySelector('.chain').getAttribute('d').match(/[\\d.]+/g).map(Number), [...at('n1'), ...at('n16'), ...at('n64')],
              [...host.querySelectorAll('.mark.beaten')].map((m) => m.dataset.id), host.querySelectorAll('.bar').length];
            host.remove();
            return found;""")
        for drawn, expected in zip(curve[0], curve[1]):
            self.assertAlmostEqual(drawn, expected, delta=0.01)
        self.assertEqual(len(curve[0]), 6)
        self.assertEqual(curve[2:], [["bad"], 4])

    def test_fit_panel_shows_the_stored_figures(self):
        maps = json.loads((Path(__file__).parents[2] / "glsl/tables/quality.json").read_text())
        self.open()
        for brdf, measure, place in (("ggx", "polygon", 0), ("ward", "lobe", 77), ("phong", "below", 143)):
            self.set(fitbrdf=brdf, fit=measure)
            shown = [m for m in maps if m["brdf"] == brdf]
            cells = self.js("return [...document.querySelectorAll('#fit figure')].map((f) => [...f.querySelectorAll('.cell')].map((c) => c.title))")
            self.assertEqual(len(cells), len(shown))
            self.assertTrue(all(len(grid) == 144 for grid in cells))
            ours = next(m for m in shown if m["table"].endswith("_polygon"))  # the first of the panel
            figure = float(cells[0][place].split(": ")[1].removesuffix(" %").replace("\u2212", "-"))
            self.assertAlmostEqual(figure, 100 * ours[measure][place], delta=0.006 * 100 * ours[measure][place] + 1e-3)

    def test_savings_are_those_of_the_results(self):
        self.open()
        scenes = self.js("return window.arealab.results.scenes")
        names = list(dict.fromkeys(v["name"] for s in scenes for v in s["variants"] if v["stem"]))
        pruned = {"time": lambda v: v["saving"]["time_ratio"], "bonaire": lambda v: (lambda c: c["pruned"] / c["every_effect"])(v["saving"]["cycles"]["bonaire"])}
        def per_pixel(way, key):
            return lambda v: (lambda w: w and (w["time_ratio"] if key == "time" else w["cycles_ratio"][key]))(v["saving"]["per_pixel"].get(way))
        for way in ("pruned", "tiles", "branch"):
            for key in ("time", "bonaire"):
                ratio = pruned[key] if way == "pruned" else per_pixel(way, key)
                for choice in (way, key):
                    self.js("document.querySelector(`#savings [data-value=${arguments[0]}]`).click()", choice)
                grid = self.js("return [...document.querySelectorAll('#savings .matrix > span')].map((c) => c.textContent)")
                columns = len(scenes) + 2
                rows = [grid[i + 1:i + columns] for i in range(columns, len(grid) - columns - 1, columns)]
                self.assertEqual(len(rows), len(names))
                for name, row in zip(names, rows):
                    found = [next((v for v in s["variants"] if v["name"] == name), None) for s in scenes]
                    ratios = [ratio(v) if v and v["saving"] else None for v in found]
                    self.assertEqual(row[:-1], [f"{x:.2f}" if x else "\u2013" for x in ratios])
                    known = [x for x in ratios if x]
                    mean = math.prod(known) ** (1 / len(known)) if known else None
                    self.assertEqual(row[-1], f"{mean:.2f}" if mean else "\u2013")
        pays = [v for s in scenes for v in s["variants"] if v["saving"]]
        tiles = sum(v["saving"]["per_pixel"]["tiles"]["interval"][1] < 1 for v in pays)
        self.assertIn(f"here tiles in {tiles} of {len(pays)}, a branch in 0 of", self.text("#savings .note:last-child"))

    def test_tiles_are_drawn_by_what_they_need(self):
        self.open()
        needs = self.js("return window.arealab.results.scenes[0].tiles.needs")
        drawn = self.js("""const c = document.querySelector('.tile-pictures canvas'), d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
            return [c.width, ...Array.from({length: d.length / 4}, (_, i) => d.slice(4 * i, 4 * i + 3).join())];""")
        self.assertEqual(drawn[0], 4)
        kinds = {}
        for letter, color in zip(needs, drawn[1:]):
            kinds.setdefault(letter, color)
            self.assertEqual(kinds[letter], color)
        self.assertEqual(len(drawn) - 1, len(needs))
        shown = {n: kinds[chr(65 + n)] for n in (0, 25, 27, 29, 31)}
        self.assertEqual(len(set(shown.values())), 4)
        self.assertEqual(shown[27], shown[31])  # horizons: whether the stand-in crosses one too does not matter

    def test_maps_in_the_grid(self):
        self.open("#thumbs=signed")
        drawn = self.js("""return [...document.querySelectorAll('.thumb canvas')].map((c) => {
            const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;
            return c.hidden ? -1 : new Set(Array.from({length: d.length / 4}, (_, i) => d.slice(4 * i, 4 * i + 3).join())).size; })""")
        self.assertEqual(drawn[0], 2)  # truth against itself: no error where lit, the unlit grey elsewhere
        for colors in drawn[1:5]:  # truth with shadows, point, drobot twice: different enough to show
            self.assertGreater(colors, 3)

    def test_missing_data_is_said(self):
        script = FOLDER / "report/data/gloss/hill.js"
        moved = FOLDER / "hill.js"
        script.rename(moved)
        try:
            self.driver.get("about:blank")
            self.driver.get((FOLDER / "report/index.html").as_uri())
            WebDriverWait(self.driver, 10, 0.02).until(lambda d: self.js("return document.documentElement.dataset.failed ?? null"))
            self.assertIn("data/gloss/hill.js is missing", self.text("#pictures .busy"))
        finally:
            moved.rename(script)
        self.driver.get_log("browser")  # the browser itself reports the missing file


if __name__ == "__main__":
    PROGRAM, FOLDER = sys.argv[1], Path(sys.argv[2]).resolve()
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]], verbosity=1)

#!/usr/bin/python3
"""The window as a person uses it, under Xvfb with real events (Debian: xvfb, xdotool).

usage: view_test.py AREALAB FOLDER
FOLDER keeps the screenshots of the last run.
"""
import ctypes
import json
import math
import os
import shutil
import signal
import struct
import subprocess
import sys
import threading
import time
import tomllib
import unittest
import zlib
from pathlib import Path

BAR, COLUMN = 46, 344  # px: height of the bar, width of the column (2.9 and 21.5 heights of the type)
WINDOW = (1100, 600)
WIDTH = WINDOW[0] - COLUMN  # of the picture
LIGHT = (WIDTH // 2, 176)  # where the scene's light has its centre
PROGRAM = FOLDER = None
DISPLAY = None

SCENE = """# A panel over a floor
[camera]
position = [0.0, -4.0, 1.9]
target = [0.0, 0.35, 0.15]

[[material]]
name = "floor"
base_color = 0.3
roughness = 0.5  # as sanded

[[surface]]
type = "plane"
size = [6.0, 6.0]
material = "floor"

[[light]]
name = "panel"
shape = "rectangle"
position = [0.0, 1.9, 0.75]  # metres
normal = [0.0, -1.0, 0.0]
size = [2.0, 0.9]
radiance = 3.0
"""

TECHNIQUE = """/*---
summary = "One colour"
citation = "none"
author_note = "for a test"
shapes = ["rectangle"]
lobes = ["diffuse", "specular"]
brdfs = ["ggx"]
effects = ["fresnel"]

[[knob]]
name = "level"
label = "Level"
unit = ""
initial = %s
min = 0.0
max = 1.0
---*/
#include "surface.glsl"
#include "brdf.glsl"

Radiance ShadeLight(Surface surface, Light light, vec3 to_view) {
  %s
}
"""
# A view that is a power of 1/2.2, and the light itself.
OCIO = """ocio_profile_version: 1
search_path: .
roles: {default: raw, scene_linear: lin_rec709}
displays:
  sRGB:
    - !<View> {name: Film, colorspace: film}
    - !<View> {name: Raw, colorspace: raw}
active_displays: [sRGB]
active_views: [Film, Raw]
colorspaces:
  - !<ColorSpace> {name: raw, isdata: true}
  - !<ColorSpace> {name: lin_rec709}
  - !<ColorSpace>
    name: film
    from_reference: !<ExponentTransform> {value: [0.4545454, 0.4545454, 0.4545454, 1]}
"""
WHOLE = "return Radiance(vec3(knob_level), vec3(0.0));"


def read_png(data, count=None):
    """(width, height, rows of RGB bytes, the first `count`) of an 8-bit RGB PNG."""
    at, packed = 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR":
            width, height, depth, color = struct.unpack(">IIBB", data[at + 8:at + 18])
            assert (depth, color) == (8, 2), (depth, color)
        elif kind == b"IDAT":
            packed += data[at + 8:at + 8 + length]
        at += length + 12
    raw, stride = zlib.decompress(packed), 3 * width
    rows, before = [], bytearray(stride)
    for y in range(count or height):
        kind, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        if kind == 1:
            for i in range(3, stride):
                row[i] = (row[i] + row[i - 3]) & 255
        elif kind == 2:
            row = bytearray((a + b) & 255 for a, b in zip(row, before))
        elif kind == 3:
            for i in range(stride):
                row[i] = (row[i] + ((row[i - 3] if i >= 3 else 0) + before[i]) // 2) & 255
        elif kind == 4:
            for i in range(stride):
                a, b, c = row[i - 3] if i >= 3 else 0, before[i], before[i - 3] if i >= 3 else 0
                p = a + b - c
                pa, pb, pc = abs(p - a), abs(p - b), abs(p - c)
                row[i] = (row[i] + (a if pa <= pb and pa <= pc else b if pb <= pc else c)) & 255
        rows.append(bytes(row))
        before = row
    return width, height, rows


# By how much a program under a sanitizer may be slower.
PATIENCE = float(os.environ.get("AREALAB_PATIENCE", "1"))


def until(condition, what, seconds=20.0):
    seconds *= PATIENCE
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        result = condition()
        if result:
            return result
        time.sleep(0.05)
    raise AssertionError(f"no {what} within {seconds} s")


def environment():
    # Mesa's compiled shaders stay where the user's other programs have theirs: they are no part of what is tested.
    shaders = os.environ.get("MESA_SHADER_CACHE_DIR", os.environ.get("XDG_CACHE_HOME", str(Path.home() / ".cache")))
    return dict(os.environ, DISPLAY=DISPLAY, MESA_SHADER_CACHE_DIR=shaders, XDG_CONFIG_HOME=str(FOLDER / "config"), XDG_CACHE_HOME=str(FOLDER / "cache"),
                XDG_STATE_HOME=str(FOLDER / "state"))


def arealab(*arguments, **extra):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, cwd=FOLDER, timeout=60,
                          env=environment() | extra)


class Window:
    """A running `arealab view`, and the hands that use it."""

    def __init__(self, name, *arguments, size=WINDOW, **extra):
        self.log_file = FOLDER / f"{name}.log"
        self.shots = 0
        self.name = name
        with open(self.log_file, "w") as log:
            self.process = subprocess.Popen([PROGRAM, "view", *map(str, arguments), "--size", "{}x{}".format(*size), "--context", "osmesa", "--json"],
                                            stdout=subprocess.PIPE, stderr=log, text=True, cwd=FOLDER, env=environment() | extra)
        until(self.title, "window")

    def do(self, *arguments):
        return subprocess.run(["xdotool", *map(str, arguments)], check=True, env=environment(), timeout=30, capture_output=True,
                              text=True).stdout

    def log(self):
        return self.log_file.read_text()

    @staticmethod
    def title():
        """Of the window, or nothing: also where xdotool met another that was just going."""
        return subprocess.run(["xdotool", "search", "--name", "AreaLab", "getwindowname"], env=environment(), timeout=30, capture_output=True, text=True).stdout

    def drag(self, begin, end, steps=6):
        self.do("mousemove", *begin, "mousedown", "1")
        for i in range(1, steps + 1):
            self.do("mousemove", *(round(a + (b - a) * i / steps) for a, b in zip(begin, end)))
        self.do("mouseup", "1")

    def shot(self):
        """The bytes of a PNG of the window as it is seen."""
        count = self.log().count("wrote ")
        self.do("key", "F12")
        until(lambda: self.log().count("wrote ") > count, "screenshot")
        file = FOLDER / self.log().rsplit("wrote ", 1)[1].strip().splitlines()[0]
        self.shots += 1
        kept = FOLDER / f"{self.name}_{self.shots}.png"
        shutil.move(file, kept)
        return kept.read_bytes()

    def rest(self):
        """Until its picture is whole, which the title says."""
        time.sleep(0.2)  # for what was done to arrive
        until(lambda: "AreaLab" in (title := self.title()) and "…" not in title, "whole picture", 30.0)

    def settled(self):
        """The window once its picture is whole."""
        self.rest()
        return self.shot()

    def picture(self, end=WINDOW[1] - 130):
        """The rows of the picture alone, without what is written at its head and foot."""
        return [row[3 * 8:3 * (WIDTH - 8)] for row in read_png(self.settled(), end)[2][BAR + 40:]]

    def leave(self):
        self.do("key", "ctrl+q")
        out, _ = self.process.communicate(timeout=20)
        return json.loads(out)

    def end(self):
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait()
        self.process.stdout.close()
        # The server takes the window down after the process: the next one must not be mistaken for it.
        until(lambda: not self.title(), "window gone")


class Drop:
    """Files that a hand drops on a window, by the protocol of file managers [XDND 5], which xdotool does not speak."""

    CLIENT, REQUEST, NOTIFY = 33, 30, 31  # ClientMessage, SelectionRequest, SelectionNotify

    def __init__(self, files, window, x, y):
        x11 = ctypes.CDLL("libX11.so.6")
        x11.XOpenDisplay.restype = ctypes.c_void_p
        for name in ("XDefaultRootWindow", "XCreateSimpleWindow", "XInternAtom"):
            getattr(x11, name).restype = ctypes.c_ulong
        long, pointer = ctypes.c_ulong, ctypes.c_void_p
        display = pointer(x11.XOpenDisplay(DISPLAY.encode()))
        source = long(x11.XCreateSimpleWindow(display, long(x11.XDefaultRootWindow(display)), 0, 0, 1, 1, 0, long(0), long(0)))
        atom = lambda name: x11.XInternAtom(display, name.encode(), 0)
        uris = "".join(Path(file).as_uri() + "\r\n" for file in files).encode()

        def send(to, kind, *data, message=None):
            event = (long * 24)()
            event[0] = kind
            fields = [to, message, 32] if message else []
            for i, value in enumerate(fields + list(data)):
                event[4 + i] = value
            x11.XSendEvent(display, long(to), 0, long(0), ctypes.byref(event))
            x11.XFlush(display)

        def tell(name, *data):
            send(window, self.CLIENT, source.value, *data, message=atom(name))

        x11.XSetSelectionOwner(display, long(atom("XdndSelection")), source, long(0))
        tell("XdndEnter", 5 << 24, atom("text/uri-list"), 0, 0)
        tell("XdndPosition", 0, x << 16 | y, 0, atom("XdndActionCopy"))
        tell("XdndDrop", 0, 0, 0, 0)
        event = (long * 24)()
        finished = atom("XdndFinished")
        while True:
            x11.XNextEvent(display, ctypes.byref(event))
            kind = event[0] & 0xffffffff
            if kind == self.REQUEST:
                requestor, selection, target, prop, when = event[5:10]
                x11.XChangeProperty(display, long(requestor), long(prop), long(target), 8, 0, uris, len(uris))
                send(requestor, self.NOTIFY, requestor, selection, target, prop, when)
            elif kind == self.CLIENT and event[5] == finished:
                break
        x11.XCloseDisplay(display)


class ViewTest(unittest.TestCase):
    def window(self, *arguments, **options):
        window = Window(self.id().rsplit(".", 1)[1], *arguments, **options)
        self.addCleanup(window.end)
        return window

    def scene(self):
        file = FOLDER / f"{self.id().rsplit('.', 1)[1]}.toml"
        file.write_text(SCENE)
        return file

    def test_without_a_display_it_says_so(self):
        result = arealab("view", "gloss", DISPLAY="", WAYLAND_DISPLAY="")
        self.assertEqual(result.returncode, 2)
        self.assertRegex(result.stderr, r"^no display: .*; expected .*\n$")

    def test_bad_arguments_are_one_line(self):
        for arguments, part in [(("nowhere",), "nowhere"), (("gloss", "--technique", "karis"), "sphere"),
                                (("gloss", "--screenshot", "a.jpg"), ".png or .exr")]:
            result = arealab("view", *arguments)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
            self.assertIn(part, result.stderr)

    def test_a_screenshot_is_the_render_of_the_same_variant(self):
        scene = self.scene()
        for technique in ("ltc", "drobot@published", "truth"):
            arealab("view", scene, "--bare", "--technique", technique, "--size", "320x200", "--frames", 2, "--screenshot", "seen.png",
                    "--context", "osmesa")
            arealab("render", scene, "--technique", technique, "--size", "320x200", "-o", "rendered.png", "--context", "osmesa")
            seen, rendered = (read_png((FOLDER / name).read_bytes()) for name in ("seen.png", "rendered.png"))
            self.assertEqual(seen[:2], (320, 200))
            worst = max(max(abs(a - b) for a, b in zip(x, y)) for x, y in zip(seen[2], rendered[2]))
            self.assertLessEqual(worst, 1)
            self.assertGreater(max(map(max, rendered[2])), 200)

    def test_a_mesh_alone_and_a_turntable(self):
        mesh = FOLDER / "pyramid.obj"
        mesh.write_text("v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 2 0\nf 1 5 2\nf 2 5 3\nf 3 5 4\nf 4 5 1\n")
        result = arealab("view", mesh, "--bare", "--technique", "point", "--size", "160x120", "--turntable", "round", "--frames", 3)
        self.assertEqual(result.returncode, 0, result.stderr)
        frames = sorted((FOLDER / "round").iterdir())
        self.assertEqual([frame.name for frame in frames], ["0001.png", "0002.png", "0003.png"])
        pictures = [read_png(frame.read_bytes())[2] for frame in frames]
        self.assertEqual(len({b"".join(rows) for rows in pictures}), 3)
        self.assertGreater(max(map(max, pictures[0])), 60)  # lit

    def test_orbit_and_wipe(self):
        window = self.window(self.scene(), "--technique", "ltc", "--technique", "point")
        first = window.settled()
        window.drag((100, 480), (200, 460))
        turned = window.settled()
        self.assertFalse(first == turned)
        # The wipe's line is bright at its place, from the top of the picture to its foot.
        line = lambda rows, x: all(rows[y][3 * x] > 120 for y in range(BAR + 60, WINDOW[1] - 60, 40))
        middle = WIDTH // 2
        self.assertTrue(line(read_png(turned)[2], middle))
        window.drag((middle, 480), (middle + 150, 480))
        rows = read_png(window.settled())[2]
        self.assertTrue(line(rows, middle + 150))
        self.assertFalse(line(rows, middle))
        figures = window.leave()
        self.assertGreater(figures["input_to_picture_ms"]["count"], 0)

    def test_picture_of_the_readme(self):
        """What a pixel has of every technique, beside the truth; kept as window.png for app/picture.sh."""
        size = (1280, 720)
        width = size[0] - COLUMN
        window = self.window("gloss", "--technique", "ltc", "--technique", "truth", size=size)
        before = window.settled()
        window.do("mousemove", 300, 400, "keydown", "shift", "click", "1", "keyup", "shift")
        window.rest()
        window.do("mousemove", width + 245, 67, "click", "1", "mousemove", 100, 650)  # the tab of the pixel
        shots = [b"", before]
        while shots[-1] != shots[-2]:  # until the last technique's values are there
            time.sleep(1.0)
            shots.append(window.settled())
        shot = shots[-1]
        changed = lambda rows, columns: any(a[3 * columns[0]:3 * columns[1]] != b[3 * columns[0]:3 * columns[1]]
                                            for a, b in zip(read_png(before)[2][slice(*rows)], read_png(shot)[2][slice(*rows)]))
        self.assertTrue(changed((490, 510), (width + 10, size[0])))  # the last of the values
        self.assertTrue(changed((460, 700), (width - 400, width - 20)))  # the lobe
        self.assertFalse(changed((60, 280), (0, width)))  # the light
        (FOLDER / "window.png").write_bytes(shot)
        window.leave()

    def test_a_slow_frame_loses_nothing(self):
        file = self.scene()
        window = self.window(file, "--technique", "ltc")
        window.rest()
        window.process.send_signal(signal.SIGSTOP)  # a frame as slow as what a hand does meanwhile
        window.do("mousemove", WIDTH + 302, 67, "click", "1")  # the tab of the view
        window.drag((100, 480), (200, 460))
        window.do("mousemove", WIDTH + 163, 230, "click", "1")  # makes it the scene's
        window.do("key", "r")  # the gizmo's ring
        window.drag((LIGHT[0] + 59, LIGHT[1] - 59), (LIGHT[0] + 84, LIGHT[1]))
        window.do("key", "ctrl+z", "key", "ctrl+s")
        window.process.send_signal(signal.SIGCONT)
        until(lambda: "saved" in window.log(), "save")
        saved = tomllib.loads(file.read_text())
        self.assertNotEqual(saved["camera"]["position"], [0.0, -4.0, 1.9])
        self.assertEqual(saved["light"][0], tomllib.loads(SCENE)["light"][0])
        window.leave()

    def test_a_pixel_is_copied_as_a_test_case(self):
        window = self.window(self.scene(), "--technique", "ltc")
        window.rest()
        window.do("mousemove", WIDTH // 2 - 60, 380, "keydown", "shift", "click", "1", "keyup", "shift")
        window.rest()
        window.do("mousemove", WIDTH + 245, 67, "click", "1", "mousemove", 100, 500)  # the tab of the pixel
        window.rest()
        window.do("key", "ctrl+c")
        until(lambda: "copied for" in window.log(), "copy")
        case = window.log().rsplit("--case`: ", 1)[1].strip()
        pixel = window.leave()["pixel"]
        self.assertEqual(pixel["cases"], [case])
        row = [line for line in arealab("stress", "--case", case, "--technique", "ltc", "--context", "osmesa").stdout.splitlines() if line.startswith("ltc ")]
        diffuse, diffuse_double, _, specular, specular_double = map(float, row[0].split()[1:6])
        seen = pixel["values"]["ltc"]
        for mine, theirs in zip(seen["float"] + seen["double"], (0.3 * diffuse, specular, 0.3 * diffuse_double, specular_double)):
            self.assertLess(abs(mine / theirs - 1.0), 2e-6)
        self.assertNotEqual(seen["float"], seen["double"])
        self.assertLess(abs(sum(pixel["truth"]) / sum(pixel["values"]["reference"]["double"]) - 1.0), 1e-3)
        self.assertGreater(len(pixel["values"]), 6)

    def test_turn_scale_focus_cameras_images(self):
        file = self.scene()
        window = self.window(file, "--technique", "ltc")
        window.rest()

        def saved():
            count = window.log().count("saved ")
            window.do("key", "ctrl+s")
            until(lambda: window.log().count("saved ") > count, "save")
            return tomllib.loads(file.read_text())

        window.do("key", "r")  # the ring about the normal, a quarter turn's half
        window.drag((LIGHT[0] + 59, LIGHT[1] - 59), (LIGHT[0] + 84, LIGHT[1]))
        window.rest()
        light = saved()["light"][0]
        self.assertEqual(light["normal"], [0.0, -1.0, 0.0])
        self.assertLess(abs(abs(light["up"][0]) - 0.7071), 0.04)
        window.do("key", "ctrl+z", "key", "s")
        window.drag((LIGHT[0] + 82, LIGHT[1]), (LIGHT[0] + 123, LIGHT[1]))
        window.rest()
        light = saved()["light"][0]
        self.assertEqual(light["up"], [0.0, 0.0, 1.0])  # undone
        self.assertLess(abs(light["size"][0] - 3.0), 0.2)
        self.assertEqual(light["size"][1], 0.9)
        window.do("key", "ctrl+z")
        window.rest()

        image = FOLDER / "stripes.ppm"
        image.write_text("P3 4 1 255\n255 0 0  0 255 0  0 0 255  255 255 255\n")
        target = int(window.do("search", "--name", "AreaLab").split()[0])
        place = [int(line.split("=")[1]) for line in window.do("getwindowgeometry", "--shell", target).splitlines() if line[:2] in ("X=", "Y=")]
        x, y = LIGHT[0] - 60, LIGHT[1] - 20
        self.assertNotIn("sky", saved())
        Drop([image], target, place[0] + x, place[1] + y)
        until(lambda: "shows stripes.ppm" in window.log(), "image on the light")
        self.assertEqual(saved()["light"][0]["texture"], "stripes.ppm")
        window.do("key", "ctrl+z")
        window.rest()
        self.assertNotIn("texture", saved()["light"][0])
        Drop([image], target, place[0] + 30, place[1] + BAR + 60)
        until(lambda: "stripes.ppm' is 4 × 1 pixels; expected a sky in latitude and longitude" in window.log(), "refusal of what is no sky")
        day = FOLDER / "day.ppm"
        day.write_text("P3 4 2 255\n" + "255 0 0  0 255 0  0 0 255  255 255 255 " * 2)
        Drop([day], target, place[0] + 30, place[1] + BAR + 60)
        until(lambda: "the sky shows day.ppm" in window.log(), "sky")
        self.assertEqual(saved()["sky"], {"radiance": [1.0, 1.0, 1.0], "texture": "day.ppm"})
        background = lambda x: tuple(read_png(window.settled())[2][BAR + 60][3 * x:3 * x + 3])
        before = background(30)
        window.do("key", "Escape", "mousemove", WIDTH + 242, 339, "keydown", "ctrl", "click", "1", "keyup", "ctrl", "key", "ctrl+a", "type", "90")  # its rotation
        window.do("key", "Return")
        window.rest()
        self.assertEqual(saved()["sky"]["rotation"], 90.0)
        self.assertNotEqual(background(30), before)
        window.do("key", "ctrl+z", "key", "ctrl+z")
        window.rest()
        self.assertNotIn("sky", saved())
        # What changes on disk is read again: the scene, and the image where one of its lights shows it.
        Drop([image], target, place[0] + x, place[1] + y)
        until(lambda: window.log().count("shows stripes.ppm") == 2, "image on the light again")
        text = saved() and file.read_text()
        for changed, content in ((image, "P3 1 1 255\n9 9 9\n"), (file, text.replace("radiance = 3.0", "radiance = 6.0"))):
            count = window.log().count("read again")
            changed.write_text(content)
            until(lambda: window.log().count("read again") > count, "change on disk")
        outside = FOLDER.parent / "outside.ppm"
        outside.write_text(image.read_text())
        Drop([outside], target, place[0] + x, place[1] + y)
        until(lambda: "outside.ppm: outside " in window.log(), "refusal")
        outside.unlink()

        window.do("mousemove", WIDTH + 302, 67, "click", "1")  # the tab of the view
        window.do("mousemove", 200, 450, "key", "f")
        window.rest()

        def camera():
            window.do("mousemove", WIDTH + 163, 230, "click", "1")  # makes it the scene's
            return saved()["camera"]

        focused = camera()
        self.assertEqual(focused["position"], [0.0, -4.0, 1.9])
        self.assertLess(abs(focused["target"][2]), 1e-5)
        self.assertLess(focused["target"][0], -0.3)
        window.do("mousemove", WIDTH + 163, 200, "click", "1")  # remembered
        window.drag((100, 480), (200, 460))
        self.assertNotEqual(camera()["position"], focused["position"])
        window.do("mousemove", WIDTH + 163, 200, "click", "1")
        self.assertEqual(camera(), focused)
        window.leave()

    def test_files_anywhere_are_read_again(self):
        """Images and meshes in folders of their own, saved in place or by renaming, also where their paths change while the window is open."""
        folder = FOLDER / "anywhere"
        for name in ("images", "meshes/parts", "elsewhere"):
            (folder / name).mkdir(parents=True)
        image = lambda colour: "P3 1 1 255\n" + colour + "\n"
        (folder / "images" / "grey.ppm").write_text(image("128 128 128"))
        (folder / "images" / "light.ppm").write_text(image("255 255 255"))
        (folder / "images" / "sky.ppm").write_text("P3 4 2 255\n" + "20 20 20 " * 8)
        mesh = lambda height: f"mtllib parts/wall.mtl\nv -0.3 0 0\nv 0.3 0 0\nv 0.3 0 {height}\nv -0.3 0 {height}\nf 1 2 3\nf 1 3 4\n"
        (folder / "meshes" / "wall.obj").write_text(mesh(0.3))
        (folder / "meshes" / "parts" / "wall.mtl").write_text("newmtl wall\n")
        (folder / "meshes" / "quad.bin").write_bytes(struct.pack("<9f", -0.4, 0, 0.1, -0.2, 0, 0.1, -0.3, 0.3, 0.1))
        (folder / "meshes" / "quad.gltf").write_text(json.dumps({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}], "materials": [{"name": "paint"}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}], "buffers": [{"uri": "quad.bin", "byteLength": 36}],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-0.4, 0, 0.1], "max": [-0.2, 0.3, 0.1]}]}))
        file = folder / "scene.toml"
        text = SCENE.replace("base_color = 0.3", 'base_color_texture = "images/grey.ppm"').replace("radiance = 3.0", 'radiance = 3.0\ntexture = "images/light.ppm"')
        text += '\n[[material]]\nname = "paint"\n' + "".join(f'\n[[surface]]\ntype = "mesh"\nfile = "meshes/{name}"\n{more}' for name, more in (("wall.obj", 'material = "paint"\n'), ("quad.gltf", "")))
        text += '\n[sky]\nradiance = 0.5\ntexture = "images/sky.ppm"\n'
        file.write_text(text)
        window = self.window(file, "--technique", "ltc")
        seen = window.picture(340)

        def changes(what, act, says="read again"):
            nonlocal seen
            count = window.log().count(says)
            act()
            until(lambda: window.log().count(says) > count, what)
            now = window.picture(340)
            self.assertFalse(now == seen, what)
            seen = now

        def renamed(to, content):
            kept = to.with_name(to.name + "~")
            to.replace(kept)  # as vim does it
            time.sleep(0.02)
            to.write_text(content)
            kept.unlink()

        def moved_in(to, content):
            new = to.with_name(".new")
            new.write_text(content)
            os.utime(new, (1e9, 1e9))  # older than what it replaces
            new.replace(to)

        changes("image of a material", lambda: (folder / "images" / "grey.ppm").write_text(image("200 60 60")))
        changes("image of a light, by renaming", lambda: renamed(folder / "images" / "light.ppm", image("60 255 60")))
        changes("image of the sky, by another file", lambda: moved_in(folder / "images" / "sky.ppm", "P3 4 2 255\n" + "20 20 80 " * 8))
        changes("mesh", lambda: (folder / "meshes" / "wall.obj").write_text(mesh(0.6)))
        changes("buffer of a mesh", lambda: (folder / "meshes" / "quad.bin").write_bytes(struct.pack("<9f", -0.6, 0, 0.1, -0.2, 0, 0.1, -0.3, 0.3, 0.1)))
        count = window.log().count("read again")
        (folder / "meshes" / "parts" / "wall.mtl").write_text("newmtl wall\nKd 1 1 1\n")  # looks the same
        until(lambda: window.log().count("read again") > count, "library of a mesh")

        # The scene names an image in another folder, which comes later.
        later = folder / "elsewhere" / "later.ppm"
        count = window.log().count("later.ppm")
        file.write_text(text.replace("images/grey.ppm", "elsewhere/later.ppm"))
        until(lambda: window.log().count("later.ppm") > count, "what is missing")
        self.assertTrue(window.picture(340) == seen)
        changes("image that was missing", lambda: later.write_text(image("60 60 200")))
        changes("image in the new folder", lambda: later.write_text(image("250 250 20")))
        count = window.log().count("read again")
        (folder / "images" / "grey.ppm").write_text(image("1 1 1"))
        time.sleep(0.6)
        self.assertEqual(window.log().count("read again"), count)  # nobody shows it any more

        # Edits that are not saved stay, and so does their undo.
        before = seen
        window.do("mousemove", LIGHT[0] + 40, LIGHT[1] - 20, "click", "1")
        window.drag((LIGHT[0] + 70, LIGHT[1]), (LIGHT[0] + 130, LIGHT[1]))
        seen = window.picture(340)
        self.assertFalse(seen == before)
        changes("image beside edits", lambda: later.write_text(image("20 250 250")))
        edited = seen
        window.do("key", "ctrl+s")
        until(lambda: "saved" in window.log(), "save")
        self.assertGreater(tomllib.loads(file.read_text())["light"][0]["position"][0], 0.2)
        window.do("key", "ctrl+z")
        self.assertFalse(window.picture(340) in (edited, before))  # the light where it was, the image as it is now
        window.leave()

    def test_view_transforms(self):
        """The menu, each entry once, on a surface of one known radiance."""
        techniques = FOLDER / "flat" / "techniques"
        techniques.mkdir(parents=True, exist_ok=True)
        (techniques / "mine.glsl").write_text(TECHNIQUE % (0.25, WHOLE))
        config = FOLDER / "config.ocio"
        config.write_text(OCIO)
        file = FOLDER / "panel.toml"
        file.write_text(SCENE)
        window = Window("test_view_transforms", file, "--glsl", techniques.parent, "--technique", "mine", OCIO=str(config))
        self.addCleanup(window.end)
        window.rest()
        srgb = lambda v: 1.055 * v ** (1 / 2.4) - 0.055
        v = 0.25
        aces = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081)  # its matrices' rows sum to 1
        log = (math.log2(v) + 12.47393) / (4.026069 + 12.47393)
        agx = 15.5 * log ** 6 - 40.14 * log ** 5 + 31.96 * log ** 4 - 6.868 * log ** 3 + 0.4298 * log ** 2 + 0.1191 * log - 0.00232
        expected = [("sRGB", srgb(v)), ("ACES", srgb(aces)), ("Neutral", srgb(v - 0.04)), ("AgX", agx), ("OCIO", v ** (1 / 2.2)), ("raw", v)]
        for i, (name, code) in enumerate(expected):
            window.do("mousemove", 770, 23, "click", "1")
            window.do("mousemove", 770, 50 + 21 * i, "click", "1", "mousemove", 100, 500)
            rows = read_png(window.settled(), 321)[2]
            self.assertLessEqual(max(abs(c - 255 * code) for c in rows[320][3 * 300:3 * 301]), 1.3, name)
        window.leave()
        broken = FOLDER / "broken.ocio"
        broken.write_text("not: [a config")
        result = arealab("view", file, "--technique", "point", "--size", "320x240", "--frames", 1, OCIO=str(broken))
        self.assertEqual(result.returncode, 0)
        self.assertRegex(result.stderr, r"^\S*broken.ocio: .*; expected an OpenColorIO configuration in OCIO, or none\n$")

    def test_layouts_and_snapshots(self):
        """Surfaces of one known radiance each under every way to compare them."""
        techniques = FOLDER / "levels" / "techniques"
        techniques.mkdir(parents=True, exist_ok=True)
        levels = {"one": 0.4, "two": 0.1, "three": 0.2, "four": 0.8}
        for name, level in levels.items():
            (techniques / f"{name}.glsl").write_text(TECHNIQUE % (level, WHOLE))
        window = self.window(self.scene(), "--glsl", techniques.parent, *(word for name in levels for word in ("--technique", name)), "--layout", "wipe")
        codes = {name: 255 * (1.055 * level ** (1 / 2.4) - 0.055) for name, level in levels.items()}
        at = lambda rows, x, y: tuple(rows[y][3 * x:3 * x + 3])
        close = lambda seen, name: max(abs(c - codes[name]) for c in seen) <= 1.3
        left, right = (100, 480), (WIDTH - 100, 480)

        rows = read_png(window.settled())[2]
        self.assertTrue(close(at(rows, *left), "one") and close(at(rows, *right), "two"))
        window.do("key", "x")
        rows = read_png(window.settled())[2]
        self.assertTrue(close(at(rows, *left), "two") and close(at(rows, *right), "one"))
        window.do("key", "x")

        # (0.4 − 0.1)/0.1 is beyond the scale's end, as its legend has it at the right; (0.1 − 0.4)/0.4 is within it; of A from A nothing is left.
        window.do("key", "3")
        rows = read_png(window.settled())[2]
        end = at(rows, *left)
        self.assertGreater(end[0], end[2] + 40)  # orange
        self.assertIn(bytes(end), [rows[547][3 * x:3 * x + 3] for x in range(WIDTH - 40, WIDTH)])
        window.do("key", "x")
        below = at(read_png(window.settled())[2], *left)
        self.assertGreater(below[2], below[0] + 40)  # blue
        window.do("key", "x")

        # Each in its turn, half a second long.
        window.do("key", "4")
        window.rest()
        seen = set()

        def both():
            pixel = at(read_png(window.shot())[2], *left)
            self.assertTrue(close(pixel, "one") or close(pixel, "two"))
            seen.add(close(pixel, "one"))
            return len(seen) == 2

        until(both, "both pictures in turn")

        # Four at once by one camera.
        window.do("key", "5")
        cells = [(0, 0), (379, 0), (0, 278), (379, 278)]
        column = lambda rows, cell: [rows[BAR + cell[1] + y][3 * (cell[0] + 340)] > 60 for y in range(60, 270)]  # at its right edge

        def grid():
            rows = read_png(window.settled())[2]
            for name, (x, y) in zip(levels, cells):
                self.assertTrue(close(at(rows, x + 300, BAR + y + 250), name), name)
            patterns = [column(rows, cell) for cell in cells]
            self.assertEqual(patterns.count(patterns[0]), 4)
            return patterns[0]

        first = grid()
        window.drag((479, BAR + 378), (479, BAR + 400))  # in the fourth
        turned = grid()
        self.assertNotEqual(turned, first)
        self.assertIn(True, turned)

        # A snapshot stays as it was: of A, from before the next turn, in pane B.
        window.do("key", "2", "key", "k")
        until(lambda: "kept #1 one" in window.log(), "snapshot")
        window.do("key", "x", "mousemove", 52, 558, "click", "1", "mousemove", 100, 500)
        rows = read_png(window.settled())[2]
        self.assertTrue(close(at(rows, *left), "two") and close(at(rows, *right), "one"))
        edge = lambda rows, x: [rows[y][3 * x] > 60 for y in range(BAR + 40, WINDOW[1] - 80)]
        before = edge(rows, left[0] + 60), edge(rows, right[0])
        window.drag((200, 440), (200, 400))
        rows = read_png(window.settled())[2]
        self.assertNotEqual(edge(rows, left[0] + 60), before[0])
        self.assertEqual(edge(rows, right[0]), before[1])
        window.do("mousemove", 52, 558, "click", "3", "mousemove", 100, 500)  # thrown away: B is what it was of
        rows = read_png(window.settled())[2]
        self.assertTrue(close(at(rows, *right), "one"))
        self.assertNotEqual(edge(rows, right[0]), before[1])
        window.leave()

    def test_costs_and_effects(self):
        """The panel's figures are those of the commands, and a switched effect's picture is that of the variant without it."""
        file = self.scene()
        window = self.window(file, "--technique", "ltc")
        window.rest()
        window.do("mousemove", WIDTH + 182, 67, "click", "1", "mousemove", WIDTH + 24, 103, "click", "1", "mousemove", 100, 500)  # the tab of the shading, its measuring
        window.rest()
        window.do("mousemove", WIDTH + 302, 67, "click", "1", "mousemove", WIDTH + 24, 521)  # the tab of the view, the diffuse lobe
        window.do("click", "1", "mousemove", 100, 500)
        seen = read_png(window.settled())[2]
        arealab("render", file, "--technique", "ltc+effect_diffuse=0", "--size", f"{WIDTH}x{WINDOW[1] - BAR}", "-o", "matte.png", "--context", "osmesa")
        rendered = read_png((FOLDER / "matte.png").read_bytes())[2]
        for y in range(300, 500):
            self.assertLessEqual(max(abs(a - b) for a, b in zip(seen[BAR + y][:3 * WIDTH], rendered[y])), 1)
        self.assertGreater(max(max(row) for row in rendered[300:500]), 20)
        # Another picture is measured anew, and how the time went is drawn.
        window.do("mousemove", WIDTH + 182, 67, "click", "1")
        window.drag((100, 480), (140, 480))
        window.do("mousemove", 100, 560)
        rows = read_png(window.settled(), 282)[2]
        orange = [x for x in range(WIDTH + 150, WIDTH + 320) if any(row[3 * x] > row[3 * x + 2] + 60 for row in rows[242:282])]
        self.assertGreater(len(orange), 150)
        cost = window.leave()["cost"]
        self.assertGreaterEqual(len(cost["history_ns_per_pixel"]["ltc"]), 2)
        self.assertGreater(min(cost["history_ns_per_pixel"]["ltc"]), 0.0)
        self.assertGreater(cost["ratio_to_point"]["ltc"], 1.0)
        full = lambda variant: json.loads(arealab("cost", "--scene", file, "--technique", variant, "--gpu", "bonaire", "--json").stdout)["variants"][0]["isa"]["bonaire"]["full"]["cycles"]
        self.assertEqual(cost["cycles"]["ltc"], full("ltc+effect_diffuse=0"))
        self.assertEqual(cost["cycles_of_effects"]["fresnel"], cost["cycles"]["ltc"] - full("ltc+effect_diffuse=0+effect_fresnel=0"))

    def test_edits_and_reloads_keep_memory_flat(self):
        """AREALAB_EDITS of them, a thousand for the figure of the README."""
        edits = int(os.environ.get("AREALAB_EDITS", "60"))
        techniques = FOLDER / "reloads" / "techniques"
        techniques.mkdir(parents=True, exist_ok=True)
        shader = techniques / "mine.glsl"
        shader.write_text(TECHNIQUE % (0.2, WHOLE))
        window = self.window(self.scene(), "--glsl", techniques.parent, "--technique", "mine")
        window.rest()
        memory = lambda: int(Path(f"/proc/{window.process.pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1e6

        def work(count):
            moves = []
            for i in range(count * 4 // 5):
                moves += ["mousemove", str(LIGHT[0] + 70 + (i % 40 if i % 80 < 40 else 40 - i % 40)), str(LIGHT[1]), "sleep", "0.02"]
            hand = threading.Thread(target=window.do, args=("mousemove", LIGHT[0] + 70, LIGHT[1], "mousedown", "1", *moves, "mouseup", "1"))
            hand.start()
            for i in range(count // 5):
                shader.write_text(TECHNIQUE % (0.2 + 0.6 * i / count, WHOLE))
                time.sleep(0.22)
            hand.join()
            window.do("key", "ctrl+z")
            window.rest()

        work(30)
        before = memory()
        work(edits)
        print(f"{edits} edits and reloads: {before:.0f} MB before, {memory():.0f} MB after", file=sys.stderr)
        self.assertLess(memory() - before, 80.0)  # a few pictures, which come and go; an edit's alone are 25
        window.leave()

    def test_move_a_light_type_a_roughness_undo_save_reopen(self):
        file = self.scene()
        window = self.window(file, "--technique", "ltc")
        window.rest()
        window.do("mousemove", LIGHT[0] + 40, LIGHT[1] - 20, "click", "1")
        window.drag((LIGHT[0] + 70, LIGHT[1]), (LIGHT[0] + 130, LIGHT[1]))  # by the arrow along x
        window.rest()
        window.do("key", "ctrl+s")
        until(lambda: "saved" in window.log(), "save")
        moved = tomllib.loads(file.read_text())["light"][0]["position"]
        self.assertGreater(moved[0], 0.2)
        self.assertEqual(moved[1:], [1.9, 0.75])
        self.assertIn("# metres", file.read_text())

        window.do("mousemove", WIDTH + 108, 68, "click", "1")  # the tab with the materials
        window.do("mousemove", WIDTH + 250, 190, "keydown", "ctrl", "click", "1", "keyup", "ctrl")
        window.do("key", "ctrl+a", "type", "0.25")
        window.do("key", "Return")
        window.rest()
        window.do("key", "ctrl+s")
        until(lambda: "roughness = 0.25  # as sanded" in file.read_text(), "saved roughness")
        window.do("key", "ctrl+z")
        window.do("key", "ctrl+z")
        window.rest()
        window.do("key", "ctrl+s")
        until(lambda: file.read_text() == SCENE, "file as it was before the edits")

        # A crash loses a few seconds of work at most, and the next start offers the rest.
        window.drag((LIGHT[0] + 70, LIGHT[1]), (LIGHT[0] + 130, LIGHT[1]))
        left = FOLDER / "state" / "arealab"
        x = lambda kept: tomllib.loads(kept.read_text())["light"][0]["position"][0]
        until(lambda: left.is_dir() and any(x(kept) > 0.2 for kept in left.glob("*.toml")), "autosave of the whole move")
        window.end()
        self.assertEqual(file.read_text(), SCENE)
        window = self.window(file, "--technique", "ltc")
        window.rest()
        window.do("key", "ctrl+r")
        until(lambda: "brought back" in window.log(), "offer taken")
        window.do("key", "ctrl+s")
        until(lambda: file.read_text() != SCENE, "saved again")
        self.assertGreater(tomllib.loads(file.read_text())["light"][0]["position"][0], 0.2)
        window.leave()
        self.assertEqual(arealab("render", file, "--technique", "ltc", "--size", "16x16", "-o", "again.png").returncode, 0)

    def test_numbers_redo_lobes_and_what_is_remembered(self):
        file = FOLDER / "s.toml"  # its name stands before the bar's buttons
        file.write_text(SCENE)
        window = self.window(file, "--technique", "ltc", "--technique", "point")
        window.rest()
        window.do("mousemove", LIGHT[0] + 40, LIGHT[1] - 20, "click", "1")
        radiance = lambda: tomllib.loads(file.read_text())["light"][0]["radiance"]

        def type_into(y, text):
            window.do("mousemove", WIDTH + 250, y, "keydown", "ctrl", "click", "1", "keyup", "ctrl", "key", "ctrl+a", "type", text)
            window.do("key", "Return")
            window.rest()
            window.do("key", "ctrl+s")

        def saved(what, condition):
            window.rest()
            window.do("key", "ctrl+s")
            until(condition, what)

        type_into(378, "33.93")  # the flux, W: π · 2 m · 0.9 m · 6 W/(m² sr)
        until(lambda: radiance() != 3.0, "saved flux")
        self.assertLess(abs(radiance() - 6.0), 0.01)
        window.do("key", "ctrl+z")
        saved("file before the edit", lambda: file.read_text() == SCENE)
        window.do("key", "ctrl+shift+z")
        saved("edit once more", lambda: radiance() != 3.0)
        type_into(408, "2700")  # the colour temperature, K
        until(lambda: "color = [" in file.read_text(), "saved colour")
        red, green, blue = tomllib.loads(file.read_text())["light"][0]["color"]
        self.assertGreater(red, green)
        self.assertGreater(green, 1.5 * blue)
        self.assertLess(abs(radiance() - 6.0), 0.01)  # as bright as it was

        pictures = [window.picture()]
        window.do("key", "3")  # the difference
        pictures.append(window.picture())
        for x, y in [(268, 298), (188, 298)]:  # magnitude, signed
            window.do("mousemove", WIDTH + 302, 67, "click", "1", "mousemove", WIDTH + x, y, "click", "1", "mousemove", 100, 500)
            pictures.append(window.picture())
        self.assertTrue(pictures[1] == pictures[3])
        for entry in (72, 93):  # the diffuse lobe's, the specular one's
            window.do("mousemove", 720, 22, "click", "1")
            window.rest()
            window.do("mousemove", 720, entry, "click", "1", "mousemove", 100, 500)
            pictures.append(window.picture())
        for i, j in [(0, 1), (1, 2), (1, 4), (1, 5), (4, 5)]:
            self.assertFalse(pictures[i] == pictures[j], (i, j))
        window.leave()
        window = self.window(file)  # the layout is as it was left
        left = window.picture()
        window.do("key", "3")
        self.assertTrue(window.picture() == left)
        window.do("key", "2")
        self.assertFalse(window.picture() == left)
        window.leave()

    def test_knobs_and_options_of_a_header(self):
        """They become sliders and menus, with what the header says of them, of a file that comes while the window is open."""
        folder = FOLDER / "playground" / "techniques"
        folder.mkdir(parents=True)
        window = self.window(self.scene(), "--glsl", folder.parent, "--technique", "ltc")
        window.rest()
        text = TECHNIQUE.replace("[[knob]]", '[[option]]\nname = "share"\nsummary = "How much of it"\nchoices = [["whole", "all"], ["half", "one of two"]]\n\n[[knob]]')
        text = text.replace('unit = ""', 'unit = "m"').replace("max = 1.0", "max = 0.5")
        (folder / "aim.glsl").write_text(text % (0.1, "return Radiance(vec3(SHARE_HALF == 1 ? 0.5 * knob_level : knob_level), vec3(0.0));"))
        time.sleep(0.7)
        # The second of pane A's menu, by the alphabet; and the tab of the shading.
        window.do("mousemove", 200, 23, "click", "1", "sleep", "0.2", "mousemove", 200, 72, "click", "1", "sleep", "0.2", "mousemove", WIDTH + 182, 67, "click", "1")
        window.do("mousemove", 100, 560)
        code = lambda v: 255 * (1.055 * v ** (1 / 2.4) - 0.055)
        seen = lambda: read_png(window.settled(), 481)[2][480][3 * 300]
        self.assertLess(abs(seen() - code(0.1)), 1.3)
        window.do("mousemove", WIDTH + 250, 171, "click", "1", "sleep", "0.2", "mousemove", WIDTH + 200, 171 + 27 + 21, "click", "1", "mousemove", 100, 560)
        self.assertLess(abs(seen() - code(0.05)), 1.3)
        window.do("mousemove", WIDTH + 250, 201, "keydown", "ctrl", "click", "1", "keyup", "ctrl", "key", "ctrl+a", "type", "0.4")
        window.do("key", "Return", "mousemove", 100, 560)
        self.assertLess(abs(seen() - code(0.2)), 1.3)
        window.drag((WIDTH + 250, 201), (WIDTH + 342, 201))  # to the end of its range
        window.do("mousemove", 100, 560)
        self.assertLess(abs(seen() - code(0.25)), 1.3)
        window.leave()

    def test_a_shader_is_read_again_broken_and_mended(self):
        folder = FOLDER / "glsl" / "techniques"
        folder.mkdir(parents=True, exist_ok=True)
        for old in folder.iterdir():
            old.unlink()
        shader = folder / "mine.glsl"
        shader.write_text(TECHNIQUE % (0.2, WHOLE))
        window = self.window(self.scene(), "--glsl", folder.parent, "--technique", "mine")
        first = window.picture()
        shader.write_text(TECHNIQUE % (0.2, "return Radiance(vec3(knob_levle), vec3(0.0));"))
        until(lambda: "mine.glsl:22:" in window.log(), "error with file and line")
        self.assertTrue(window.picture() == first)  # the last good picture stays
        shader.write_text(TECHNIQUE % (0.8, WHOLE))
        saved = time.monotonic()
        until(lambda: read_png(window.shot(), 441)[2][440][3 * 300:3 * 301] != first[440 - BAR - 40][3 * 292:3 * 293], "mended picture")
        print(f"{time.monotonic() - saved:.2f} s from a shader's save to its picture (promised: 0.5 on a machine at rest)", flush=True)
        window.leave()


if __name__ == "__main__":
    PROGRAM, FOLDER = str(Path(sys.argv[1]).resolve()), Path(sys.argv[2]).resolve()
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    reader, writer = os.pipe()
    # Else it starts anew when its last client goes, and the next finds it away.
    server = subprocess.Popen(["Xvfb", "-noreset", "-displayfd", str(writer), "-screen", "0", "1280x800x24", "-nolisten", "tcp"],
                              pass_fds=[writer], stderr=subprocess.DEVNULL)
    os.close(writer)
    DISPLAY = ":" + os.read(reader, 16).decode().strip()
    try:
        unittest.main(argv=sys.argv[:1] + sys.argv[3:], verbosity=2)
    finally:
        server.terminate()
        server.wait()

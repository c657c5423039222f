#!/usr/bin/env python3
"""Writes the fuzzers' seeds, a few hundred bytes each, into tests/fuzz/corpus: python3 tests/fuzz/make_corpus.py"""
import base64
import json
import os
import struct
import zlib

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "corpus")


def write(target, name, data):
    os.makedirs(os.path.join(ROOT, target), exist_ok=True)
    with open(os.path.join(ROOT, target, name), "wb") as file:
        file.write(data if isinstance(data, bytes) else data.encode())


# Scenes: between them every key.
CAMERA = "[camera]\nposition = [0.0, -4.0, 1.9]\ntarget = [0.0, 0.3, 0.1]\nup = [0, 0, 1]\nvertical_fov = 40.0\n"
FLOOR = '[[material]]\nname = "floor"\nbase_color = 0.5\nroughness = 0.3\n[[surface]]\ntype = "plane"\nsize = [3, 5]\nmaterial = "floor"\n'
PANEL = '[[light]]\nname = "panel"\nshape = "rectangle"\nposition = [0, 2, 1]\nnormal = [0, -1, -0.2]\nsize = [3, 1]\nradiance = 7.0\n'
write("scene", "plane.toml", "# What?\nexposure = 0.5\n" + CAMERA + FLOOR + PANEL)
write("scene", "shapes.toml", 'units = "photometric"\nbrdf = "beckmann"\n[sky]\nluminance = [1, 2, 3]\n' + CAMERA +
      '[[material]]\nname = "a"\nbase_color = [0.1, 0.2, 0.3]\nroughness = [0.0, 1.0]\nspecular = 0.5\n'
      '[[material]]\nname = "b"\nmetalness = 1.0\n'
      '[[surface]]\ntype = "box"\nsize = [1, 1, 1]\nrotation = [10, 20, 30]\nmaterial = "a"\n'
      '[[surface]]\ntype = "sphere"\nradius = 0.5\nposition = [1, 0, 0.5]\nmaterial = "b"\n'
      '[[light]]\nshape = "disk"\nposition = [0, 1, 2]\ntarget = [0, 0, 0]\nup = [0, 1, 0]\nradius = 0.4\nluminance = 100\ncolor = [1, 0.5, 0.2]\ntwo_sided = true\n'
      '[[light]]\nshape = "sphere"\nposition = [1, 1, 1]\nradius = 0.2\nluminous_flux = 800\n'
      '[[light]]\nshape = "ellipse"\nposition = [1, 1, 2]\nrotation = [0, 180, 0]\nradii = [0.5, 0.2]\nluminance = [1, 2, 3]\n'
      '[[light]]\nshape = "polygon"\nposition = [0, 0, 3]\nnormal = [0, 0, -1]\ncorners = [[0, 0], [1, 0], [1.2, 0.8], [0, 1]]\nluminance = 9\n')
write("scene", "files.toml", CAMERA +
      '[aperture]\nrays = 64\ncell = 0.5\n'
      '[[material]]\nname = "m"\nbase_color_texture = "image.ppm"\nmetallic_roughness_texture = "image.ppm"\nnormal_texture = "image.ppm"\nnormal_scale = 0.7\n'
      '[[surface]]\ntype = "mesh"\nfile = "mesh.obj"\nheight = 1.0\nup = "y"\nmaterial = "m"\n'
      '[[surface]]\ntype = "mesh"\nfile = "mesh.obj"\nscale = [1, 2, 3]\nmaterial = "m"\n'
      '[[surface]]\ntype = "height_field"\nsize = [2, 2]\nheight = 0.1\nformula = "dunes"\nwavelength = 0.5\ncells = [4, 5]\nmaterial = "m"\n'
      '[[surface]]\ntype = "height_field"\nsize = [2, 2]\nheight = 0.1\nimage = "image.ppm"\nmaterial = "m"\n'
      '[[light]]\nshape = "rectangle"\nposition = [0, 2, 1]\ntarget = [0, 0, 0]\nsize = [3, 1]\nflux = 70\ntexture = "image.ppm"\n')

# Technique headers.
LEAST = 'summary = "s"\ncitation = "c"\nauthor_note = "n"\nshapes = ["rectangle"]\nlobes = ["diffuse"]\nbrdfs = ["ggx"]\n'
write("technique", "least.glsl", "/*---\n" + LEAST + "---*/\n")
write("technique", "options.glsl", "/*---\n" + LEAST.replace('["diffuse"]', '["diffuse", "specular"]') +
      'effects = ["two_sided", "fresnel"]\nexact = ["lambert_rectangle", "point_limit"]\nyardstick = true\n'
      '[[option]]\nname = "norm"\nsummary = "x"\nchoices = [["exact", "slow"], ["fast", "quick", { fit = "l3" }]]\n'
      '[[option]]\nname = "fit"\nsummary = "y"\nchoices = [["polygon", "a"], ["l3", "b", { brdf = "ggx", shape = "rectangle" }]]\n'
      '[published]\nnorm = "fast"\nfit = "l3"\n[ideal]\nnorm = "exact"\n[tables]\nmatrix = "ltc_{brdf}_{fit}.exr"\n---*/\nfloat f;\n')
write("technique", "knobs.glsl", "/*---\n" + LEAST +
      '[[knob]]\nname = "bias"\nlabel = "Bias"\nunit = "m"\ninitial = 0.0\nmin = -1.0\nmax = 1.0\n'
      '[[departs]]\nlaw = "mirror_limit"\nlobe = "diffuse"\nwhen = { shape = ["rectangle"], brdf = "ggx" }\nerror = 0.35\nwhy = "w"\n---*/\n')

write("technique", "two_lines.glsl", "/*---\nsummary = \"s\"\ncitation = t\nauthor_note = \"n\"\n---*/\n")  # its error had two lines

# Textures: the first byte is the suffix' place in png, jpg, exr, hdr, tga, tif.


def png(width, height, kind, channels, bits=8):
    row = b"\0" + bytes((37 * i) % 256 for i in range(width * channels * bits // 8))
    chunk = lambda name, data: struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, bits, kind, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(row * height)) + chunk(b"IEND", b""))


def jpeg():
    """8 × 8 grey pixels: one code for "no change", one for "end of block"."""
    segment = lambda marker, data: struct.pack(">BBH", 0xff, marker, len(data) + 2) + data
    return (b"\xff\xd8" + segment(0xdb, b"\0" + b"\x10" * 64) + segment(0xc0, struct.pack(">BHHB", 8, 8, 8, 1) + b"\x01\x11\0") +
            segment(0xc4, b"\0" + b"\x01" + b"\0" * 15 + b"\0") + segment(0xc4, b"\x10" + b"\x01" + b"\0" * 15 + b"\0") +
            segment(0xda, b"\x01\x01\0\0\x3f\0") + b"\x3f\xff\xd9")


def exr():
    """2 × 2 floats, one channel, not compressed."""
    attribute = lambda name, kind, data: name + b"\0" + kind + b"\0" + struct.pack("<I", len(data)) + data
    box = struct.pack("<4i", 0, 0, 1, 1)
    header = (struct.pack("<II", 20000630, 2) + attribute(b"channels", b"chlist", b"Y\0" + struct.pack("<IIII", 2, 0, 1, 1) + b"\0") +
              attribute(b"compression", b"compression", b"\0") + attribute(b"dataWindow", b"box2i", box) +
              attribute(b"displayWindow", b"box2i", box) + attribute(b"lineOrder", b"lineOrder", b"\0") +
              attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1)) +
              attribute(b"screenWindowCenter", b"v2f", struct.pack("<2f", 0, 0)) +
              attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)) + b"\0")
    start = len(header) + 16
    return header + struct.pack("<QQ", start, start + 16) + b"".join(struct.pack("<iI2f", y, 8, 0.5, 2.0 + y) for y in range(2))


def tiff():
    """2 × 2 grey bytes."""
    entries = [(256, 3, 2), (257, 3, 2), (258, 3, 8), (259, 3, 1), (262, 3, 1), (273, 4, 122), (277, 3, 1), (278, 3, 2), (279, 4, 4)]
    directory = struct.pack("<H", len(entries)) + b"".join(struct.pack("<HHII", tag, kind, 1, value) for tag, kind, value in entries)
    return b"II*\0" + struct.pack("<I", 8) + directory + struct.pack("<I", 0) + bytes([10, 80, 160, 250])


write("texture", "rgba.png", b"\0" + png(3, 2, 6, 4))
write("texture", "grey16.png", b"\0" + png(2, 2, 0, 1, 16))
write("texture", "grey.jpg", b"\1" + jpeg())
write("texture", "float.exr", b"\2" + exr())
write("texture", "light.hdr", b"\3#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + bytes([128, 64, 32, 129, 200, 100, 50, 128]))
write("texture", "rgb.tga", b"\4" + struct.pack("<BBBHHBHHHHBB", 0, 0, 2, 0, 0, 0, 0, 0, 2, 2, 24, 32) + bytes(range(12)))
write("texture", "grey.tif", b"\5" + tiff())

# Meshes: gltf, glb, obj, ply, stl, 3ds; a triangle each.
CORNERS = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)]
POSITIONS = b"".join(struct.pack("<3f", *corner) for corner in CORNERS)


def gltf(buffer):
    return {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "translation": [0, 0, 1]}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
            "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.4, 0.3, 1], "metallicFactor": 0.1, "roughnessFactor": 0.6}}],
            "buffers": [buffer], "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                          {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}]}


DATA = POSITIONS + struct.pack("<4H", 0, 1, 2, 0)


def glb():
    text = json.dumps(gltf({"byteLength": len(DATA)}), separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(DATA), b"BIN\0") + DATA
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body


def three_ds():
    chunk = lambda name, data: struct.pack("<HI", name, len(data) + 6) + data
    faces = chunk(0x4120, struct.pack("<H4H", 1, 0, 1, 2, 7))
    mesh = chunk(0x4100, chunk(0x4110, struct.pack("<H", 3) + POSITIONS) + faces)
    return chunk(0x4d4d, chunk(0x3d3d, chunk(0x4000, b"t\0" + mesh)))


write("mesh", "triangle.gltf",
      b"\0" + json.dumps(gltf({"byteLength": 44, "uri": "data:application/octet-stream;base64," + base64.b64encode(DATA).decode()}),
                        separators=(",", ":")).encode())
write("mesh", "triangle.glb", b"\1" + glb())
write("mesh", "quad.obj", b"\2v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\no a\ng b\nusemtl m\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf -3//1 -2//1 -1//1\n")
write("mesh", "ascii.ply", b"\3ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      b"element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")
write("mesh", "binary.ply", b"\3ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      b"element face 1\nproperty list uchar int vertex_indices\nend_header\n" + POSITIONS + struct.pack("<B3i", 3, 0, 1, 2))
write("mesh", "ascii.stl", b"\4solid t\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid t\n")
write("mesh", "binary.stl", b"\4" + b"\0" * 80 + struct.pack("<I3f", 1, 0, 0, 1) + POSITIONS + b"\0\0")
write("mesh", "triangle.3ds", b"\5" + three_ds())

# Found: each once hung or crashed the reader.
write("mesh", "cut_header.ply", b"\3ply\nformat ascii 1.0\nelement vertex 3\npr")
write("mesh", "index.ply", b"\3ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      b"element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 999999\n")
write("mesh", "no_end.ply", b"\3ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      b"element face 1\nproperty list uchar int vertex_indicsnee\n_dheader\n" + POSITIONS + struct.pack("<B3i", 3, 0, 1, 2))

# Cache entries: 0, 2, 4 are the files of a truth, of a band of its rows, of apertures; 1, 3, 5 what a sound envelope holds.
TRUTH = struct.pack("<QQQd", 7, 2, 1, 0.5) + struct.pack("<14f", *[0.1 * i for i in range(14)])
write("cache", "truth", b"\1" + TRUTH)
write("cache", "rows", b"\3" + TRUTH)
write("cache", "apertures", b"\5" + struct.pack("<64f", *[0.5] * 64))
write("cache", "envelope", b"\0ALCACHE1" + b"\0" * 8 + TRUTH)
write("cache", "aperture_envelope", b"\4ALCACHE1" + b"\0" * 8 + b"\0" * 256)

# results.json.
METRICS = {name: 0.07 for name in ("rel_rmse", "bias", "relmse", "mae", "p99", "max", "flip")}


def variant(name):
    cost = {"instructions": 500, "cycles": 2000}
    return {"name": name, "short_name": name, "supported": True, "reason": None, "error": {lobe: METRICS for lobe in ("total", "diffuse", "specular")},
            "time": {"ns_per_pixel": 90.0, "ns_interval": [80, 100], "ratio_to_point": 3.0, "ratio_interval": [2.9, 3.1]},
            "isa": {"bonaire": {"core": cost, "full": cost}}}


def results(value):
    return {"schema": 1, "version": "0.1.0", "isa_compilers": "radv",
            "scenes": [{"name": "gloss", "width": 8, "height": 8, "lit_pixels": 64, "truth": {"relative_error": 1e-4},
                        "variants": [variant("ltc"), variant("point")],
                        "sweep": {"axis": "lights", "title": "lights", "logarithmic": True, "value": value}}]}


write("results", "sweep.json", json.dumps(results(4), separators=(",", ":")))
unmeasured = results(1)
unmeasured["scenes"][0]["variants"][0]["time"] = {"ns_per_pixel": None, "ns_interval": None, "ratio_to_point": None, "ratio_interval": None}
unmeasured["scenes"][0]["variants"][1]["supported"] = False
write("results", "unmeasured.json", json.dumps(unmeasured, indent=1))
other = results(2)
other["scenes"][0]["width"] = 16
write("results", "other_size.json", json.dumps(other, separators=(",", ":")))

#!/usr/bin/python3
"""The exported GLSL ES 3.00 pass in headless Chromium's WebGL 2, against AreaLab's own picture.

usage: export_webgl_test.py COMPARE_TESTS FOLDER
COMPARE_TESTS (Export.WritesTheSampleForTheBrowserTest) exports to FOLDER first.
"""
import json
import os
import re
import subprocess
import sys
from pathlib import Path

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service

TOLERANCE = 1e-4  # of the lobe's largest radiance

PAGE = r"""
const {text, sample, tables, inputs} = arguments[0];
const gl = document.createElement("canvas").getContext("webgl2");
if (!gl) return {error: "no WebGL 2"};
for (const name of ["EXT_color_buffer_float", "OES_texture_float_linear"]) if (!gl.getExtension(name)) return {error: "no " + name};
const compile = (kind, source) => {
  const shader = gl.createShader(kind);
  gl.shaderSource(shader, source);
  gl.compileShader(shader);
  if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
  return shader;
};
const program = gl.createProgram();
gl.attachShader(program, compile(gl.VERTEX_SHADER, `#version 300 es
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }`));
gl.attachShader(program, compile(gl.FRAGMENT_SHADER, text));
gl.linkProgram(program);
if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
gl.useProgram(program);
const texture = (width, height, texels, filter) => {
  const t = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_2D, t);
  gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, width, height, 0, gl.RGBA, gl.FLOAT, texels && new Float32Array(texels));
  for (const p of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, p, filter);
  for (const p of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T]) gl.texParameteri(gl.TEXTURE_2D, p, gl.CLAMP_TO_EDGE);
  return t;
};
let unit = 0;
const bind = (name, width, height, texels, filter) => {
  gl.activeTexture(gl.TEXTURE0 + unit);
  texture(width, height, texels, filter);
  gl.uniform1i(gl.getUniformLocation(program, name), unit++);
};
const {width, height} = sample;
for (const name in sample.gbuffer) bind(name, width, height, sample.gbuffer[name], gl.NEAREST);
for (const name in tables) bind(name, tables[name].width, tables[name].height, tables[name].texels, gl.LINEAR);
gl.uniform3fv(gl.getUniformLocation(program, "view_position"), sample.view_position);
const block = gl.createBuffer();
gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, block);
gl.bufferData(gl.UNIFORM_BUFFER, new Float32Array(sample.light_rows), gl.STATIC_DRAW);
gl.uniformBlockBinding(program, gl.getUniformBlockIndex(program, inputs.light_block.name), 0);
gl.activeTexture(gl.TEXTURE0 + unit);
gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
for (const i of [0, 1]) {
  gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + i, gl.TEXTURE_2D, texture(width, height, null, gl.NEAREST), 0);
}
gl.drawBuffers([gl.COLOR_ATTACHMENT0, gl.COLOR_ATTACHMENT1]);
gl.viewport(0, 0, width, height);
gl.drawArrays(gl.TRIANGLES, 0, 3);
const seen = {renderer: gl.getParameter(gl.VERSION), error: gl.getError() ? "GL error" : null};
["diffuse", "specular"].forEach((name, i) => {
  gl.readBuffer(gl.COLOR_ATTACHMENT0 + i);
  const texels = new Float32Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.FLOAT, texels);
  seen[name] = Array.from(texels);
});
return seen;
"""


def table(header, name):
    numbers = header[header.index(f" {name}["):]
    numbers = numbers[numbers.index("{") + 1:numbers.index("}")]
    size = lambda which: int(re.search(rf"{name}_{which} = (\d+)", header)[1])
    return {"width": size("width"), "height": size("height"), "texels": [float(n) for n in numbers.split(",") if n.strip()]}


def main():
    program, folder = sys.argv[1], Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    subprocess.run([program, "--gtest_brief=1", "--gtest_filter=Export.WritesTheSampleForTheBrowserTest"], check=True,
                   env={**os.environ, "AREALAB_EXPORT_SAMPLE": str(folder)})
    inputs = json.loads((folder / "inputs.json").read_text())
    sample = json.loads((folder / "sample.json").read_text())
    tables = {t["sampler"]: table((folder / t["c"]).read_text(), t["sampler"]) for t in inputs["tables"]}
    options = Options()
    for flag in ["--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic",
                 "--no-first-run", "--disable-background-networking"]:
        options.add_argument(flag)
    options.binary_location = "/usr/bin/chromium"
    driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    try:
        driver.get("about:blank")
        seen = driver.execute_script(PAGE, {"text": (folder / "ltc.300es.frag").read_text(), "sample": sample, "tables": tables, "inputs": inputs})
    finally:
        driver.quit()
    if seen.get("error"):
        sys.exit(f"the browser says: {seen['error']}")
    failed = False
    for lobe in ("diffuse", "specular"):
        ours = sample["expected"][lobe]
        most = max(map(abs, ours))
        apart = max(abs(ours[3 * i + c] - seen[lobe][4 * i + c]) for i in range(len(ours) // 3) for c in range(3))
        print(f"{lobe}: largest difference {apart / most:.2g} of the largest radiance ({seen['renderer']})")
        failed = failed or not (most > 0 and apart / most <= TOLERANCE)
    sys.exit(1 if failed else 0)


main()

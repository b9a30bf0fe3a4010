"""The shader's way down a shadow tree, in a browser, by the cases that Python and TypeScript are held to."""

import json
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[2]
GOLDEN = ROOT / "spec" / "golden"
GLSL = ROOT / "viewer" / "src" / "scene" / "light" / "lookup.glsl"

MAIN = """#version 300 es
precision highp float; precision highp int; precision highp usampler2D; precision highp isampler2D;
%s
uniform highp isampler2D queries; /* x, y, image, step */
uniform int radius;
uniform int level;
out uvec4 answer;
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  ivec4 query = texelFetch(queries, at, 0);
  ivec2 count = shadowCount(0, query.xyz, uint(query.w), radius, level);
  bool isOn = query.xy == clamp(query.xy, ivec2(0), ivec2((1 << level) - 1));
  answer = uvec4(count, isOn ? shadowValue(0, query.xyz, level) : 0u, 0u);
}
"""

RUN = """([fragment, tree, cases]) => {
  const gl = new OffscreenCanvas(1, 1).getContext("webgl2");
  const compile = (kind, text) => {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    return shader;
  };
  const program = gl.createProgram();
  const vertex = `#version 300 es
  void main() { gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0, 0.0, 1.0); }`;
  gl.attachShader(program, compile(gl.VERTEX_SHADER, vertex));
  gl.attachShader(program, compile(gl.FRAGMENT_SHADER, fragment));
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
  gl.useProgram(program);
  const at = (name) => gl.getUniformLocation(program, name);
  const texture = (unit, internal, format, type, width, height, data) => {
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texStorage2D(gl.TEXTURE_2D, 1, internal, width, height);
    gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, format, type, data);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  };
  const height = Math.ceil(tree.words.length / 64);
  const words = new Uint32Array(64 * height);
  words.set(tree.words);
  texture(0, gl.R32UI, gl.RED_INTEGER, gl.UNSIGNED_INT, 64, height, words);
  gl.uniform1i(at("shadowWords"), 0);
  gl.uniform1i(at("shadowWidthBits"), 6);
  gl.uniform1i(at("shadowLevels"), tree.levels);
  const scales = new Uint32Array(120);
  scales.set(tree.scales);
  gl.uniform4uiv(at("shadowScales"), scales);
  gl.uniform2uiv(at("shadowRoots"), new Uint32Array([0, tree.root, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]));
  gl.uniform1i(at("queries"), 1);
  return cases.map(({ level, radius, queries }) => {
    const count = queries.length / 4;
    texture(1, gl.RGBA32I, gl.RGBA_INTEGER, gl.INT, count, 1, new Int32Array(queries));
    gl.activeTexture(gl.TEXTURE2);
    const target = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, target);
    gl.texStorage2D(gl.TEXTURE_2D, 1, gl.RGBA32UI, count, 1);
    gl.bindFramebuffer(gl.FRAMEBUFFER, gl.createFramebuffer());
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target, 0);
    gl.viewport(0, 0, count, 1);
    gl.uniform1i(at("level"), level);
    gl.uniform1i(at("radius"), radius);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const out = new Uint32Array(4 * count);
    gl.readPixels(0, 0, count, 1, gl.RGBA_INTEGER, gl.UNSIGNED_INT, out);
    if (gl.getError()) throw new Error(`GL error in level ${level}`);
    return [...out];
  });
}"""


def golden():
    cases = json.loads((GOLDEN / "shadow_lookup.json").read_text())
    words = np.fromfile(GOLDEN / "shadow_lookup.bin", "<u4")
    for tree in cases["trees"]:
        start = tree["word_start"]
        tree["words"] = words[start : start + tree["word_count"]].tolist()
    return cases["trees"]


def steps_of(case):
    """As the signed integers that a texture of queries holds."""
    return np.array(case.get("steps", [0] * len(case["pixels"])), np.uint32).view(np.int32)


def asked(page, tree, cases):
    """(n, 4) uint32 a case: lit pixels, pixels on the map, the value."""
    told = [
        {
            "level": case["level"],
            "radius": case.get("radius", 0),
            "queries": np.column_stack([case["pixels"], steps_of(case)]).ravel().tolist(),
        }
        for case in cases
    ]
    kept = {key: tree[key] for key in ("words", "levels", "scales", "root")}
    answers = page.evaluate(RUN, [MAIN % GLSL.read_text(), kept, told])
    return [np.array(answer, np.uint32).reshape(-1, 4) for answer in answers]


@pytest.mark.parametrize("tree", golden(), ids=lambda tree: tree["name"])
def test_the_shader_finds_what_the_golden_cases_say(browser, tree):
    page = browser.new_page()
    try:
        for case, found in zip(tree["values"], asked(page, tree, tree["values"]), strict=True):
            np.testing.assert_array_equal(found[:, 2], case["values"])
        for case, found in zip(tree["lit"], asked(page, tree, tree["lit"]), strict=True):
            off_map = (2 * case["radius"] + 1) ** 2 - found[:, 1].astype(int)
            np.testing.assert_array_equal(found[:, 0] + off_map, case["lit"])
    finally:
        page.close()

/* Key light of the scene with its precomputed shadow (spec/shading.md), after lookup.glsl. */
const int LIGHT_ONE = 0; /* one projection */
const int LIGHT_CUBE = 1; /* six, a tree each */
const int LIGHT_PATH = 2; /* a stack in order of time */
const int LIGHT_AREA = 3; /* a stack of places on an area */
const float LIGHT_STEPS = 1073741824.0;
const float LIGHT_BIAS = 512.0; /* 2048 of 2^-32 */
uniform bool lightIs; /* else it hangs on the camera */
uniform sampler2D lightProjections; /* a projection a row (seenProjection.ts) */
uniform vec3 lightReference; /* what they are told relative to, from the eye */
uniform int lightKind;
uniform int lightRadius; /* of the kernel, in pixels of the map */
uniform bool lightIsFiltered; /* the level follows the footprint of a pixel of the picture */
uniform int lightImages; /* of a stack */
uniform int lightMissing; /* levels of the map that are still on their way */
uniform float lightTime; /* image of a path, between two as well */
uniform int lightSamples; /* images of an area that a pixel asks */
uniform float lightCone; /* least cosine of a spot, or -2 */
uniform bool movingIs; /* some layers cast by an ordinary map */
uniform int movingRow; /* of the projection that it is made for; of a cube all six are, 3 x 2 */
uniform int movingPixels;
uniform usampler2D movingSteps; /* 2^30 - 1 - depth in 2^-30, 0 where nothing is */

/* A place as one projection sees it. */
struct LightView {
  vec2 whole; /* pixel of the reference */
  vec3 at; /* from there, in pixels: numerators of x and y, and W */
  mat3 rows; /* what these change by for a step in the eye's axes, one a column */
  vec3 across; /* the step of one pixel along x where W is 1 */
  vec3 along; /* along y */
  int base; /* depth of the reference, in 2^-30 */
  float rest; /* from there */
  vec3 deeper; /* what that changes by */
  float lost; /* what float32 may lose of it */
};

vec4 lightTexel(int row, int column) {
  return texelFetch(lightProjections, ivec2(column, row), 0);
}

vec3 lightTowards(int row, vec3 place) {
  vec4 light = lightTexel(row, 5);
  return light.w == 0.0 ? light.xyz : normalize(light.xyz - place);
}

/* `place` from the eye. */
LightView lightView(int row, vec3 place) {
  vec4 u = lightTexel(row, 0), v = lightTexel(row, 1), depth = lightTexel(row, 2), w = lightTexel(row, 3);
  vec4 whole = lightTexel(row, 4);
  vec4 d = vec4(place - lightReference, 1.0);
  LightView view;
  view.whole = whole.xy;
  view.at = vec3(dot(u, d), dot(v, d), dot(w, d));
  view.rows = mat3(u.xyz, v.xyz, w.xyz);
  view.across = lightTexel(row, 6).xyz;
  view.along = lightTexel(row, 7).xyz;
  view.base = int(whole.z) * 32768 + int(whole.w);
  view.rest = dot(depth, d);
  view.deeper = depth.xyz;
  view.lost = max(LIGHT_BIAS, 3e-7 * length(depth.xyz) * (length(place) + length(d.xyz)));
  return view;
}

/* The same place moved. */
LightView lightMoved(LightView view, vec3 way) {
  view.at += way * view.rows;
  view.rest += dot(view.deeper, way);
  return view;
}

/* Moved along the normal so far that its own plane is not above it in a kernel of so many pixels around. */
LightView lightLifted(LightView view, vec3 normal, float half_) {
  float slope = half_ * (abs(dot(normal, view.across)) + abs(dot(normal, view.along)));
  float far = view.at.z * slope / max(1.0 - slope * dot(normal, view.rows[2]), 0.5);
  return lightMoved(view, normal * far);
}

ivec2 lightPixel(LightView view) {
  return ivec2(view.whole) + ivec2(clamp(floor(view.at.xy / view.at.z), -1e9, 1e9));
}

/* Depth in 2^-32. */
uint lightStep(LightView view) {
  float rest = clamp(floor(view.rest - view.lost), -LIGHT_STEPS + 64.0, LIGHT_STEPS - 64.0);
  return uint(clamp(view.base + int(rest), 0, 1073741823)) << 2;
}

/* The face of a cube whose axis is nearest: of six frusta of 90 degrees the one with the largest W. */
int lightFace(vec3 place) {
  vec4 d = vec4(place - lightReference, 1.0);
  int best = 0;
  float most = dot(lightTexel(0, 3), d);
  for (int face = 1; face < 6; face++) {
    float weight = dot(lightTexel(face, 3), d);
    if (weight > most) {
      best = face;
      most = weight;
    }
  }
  return best;
}

/* Share of the samples that are lit, on the map that a level is. A pixel off a cube's face lies on another. */
float lightShare(LightView view, int tree, int image, vec3 normal, int level, int radius) {
  int shift = shadowLevels - level;
  float half_ = (float(radius) + (shift + lightMissing > 0 ? 1.0625 : 0.5625)) * float(1 << shift);
  view = lightLifted(view, normal, half_);
  if (view.at.z <= 0.0) return 1.0;
  ivec2 pixel = lightPixel(view) >> shift;
  bool isCube = lightKind == LIGHT_CUBE;
  if (isCube) pixel = clamp(pixel, ivec2(0), ivec2((1 << level) - 1));
  ivec2 count = shadowCount(tree, ivec3(pixel, image >> shift), lightStep(view), radius, level);
  int samples = (2 * radius + 1) * (2 * radius + 1);
  return isCube ? float(count.x) / float(count.y) : float(count.x + samples - count.y) / float(samples);
}

/* As large on the map as a pixel of the picture, whose sides are `right` and `up`: two levels blended. */
float lightFiltered(LightView view, int tree, int image, vec3 normal, vec3 right, vec3 up) {
  vec2 off = view.at.xy / view.at.z;
  vec3 x = right * view.rows, y = up * view.rows;
  vec2 wide = (x.xy - off * x.z) / view.at.z, high = (y.xy - off * y.z) / view.at.z;
  float squared = max(dot(wide, wide), dot(high, high));
  float depth = clamp(0.5 * log2(max(1.0, squared)), 0.0, float(shadowLevels));
  int level = shadowLevels - int(depth);
  float share = lightShare(view, tree, image, normal, level, 1);
  float part = fract(depth);
  return part > 0.0 ? mix(share, lightShare(view, tree, image, normal, max(level - 1, 0), 1), part) : share;
}

/* Of an ordinary map of the moving layers, along the same projection. */
float movingShare(int row, vec3 place, vec3 normal) {
  float pixels = float(movingPixels) / float(1 << shadowLevels);
  LightView view = lightLifted(lightView(row, place), normal, 1.5625 / pixels);
  if (view.at.z <= 0.0) return 1.0;
  ivec2 pixel = ivec2(floor(clamp((view.whole + view.at.xy / view.at.z) * pixels, -1e9, 1e9)));
  uint step_ = lightStep(view) >> 2;
  int lit = 0;
  for (int i = 0; i < 9; i++) {
    ivec2 at = pixel + ivec2(i % 3, i / 3) - 1;
    bool isOff = at != clamp(at, ivec2(0), ivec2(movingPixels - 1));
    if (lightKind == LIGHT_CUBE) at += movingPixels * ivec2(row % 3, row / 3);
    if (isOff || step_ + texelFetch(movingSteps, at, 0).x < 1073741824u) lit++;
  }
  return float(lit) / 9.0;
}

/* Interleaved gradient noise (Jimenez 2014): even over every small neighbourhood. */
float lightNoise() {
  return fract(52.9829189 * fract(dot(floor(gl_FragCoord.xy), vec2(0.06711056, 0.00583715))));
}

/* Sum over what shines on a place: cosine, shadow and cone. `facing` is the triangle's own normal, on the side of the
   eye; `right` and `up` lead to the next pixels' places. */
float lightKey(vec3 normal, vec3 facing, vec3 place, vec3 right, vec3 up) {
  int count = lightKind == LIGHT_AREA ? lightSamples : lightKind == LIGHT_PATH && fract(lightTime) > 0.0 ? 2 : 1;
  float stride = float(lightImages) / float(count);
  float noise = count < lightImages ? lightNoise() : 0.5;
  float sum = 0.0;
  for (int i = 0; i < count; i++) {
    int image = 0;
    float weight = 1.0;
    if (lightKind == LIGHT_AREA) {
      image = min(int((float(i) + noise) * stride), lightImages - 1);
      weight = 1.0 / float(count);
    } else if (lightKind == LIGHT_PATH) {
      image = int(lightTime) + i;
      if (count == 2) weight = i == 0 ? 1.0 - fract(lightTime) : fract(lightTime);
    }
    int face = lightKind == LIGHT_CUBE ? lightFace(place) : 0;
    int row = lightKind == LIGHT_CUBE ? face : image;
    vec3 towards = lightTowards(row, place);
    float key = dot(normal, towards);
    bool isOutside = lightCone > -2.0 && dot(-towards, normalize(lightTexel(row, 3).xyz)) < lightCone;
    if (key <= 0.0 || isOutside) continue;
    LightView view = lightView(row, place);
    float share = lightIsFiltered && view.at.z > 0.0
      ? lightFiltered(view, face, image, facing, right, up)
      : lightShare(view, face, image >> lightMissing, facing, shadowLevels, lightRadius);
    if (movingIs) share = min(share, movingShare(lightKind == LIGHT_CUBE ? face : movingRow, place, facing));
    sum += weight * key * share;
  }
  return sum;
}

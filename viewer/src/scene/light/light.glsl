/* Key light of the scene with its precomputed shadow (spec/shading.md), after lookup.glsl. */
/* What is chosen is defined, not a uniform: a software rasteriser goes through every branch, taken or not, and took
   1.1 s for a picture that takes half of it with one way in it.
   LIGHT_KIND: one projection, a cube of six with a tree each, a stack in order of time, or of places on an area
   LIGHT_RADIUS: of the kernel, in pixels of the map
   LIGHT_FILTERED: 1, the level follows the footprint of a pixel of the picture
   LIGHT_MOVES: 1, some layers cast by an ordinary map */
#define LIGHT_ONE 0
#define LIGHT_CUBE 1
#define LIGHT_PATH 2
#define LIGHT_AREA 3
const float LIGHT_STEPS = 1073741824.0;
const float LIGHT_BIAS = 512.0; /* 2048 of 2^-32 */
uniform sampler2D lightProjections; /* a projection a row (seenProjection.ts), and the middle of an area */
uniform vec3 lightReference; /* what they are told relative to, from the eye */
uniform int lightImages; /* of a stack */
uniform int lightMissing; /* levels of the map that are still on their way */
uniform int lightSpread; /* images are 2^this apart in the octree */
uniform float lightTime; /* image of a path, between two as well */
uniform int lightSamples; /* images of an area that a pixel asks */
uniform float lightLift; /* by how many times its depth a place may be beside what casts */
uniform float lightCone; /* least cosine of a spot, or -2 */
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
  if (view.at.z <= 0.0) return 1.0; /* behind the light */
  ivec2 pixel = lightPixel(view) >> shift;
#if LIGHT_KIND == LIGHT_CUBE
  pixel = clamp(pixel, ivec2(0), ivec2((1 << level) - 1));
#endif
  ivec2 count = shadowCount(tree, ivec3(pixel, image >> shift), lightStep(view), radius, level);
#if LIGHT_KIND == LIGHT_CUBE
  return float(count.x) / float(count.y);
#else
  int samples = (2 * radius + 1) * (2 * radius + 1);
  return float(count.x + samples - count.y) / float(samples);
#endif
}

/* As large on the map as a pixel of the picture, whose sides are `right` and `up`: two levels blended. */
float lightFiltered(LightView view, int tree, int image, vec3 normal, vec3 right, vec3 up) {
  vec2 off = view.at.xy / view.at.z;
  vec3 x = right * view.rows, y = up * view.rows;
  vec2 wide = (x.xy - off * x.z) / view.at.z, high = (y.xy - off * y.z) / view.at.z;
  float squared = view.at.z > 0.0 ? max(dot(wide, wide), dot(high, high)) : 1.0;
  float depth = clamp(0.5 * log2(max(1.0, squared)), 0.0, float(shadowLevels));
  int level = shadowLevels - int(depth);
  float share = lightShare(view, tree, image, normal, level, 1);
  float part = fract(depth);
  return part > 0.0 ? mix(share, lightShare(view, tree, image, normal, max(level - 1, 0), 1), part) : share;
}

#if LIGHT_MOVES
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
#if LIGHT_KIND == LIGHT_CUBE
    at += movingPixels * ivec2(row % 3, row / 3);
#endif
    if (isOff || step_ + texelFetch(movingSteps, at, 0).x < 1073741824u) lit++;
  }
  return float(lit) / 9.0;
}
#endif

/* Interleaved gradient noise (Jimenez 2014): even over every small neighbourhood. */
float lightNoise() {
  return fract(52.9829189 * fract(dot(floor(gl_FragCoord.xy), vec2(0.06711056, 0.00583715))));
}

/* Where the light is, and whether the place is in its cone: cosine to the normal, or 0. */
float lightCosine(int row, vec3 place, vec3 normal) {
  vec3 towards = lightTowards(row, place);
  bool isOutside = lightCone > -2.0 && dot(-towards, normalize(lightTexel(row, 3).xyz)) < lightCone;
  return isOutside ? 0.0 : max(0.0, dot(normal, towards));
}

#if LIGHT_KIND == LIGHT_AREA
/* Mean over the images of an area; noise chooses which, where not all are asked. */
float lightArrives(int row, vec3 facing, vec3 place, vec3 right, vec3 up) {
  float stride = float(lightImages) / float(lightSamples);
  float first = lightSamples < lightImages ? lightNoise() * stride : 0.0;
  float sum = 0.0;
  for (int i = 0; i < lightSamples; i++) {
    int image = min(int(first + float(i) * stride), lightImages - 1);
    sum += lightShare(lightView(image, place), 0, image << lightSpread >> lightMissing, facing, shadowLevels, 0);
  }
  return sum / float(lightSamples);
}
#else
/* Of one image or face. */
float lightArrives(int row, vec3 facing, vec3 place, vec3 right, vec3 up) {
#if LIGHT_KIND == LIGHT_CUBE
  int tree = row, image = 0;
#else
  int tree = 0, image = row << lightSpread >> lightMissing;
#endif
  LightView view = lightView(row, place);
#if LIGHT_FILTERED
  return lightFiltered(view, tree, image, facing, right, up);
#else
  return lightShare(view, tree, image, facing, shadowLevels, LIGHT_RADIUS);
#endif
}
#endif

/* Key of spec/shading.md times the share of the light that arrives, of one row. */
float lightOf(int row, vec3 normal, vec3 facing, vec3 place, vec3 right, vec3 up) {
  float key = lightCosine(row, place, normal);
  if (key == 0.0) return 0.0;
  float share = lightArrives(row, facing, place, right, up);
#if LIGHT_MOVES && LIGHT_KIND == LIGHT_CUBE
  share = min(share, movingShare(row, place, facing));
#elif LIGHT_MOVES
  share = min(share, movingShare(movingRow, place, facing));
#endif
  return key * share;
}

/* The same of the light. `facing` is the triangle's own normal, on the side of the eye; `right` and `up` lead to the
   next pixels' places. */
float lightKey(vec3 normal, vec3 facing, vec3 seen, vec3 right, vec3 up) {
  vec3 place = seen - facing * (lightLift * seen.z);
#if LIGHT_KIND == LIGHT_CUBE
  return lightOf(lightFace(place), normal, facing, place, right, up);
#elif LIGHT_KIND == LIGHT_AREA
  return lightOf(lightImages, normal, facing, place, right, up);
#elif LIGHT_KIND == LIGHT_PATH
  int row = int(lightTime);
  float key = lightOf(row, normal, facing, place, right, up);
  int next = min(row + 1, lightImages - 1);
  return mix(key, lightOf(next, normal, facing, place, right, up), fract(lightTime));
#else
  return lightOf(int(lightTime), normal, facing, place, right, up);
#endif
}

/* The tree of a shadow map, looked up (spec/shadows.md). Its twin that one can read: select/shadowTree.ts.
   Trees lie one after the other in one texture; a point light has six. */
const int SHADOW_MOST_LEVELS = 20;
uniform usampler2D shadowWords; /* word a is in column a mod width, row a / width */
uniform int shadowWidthBits;
uniform int shadowLevels;
uniform uvec4 shadowScales[30]; /* of level l of tree t: [5 t + l / 4][l mod 4] */
uniform uvec2 shadowRoots[6]; /* address of each root, and its kind */

/* A node on the way down: its kind (0 none, 1 leaf, 2 empty, 3 inner), the address of its link, and that of the
   last value on the way. */
struct ShadowNode {
  uint kind;
  uint link;
  uint held;
  int level;
};

uint shadowWord(uint address) {
  uint column = address & ((1u << shadowWidthBits) - 1u);
  return texelFetch(shadowWords, ivec2(column, address >> shadowWidthBits), 0).x;
}

/* GLSL ES 3.0 has no bitCount; of a word of 16 bits. */
uint shadowOnes(uint word) {
  word -= word >> 1 & 0x5555u;
  word = (word & 0x3333u) + (word >> 2 & 0x3333u);
  word = word + (word >> 4) & 0x0f0fu;
  return word + (word >> 8) & 31u;
}

ShadowNode shadowRoot(int tree) {
  uvec2 root = shadowRoots[tree];
  return ShadowNode(root.y, root.x, root.x + (root.y >> 1), 0);
}

/* Go down to `last`, to the end, or to where the bits in `differing` begin. */
void shadowDescend(int tree, inout ShadowNode node, ivec3 at, int differing, int last) {
  for (int i = 0; i < SHADOW_MOST_LEVELS; i++) {
    int bit = shadowLevels - 1 - node.level;
    if (node.kind < 2u || node.level >= last || differing >> bit != 0) break;
    uint link = shadowWord(node.link);
    ivec3 bits = at >> bit & 1;
    int place = 2 * (bits.x | bits.y << 1 | bits.z << 2);
    uint before = shadowOnes(link & ((1u << place) - 1u));
    uint scale = shadowScales[5 * tree + (node.level >> 2)][node.level & 3];
    node.link += (link >> 16) * scale + before;
    node.kind = link >> place & 3u;
    if ((node.kind & 1u) != 0u) node.held = node.link + (node.kind >> 1);
    node.level++;
  }
}

/* The value of a voxel (x, y, image) of the map that this level is. */
uint shadowValue(int tree, ivec3 place, int level) {
  ShadowNode node = shadowRoot(tree);
  shadowDescend(tree, node, place << shadowLevels - level, 0, level);
  return shadowWord(node.held);
}

/* Of the (2 r + 1)^2 voxels of an image around one: how many are lit for a receiver at this step, and how many are on
   the map at all. */
ivec2 shadowCount(int tree, ivec3 place, uint step_, int radius, int level) {
  int shift = shadowLevels - level;
  ivec2 low = max(place.xy - radius, 0);
  ivec2 high = min(place.xy + radius, (1 << level) - 1);
  ivec2 side = max(high - low + 1, 0);
  int area = side.x * side.y;
  if (area == 0) return ivec2(0);
  ShadowNode top = shadowRoot(tree);
  ivec2 differing = low ^ high;
  shadowDescend(tree, top, ivec3(low, place.z) << shift, (differing.x | differing.y) << shift, level);
  if (top.kind < 2u || top.level == level) return ivec2(step_ <= shadowWord(top.held) ? area : 0, area);
  int lit = 0;
  for (int y = low.y; y <= high.y; y++) {
    for (int x = low.x; x <= high.x; x++) {
      ShadowNode node = top;
      shadowDescend(tree, node, ivec3(x, y, place.z) << shift, 0, level);
      if (step_ <= shadowWord(node.held)) lit++;
    }
  }
  return ivec2(lit, area);
}

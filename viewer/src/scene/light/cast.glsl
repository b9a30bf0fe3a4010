/* Depth of what moves, for the ordinary map; after light.glsl. */
in vec3 vPosition;
uniform int castRow;
out uint pixel;
void main() {
  LightView view = lightView(castRow, vPosition);
  view.lost = 0.0; /* who is looked up is told nearer, not who casts */
  pixel = 1073741823u - (lightStep(view) >> 2);
}

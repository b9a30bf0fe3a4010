/** What is behind the scene: a soft gradient, drawn so that screenshots have it too. */
import { BufferAttribute, BufferGeometry, GLSL3, Mesh, RawShaderMaterial, Vector3 } from "three";

/** sRGB, middle and corners of the picture, as `#rrggbb`. */
export interface BackgroundColours {
  readonly middle: string;
  readonly corners: string;
}

const VERTEX = /* glsl */ `
in vec3 position;
out vec2 place;
void main() {
  place = position.xy;
  gl_Position = vec4(position.xy, 1.0, 1.0);
}
`;

const FRAGMENT = /* glsl */ `
precision highp float;
in vec2 place;
uniform vec3 middle;
uniform vec3 corners;
uniform float aspect;
out vec4 pixel;
void main() {
  float away = length(place * vec2(min(1.0, aspect), min(1.0, 1.0 / aspect)) - vec2(0.0, 0.12));
  vec3 colour = mix(middle, corners, smoothstep(0.1, 1.5, away));
  // a little noise below one level keeps the gradient free of bands
  float hash = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  pixel = vec4(colour + (hash - 0.5) / 255.0, 1.0);
}
`;

export class Background {
  readonly mesh: Mesh<BufferGeometry, RawShaderMaterial>;

  constructor() {
    const geometry = new BufferGeometry();
    geometry.setAttribute(
      "position",
      new BufferAttribute(new Float32Array([-1, -1, 0, 3, -1, 0, -1, 3, 0]), 3),
    );
    const material = new RawShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: { middle: { value: new Vector3() }, corners: { value: new Vector3() }, aspect: { value: 1 } },
      depthTest: false,
      depthWrite: false,
    });
    this.mesh = new Mesh(geometry, material);
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = -1;
  }

  set colours({ middle, corners }: BackgroundColours) {
    const { uniforms } = this.mesh.material;
    uniforms.middle!.value = srgbOf(middle);
    uniforms.corners!.value = srgbOf(corners);
  }

  set aspect(aspect: number) {
    this.mesh.material.uniforms.aspect!.value = aspect;
  }
}

/** `#rrggbb` to sRGB from 0 to 1. */
function srgbOf(hex: string): Vector3 {
  const value = Number.parseInt(hex.slice(1), 16);
  return new Vector3((value >> 16) & 255, (value >> 8) & 255, value & 255).divideScalar(255);
}

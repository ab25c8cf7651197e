#version 300 es
// A face or edge of a clump; its light comes in light.frag.
precision highp float;
in vec3 seen, place, normal;
flat in vec3 colour;
flat in float tag;
uniform vec2 nearFar;
uniform vec4 cut;
uniform float cutLeast, flatView;
layout(location = 0) out vec4 lit;
layout(location = 1) out vec4 normalOut;

void main() {
  float along = dot(cut.xyz, place);
  if (along > cut.w || along < cutLeast) discard;
  gl_FragDepth = clamp((seen.z - nearFar.x) / (nearFar.y - nearFar.x), 0.0, 1.0);
  vec3 n = normalize(normal);
  // In a slice the inside is seen.
  if (dot(n, flatView > 0.5 ? vec3(0.0, 0.0, 1.0) : seen) > 0.0) n = -n;
  lit = vec4(colour, 1.0);
  normalOut = vec4(0.5 + 0.5 * n, tag);
}

#version 300 es
// A thin wall veils what is behind it: apart, what lies between grains and wall spheres, and what is before both.
precision highp float;
precision highp sampler2D;
in vec3 seen, place;
flat in vec4 tone;
uniform sampler2D solidDepth, glassDepth;
uniform vec2 nearFar;
uniform vec4 cut;
uniform float cutLeast, flatView, width, hides, ink;   // ink: brightness of lines
uniform int glass, plane;
layout(location = 0) out vec4 behind;
layout(location = 1) out vec4 before;

void main() {
  vec3 slope = cross(dFdx(seen), dFdy(seen));
  float along = dot(cut.xyz, place);
  if (along > cut.w || along < cutLeast) discard;
  ivec2 at = ivec2(gl_FragCoord.xy);
  float depth = (seen.z - nearFar.x) / (nearFar.y - nearFar.x);
  if (depth >= texelFetch(solidDepth, at, 0).r) discard;
  vec3 normal = slope / max(1e-30, length(slope));
  if (dot(normal, flatView > 0.5 ? vec3(0.0, 0.0, 1.0) : seen) > 0.0) normal = -normal;
  float lamp = max(0.0, dot(normal, vec3(-0.4243, 0.7071, -0.5657)));
  float bright = width > 0.0 ? ink : 0.64 + 0.14 * normal.y + 0.38 * lamp;
  bright = mix(bright, 1.0, tone.a);
  vec4 veil = vec4(min(tone.rgb * bright, 1.0), 1.0) * hides;
  // A plane is ground: it does not show through the walls that stand before it.
  if (plane == 1 && glass == 1 && depth >= texelFetch(glassDepth, at, 0).r) discard;
  bool nearest = glass == 0 || depth < texelFetch(glassDepth, at, 0).r;
  behind = nearest ? vec4(0.0) : veil;
  before = nearest ? veil : vec4(0.0);
}

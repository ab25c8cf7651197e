#version 300 es
// A face of a mesh that hides what is behind it, lit from both sides.
precision highp float;
in vec3 seen, place;
flat in vec4 tone;
uniform vec2 nearFar;
uniform vec4 cut;
uniform float cutLeast, flatView;
layout(location = 0) out vec4 lit;
layout(location = 1) out vec4 normalOut;

void main() {
  vec3 slope = cross(dFdx(seen), dFdy(seen));
  float along = dot(cut.xyz, place);
  if (along > cut.w || along < cutLeast) discard;
  gl_FragDepth = clamp((seen.z - nearFar.x) / (nearFar.y - nearFar.x), 0.0, 1.0);
  vec3 normal = slope / max(1e-30, length(slope));
  if (dot(normal, flatView > 0.5 ? vec3(0.0, 0.0, 1.0) : seen) > 0.0) normal = -normal;
  float lamp = max(0.0, dot(normal, vec3(-0.4243, 0.7071, -0.5657)));
  float bright = mix(0.64 + 0.14 * normal.y + 0.38 * lamp, 1.0, tone.a);
  lit = vec4(min(tone.rgb * bright, 1.0), 1.0);
  normalOut = vec4(0.5 + 0.5 * normal, 1.0);
}

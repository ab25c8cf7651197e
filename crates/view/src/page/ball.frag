#version 300 es
// The ray of this sample against the sphere: outline, depth and normal are exact.
precision highp float;
in vec3 corner;
flat in vec3 centre, colour;
flat in float size;
uniform vec2 nearFar;
uniform float flatView;
layout(location = 0) out vec4 lit;
layout(location = 1) out vec4 normalOut;

void main() {
  vec3 ray = flatView > 0.5 ? vec3(0.0, 0.0, 1.0) : normalize(corner);
  vec3 from = flatView > 0.5 ? vec3(corner.xy, 0.0) : vec3(0.0);
  // The centre's offset from the ray is taken first: the difference of large squares would lose small spheres.
  vec3 towards = centre - from;
  vec3 aside = towards - dot(towards, ray) * ray;
  float inside = size * size - dot(aside, aside);
  if (inside < 0.0) discard;
  float half_ = sqrt(inside);
  vec3 normal = (-aside - half_ * ray) / size;
  float depth = centre.z + size * normal.z;
  gl_FragDepth = clamp((depth - nearFar.x) / (nearFar.y - nearFar.x), 0.0, 1.0);
  float lamp = max(0.0, dot(normal, vec3(-0.4243, 0.7071, -0.5657)));
  float bright = 0.64 + 0.14 * normal.y + 0.38 * lamp;
  lit = vec4(min(colour * bright + 0.10 * pow(lamp, 12.0), 1.0), 1.0);
  normalOut = vec4(0.5 + 0.5 * normal, 1.0);
}

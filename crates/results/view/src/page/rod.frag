#version 300 es
// The ray of this sample against a cone with round ends, or a disc: crates/results/view/src/picture/rods.rs derives it.
precision highp float;
flat in vec3 endA, endB, colour;
flat in vec2 radii;
flat in float disc;
uniform vec2 nearFar, picture, lens;
uniform float flatView;
layout(location = 0) out vec4 lit;
layout(location = 1) out vec4 normalOut;

float sphere(vec3 ray, vec3 offset, float size) {
  float along = dot(offset, ray);
  vec3 aside = offset - along * ray;
  float inside = size * size - dot(aside, aside);
  return inside < 0.0 ? 1e30 : along - sqrt(inside);
}

void main() {
  vec2 here = (2.0 * gl_FragCoord.xy / picture - 1.0) / lens;
  vec3 ray = flatView > 0.5 ? vec3(0.0, 0.0, 1.0) : normalize(vec3(here, 1.0));
  vec3 from = flatView > 0.5 ? vec3(here, 0.0) : vec3(0.0);
  vec3 a = endA - from, u = endB - endA, normal;
  float t = 1e30;
  if (disc > 0.5) {
    t = dot(u, a) / dot(u, ray);
    vec3 off = t * ray - a;
    if (!(dot(off, off) <= radii.x * radii.x)) discard;
    normal = normalize(dot(u, ray) > 0.0 ? -u : u);
  } else {
    float delta = radii.y - radii.x, rest = dot(u, u) - delta * delta;
    if (rest > 0.0) {
      // Relative to the nearest place of the ray to a: differences of large squares would lose thin rods.
      float start = dot(a, ray);
      vec3 q = start * ray - a;
      float offset = radii.x * delta + dot(q, u), ru = dot(ray, u);
      float p = rest - ru * ru, b = -ru * offset, c = rest * (dot(q, q) - radii.x * radii.x) - offset * offset;
      float root = b * b - p * c;
      if (root >= 0.0) {
        float own = (-b - sqrt(root)) / p, s = (own * ru + offset) / rest;
        if (s >= 0.0 && s <= 1.0) t = start + own;
      }
    }
    if (t > 1e29) t = min(sphere(ray, a, radii.x), sphere(ray, a + u, radii.y));
    if (t > 1e29) discard;
    vec3 q = t * ray - a;
    float s = rest > 0.0 ? clamp((dot(q, u) + radii.x * delta) / rest, 0.0, 1.0) : 0.0;
    normal = normalize(q - s * u);
  }
  float depth = (from + t * ray).z;
  gl_FragDepth = clamp((depth - nearFar.x) / (nearFar.y - nearFar.x), 0.0, 1.0);
  float lamp = max(0.0, dot(normal, vec3(-0.4243, 0.7071, -0.5657)));
  lit = vec4(min(colour * (0.64 + 0.14 * normal.y + 0.38 * lamp) + 0.06 * pow(lamp, 12.0), 1.0), 1.0);
  normalOut = vec4(0.5 + 0.5 * normal, 1.0);
}

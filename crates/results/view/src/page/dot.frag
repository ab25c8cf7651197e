#version 300 es
// A point that is lit like a sphere; its depth is one for all of it, which is quick.
precision highp float;
flat in vec3 centre, colour;
flat in float size;
layout(location = 0) out vec4 lit;
layout(location = 1) out vec4 normalOut;

void main() {
  vec2 side = 2.0 * gl_PointCoord - 1.0;
  float inside = 1.0 - dot(side, side);
  if (inside < 0.0) discard;
  vec3 normal = vec3(side.x, -side.y, -sqrt(inside));
  float lamp = max(0.0, dot(normal, vec3(-0.4243, 0.7071, -0.5657)));
  lit = vec4(min(colour * (0.64 + 0.14 * normal.y + 0.38 * lamp) + 0.10 * pow(lamp, 12.0), 1.0), 1.0);
  normalOut = vec4(0.5 + 0.5 * normal, 1.0);
}

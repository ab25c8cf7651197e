#version 300 es
// The colour of a grain: its columns are shares of their ranges.
precision highp float;
uniform vec2 valueOf[3];
uniform int mode, axis;                 // mode 0 plain, 1 map, 2 kinds, 3 own colours, 4 clumps
uniform vec2 shown;
uniform vec3 plain, kinds[8];
uniform sampler2D map;

{{worn}}
vec3 coloured(vec3 place, vec3 share) {
  if (wornMode > 0) return wornColour(share.r);
  float value = axis < 0 ? valueOf[0].x + share.r * valueOf[0].y : place[axis];
  if (mode == 1) return texture(map, vec2(clamp((value - shown.x) / (shown.y - shown.x), 0.0, 1.0) * 255.0 / 256.0 + 0.5 / 256.0, 0.5)).rgb;
  if (mode == 2) return kinds[int(value + 0.5) % 8];
  // As `scattered` in colour.rs.
  if (mode == 4) return kinds[int((uint(value + 0.5) * 0x9e3779b9u) >> 29)];
  if (mode == 3) return vec3(value, valueOf[1].x + share.g * valueOf[1].y, valueOf[2].x + share.b * valueOf[2].y) / 255.0;
  return plain;
}


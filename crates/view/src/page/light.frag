#version 300 es
// Joins grains and walls, darkens the gaps between grains, and averages the samples of a pixel.
precision highp float;
precision highp sampler2D;
uniform sampler2D solidColour, solidNormal, solidDepth, glassColour, glassNormal, glassDepth, sheetBehind, sheetBefore;
uniform vec3 paper;
uniform vec2 nearFar, focal;   // focal in samples
uniform float flatView, opacity, reach, dark;   // dark: 1 on dark paper
uniform int samples, sheets;
out vec4 shownColour;

const vec2 SPIRAL[8] = vec2[8](vec2(0.09, 0.05), vec2(-0.16, 0.14), vec2(-0.05, -0.33), vec2(0.42, 0.12),
                               vec2(0.10, 0.55), vec2(-0.66, 0.08), vec2(0.22, -0.76), vec2(0.69, 0.66));
const vec2 TURN[4] = vec2[4](vec2(1.0, 0.0), vec2(0.0, 1.0), vec2(-0.707, 0.707), vec2(0.707, 0.707));

vec3 point(ivec2 at, float share, vec2 size) {
  float z = mix(nearFar.x, nearFar.y, share);
  vec2 offset = (vec2(at) + 0.5 - 0.5 * size) / focal;
  return vec3(flatView > 0.5 ? offset : offset * z, z);
}

float openness(sampler2D depths, sampler2D normals, ivec2 at, float share) {
  ivec2 whole = textureSize(depths, 0);
  vec2 size = vec2(whole);
  vec3 here = point(at, share, size);
  vec3 normal = texelFetch(normals, at, 0).xyz * 2.0 - 1.0;
  float far = flatView > 0.5 ? 1.0 : here.z;
  float span = clamp(reach * focal.y / far, 3.0, 0.06 * size.y);
  float world = span * far / focal.y;
  vec2 turn = TURN[(at.x & 1) + 2 * (at.y & 1)];
  float covered = 0.0;
  for (int i = 0; i < 8; i++) {
    vec2 s = SPIRAL[i];
    ivec2 there = at + ivec2(round(span * vec2(s.x * turn.x - s.y * turn.y, s.x * turn.y + s.y * turn.x)));
    if (any(lessThan(there, ivec2(0))) || any(greaterThanEqual(there, whole))) continue;
    float other = texelFetch(depths, there, 0).r;
    if (other >= 1.0) continue;
    vec3 away = point(there, other, size) - here;
    float length_ = max(length(away), 1e-9);
    covered += max(0.0, dot(normal, away) / length_ - 0.08) * max(0.0, 1.0 - length_ / (1.5 * world));
  }
  return clamp(1.0 - 2.4 * covered / 8.0, 0.15, 1.0);
}

// On dark paper grains and their rims are lit: dark grains are nearly as dark as the paper.
vec3 rim(sampler2D normals, ivec2 at, vec3 colour) {
  float edge = 1.0 + min(0.0, texelFetch(normals, at, 0).z * 2.0 - 1.0);
  return colour + dark * (0.07 + 0.30 * edge * edge) * (1.0 - colour);
}

vec3 veiled(sampler2D by, ivec2 at, vec3 under) {
  if (sheets == 0) return under;
  vec4 veil = texelFetch(by, at, 0);
  return veil.rgb + (1.0 - veil.a) * under;
}

vec3 seen(ivec2 at) {
  float far = texelFetch(solidDepth, at, 0).r;
  float near = opacity > 0.0 ? texelFetch(glassDepth, at, 0).r : 1.0;
  vec3 under = paper;
  if (far < 1.0) under = rim(solidNormal, at, texelFetch(solidColour, at, 0).rgb * openness(solidDepth, solidNormal, at, far));
  under = veiled(sheetBehind, at, under);
  if (near >= far) return veiled(sheetBefore, at, under);
  vec3 wall = texelFetch(glassColour, at, 0).rgb * openness(glassDepth, glassNormal, at, near);
  return veiled(sheetBefore, at, mix(under, wall, far < 1.0 ? opacity : mix(0.35, 0.6, dark) + mix(0.65, 0.4, dark) * opacity));
}

void main() {
  vec3 sum = vec3(0.0);
  ivec2 first = ivec2(gl_FragCoord.xy) * samples;
  for (int y = 0; y < samples; y++)
    for (int x = 0; x < samples; x++) sum += seen(first + ivec2(x, y));
  shownColour = vec4(sum / float(samples * samples), 1.0);
}

#version 300 es
// Joins grains and walls, darkens the gaps between grains, and averages the samples of a pixel.
precision highp float;
precision highp sampler2D;
uniform sampler2D solidColour, solidNormal, solidDepth, glassColour, glassNormal, glassDepth, sheetBehind, sheetBefore;
uniform vec3 paper;
uniform vec2 nearFar, focal;   // focal in samples
uniform float flatView, opacity, reach, dark;   // dark: 1 on dark paper
uniform int samples, sheets, smoothed;   // smoothed: 1 where there are clumps
out vec4 shownColour;

const vec2 SPIRAL[8] = vec2[8](vec2(0.09, 0.05), vec2(-0.16, 0.14), vec2(-0.05, -0.33), vec2(0.42, 0.12),
                               vec2(0.10, 0.55), vec2(-0.66, 0.08), vec2(0.22, -0.76), vec2(0.69, 0.66));
const int TAPS = 24;
const vec2 TURN[4] = vec2[4](vec2(1.0, 0.0), vec2(0.0, 1.0), vec2(-0.707, 0.707), vec2(0.707, 0.707));

vec3 point(ivec2 at, float share, vec2 size) {
  float z = mix(nearFar.x, nearFar.y, share);
  vec2 offset = (vec2(at) + 0.5 - 0.5 * size) / focal;
  return vec3(flatView > 0.5 ? offset : offset * z, z);
}

// The tag of the clump at a sample; 1 without one.
float tagAt(ivec2 at) { return smoothed == 0 ? 1.0 : texelFetch(solidNormal, at, 0).a; }

// The mean of the normals around, on the same clump: the spheres of a clump are one body, without creases.
vec3 smoothNormal(ivec2 at, float share, float tag) {
  ivec2 whole = textureSize(solidDepth, 0);
  vec2 size = vec2(whole);
  vec3 here = point(at, share, size);
  float far = flatView > 0.5 ? 1.0 : here.z;
  float span = clamp(0.15 * reach * focal.y / far, 1.5, 0.05 * size.y);
  float world = 1.4 * span * far / focal.y;
  vec3 sum = texelFetch(solidNormal, at, 0).xyz * 2.0 - 1.0;
  for (int i = 0; i < TAPS; i++) {
    float turn = 2.39996 * float(i);
    ivec2 there = at + ivec2(round(span * sqrt((float(i) + 0.5) / float(TAPS)) * vec2(cos(turn), sin(turn))));
    if (any(lessThan(there, ivec2(0))) || any(greaterThanEqual(there, whole))) continue;
    vec4 other = texelFetch(solidNormal, there, 0);
    if (other.a != tag) continue;
    float away = length(point(there, texelFetch(solidDepth, there, 0).r, size) - here);
    sum += max(0.0, 1.0 - away / world) * (other.xyz * 2.0 - 1.0);
  }
  return normalize(sum);
}

// As in ball.frag, which leaves clumps unlit.
vec3 lamplit(vec3 colour, vec3 normal) {
  float lamp = max(0.0, dot(normal, vec3(-0.4243, 0.7071, -0.5657)));
  return min(colour * (0.64 + 0.14 * normal.y + 0.38 * lamp) + 0.10 * pow(lamp, 12.0), 1.0);
}

// How much of the sky is seen; a clump does not hide it from itself.
float openness(sampler2D depths, vec3 normal, ivec2 at, float share, float tag) {
  ivec2 whole = textureSize(depths, 0);
  vec2 size = vec2(whole);
  vec3 here = point(at, share, size);
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
    if (other >= 1.0 || tag < 0.999 && tagAt(there) == tag) continue;
    vec3 away = point(there, other, size) - here;
    float length_ = max(length(away), 1e-9);
    covered += max(0.0, dot(normal, away) / length_ - 0.08) * max(0.0, 1.0 - length_ / (1.5 * world));
  }
  return clamp(1.0 - 2.4 * covered / 8.0, 0.15, 1.0);
}

// On dark paper grains and their rims are lit: dark grains are nearly as dark as the paper.
vec3 rim(vec3 normal, vec3 colour) {
  float edge = 1.0 + min(0.0, normal.z);
  return colour + dark * (0.07 + 0.30 * edge * edge) * (1.0 - colour);
}

// What is solid at a sample.
vec3 solid(ivec2 at, float far) {
  vec3 colour = texelFetch(solidColour, at, 0).rgb, normal = texelFetch(solidNormal, at, 0).xyz * 2.0 - 1.0;
  float tag = tagAt(at);
  if (tag < 0.999) {
    normal = smoothNormal(at, far, tag);
    colour = lamplit(colour, normal);
  }
  return rim(normal, colour * openness(solidDepth, normal, at, far, tag));
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
  if (far < 1.0) under = solid(at, far);
  under = veiled(sheetBehind, at, under);
  if (near >= far) return veiled(sheetBefore, at, under);
  vec3 wall = texelFetch(glassColour, at, 0).rgb * openness(glassDepth, texelFetch(glassNormal, at, 0).xyz * 2.0 - 1.0, at, near, 1.0);
  return veiled(sheetBefore, at, mix(under, wall, far < 1.0 ? opacity : mix(0.35, 0.6, dark) + mix(0.65, 0.4, dark) * opacity));
}

void main() {
  vec3 sum = vec3(0.0);
  ivec2 first = ivec2(gl_FragCoord.xy) * samples;
  for (int y = 0; y < samples; y++)
    for (int x = 0; x < samples; x++) sum += seen(first + ivec2(x, y));
  shownColour = vec4(sum / float(samples * samples), 1.0);
}

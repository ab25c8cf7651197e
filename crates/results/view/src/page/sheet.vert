#version 300 es
// A corner of a thin wall, or of the strip that a line is drawn as.
// Seen coordinates: x right, y up, z forward, the eye at 0.
precision highp float;
layout(location = 0) in vec3 here;
layout(location = 1) in vec3 there;   // the other end of a line
layout(location = 2) in float share;  // what was done to the face, as a share of its column
uniform vec3 plain;
uniform mat3 turn, pose;
uniform vec3 poseShift, eye;
uniform vec2 focal, size;             // size of the picture in samples
uniform vec2 nearFar;
uniform float flatView, width;        // width of a line in samples, 0 for faces
out vec3 seen, place;
flat out vec4 tone;                   // colour in full light, and how much less light changes it

{{worn}}

vec3 placed(vec3 p) { return pose * p + poseShift; }

vec4 clip(vec3 p) { return vec4(p.xy * focal, 0.0, flatView > 0.5 ? 1.0 : p.z); }

void main() {
  tone = wornMode > 0 ? vec4(wornColour(share), 0.6) : vec4(plain, 0.0);
  place = placed(here);
  seen = turn * (place - eye);
  gl_Position = clip(seen);
  if (width == 0.0) return;
  // A line that passes the eye starts before it.
  vec3 ends[2] = vec3[2](seen, turn * (placed(there) - eye));
  vec3 places[2] = vec3[2](place, placed(there));
  for (int k = 0; k < 2; k++) {
    float gap = nearFar.x - ends[k].z;
    if (flatView > 0.5 || gap <= 0.0) continue;
    float share = min(1.0, gap / max(1e-9, ends[1 - k].z - ends[k].z));
    places[k] = mix(places[k], places[1 - k], share);
    ends[k] = mix(ends[k], ends[1 - k], share);
  }
  int end = gl_VertexID >> 1;
  vec4 from = clip(ends[0]), to = clip(ends[1]);
  vec2 along = (to.xy / to.w - from.xy / from.w) * size;
  vec2 across = vec2(-along.y, along.x) / max(1e-9, length(along));
  seen = ends[end];
  place = places[end];
  gl_Position = end == 0 ? from : to;
  gl_Position.xy += (float(gl_VertexID & 1) - 0.5) * 2.0 * width * across / size * gl_Position.w;
}

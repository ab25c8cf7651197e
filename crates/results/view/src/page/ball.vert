// A sphere is drawn on a point, a square that covers its outline as the eye sees it; on two triangles where that is larger
// than points can be.
// Seen coordinates: x right, y up, z forward, the eye at 0.
layout(location = 0) in vec3 position;  // share of the frame's box
layout(location = 1) in float radius;   // share of the frame's range
layout(location = 2) in float red;      // the field, or the red of a scan
layout(location = 3) in float green;
layout(location = 4) in float blue;
layout(location = 5) in float marked;
layout(location = 6) in float kin;      // below 1: a number for the clump that it is a part of
uniform vec3 boxLo, boxSize, radiusOf;  // radiusOf: lowest, range, factor
uniform mat3 turn, pose;                // pose, poseShift: where the layer is now
uniform vec3 poseShift;
uniform vec3 eye;
uniform vec2 focal;                     // of the shorter way, scaled to clip space
uniform vec2 nearFar;
uniform float flatView, pixel;          // pixel: size of a pixel at distance 1 (or at all, when flat)
uniform vec4 cut;                       // what is shown: cutLeast <= cut.xyz . place <= cut.w
uniform float cutLeast;
uniform int asPoints;                   // 0 only what is larger than `most`, on triangles; 1 only the rest; 2 all, as dots
uniform float most;                     // pixels
uniform vec3 markColour;
flat out vec3 centre, colour;
flat out float size, tag;

// The place on the picture, at the depth of the sphere's nearest point.
vec4 clip(vec3 seen) {
  float share = clamp((centre.z - 1.0001 * size - nearFar.x) / (nearFar.y - nearFar.x), 0.0, 1.0);
  float w = flatView > 0.5 ? 1.0 : seen.z;
  return vec4(seen.xy * focal, (2.0 * share - 1.0) * w, w);
}

// How far the outline reaches from the centre along one direction of the picture, whose coordinate of the centre is c.
float reach(float c) {
  if (flatView > 0.5) return size;
  float touch = sqrt(max(1e-30, c * c + centre.z * centre.z - size * size)), middle = c / centre.z;
  float hi = (c * touch + size * centre.z) / max(1e-30, centre.z * touch - size * c);
  float lo = (c * touch - size * centre.z) / max(1e-30, centre.z * touch + size * c);
  return max(hi - middle, middle - lo);
}

vec3 corner_() {
  vec2 side = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  if (flatView > 0.5) return centre + size * vec3(side, 0.0);
  vec3 forward = normalize(centre);
  vec3 right = normalize(cross(forward, vec3(0.0, 1.0, 0.0)));
  vec3 up = cross(right, forward);
  float wide = size * length(centre) / sqrt(dot(centre, centre) - size * size);
  return centre + wide * (side.x * right + side.y * up);
}

void main() {
  vec3 place = pose * (boxLo + position * boxSize) + poseShift;
  centre = turn * (place - eye);
  size = (radiusOf.x + radius * radiusOf.y) * radiusOf.z;
  float far = flatView > 0.5 ? 1.0 : centre.z;
  size = max(size, 0.6 * pixel * far);
  float away = dot(centre, centre) - size * size;
  float along = dot(cut.xyz, place);
  float aside = asPoints == 2 ? 0.0 : size * length(cut.xyz);
  gl_PointSize = asPoints == 2 ? 2.0 * size / (pixel * far) : 2.0 * max(reach(centre.x), reach(centre.y)) / pixel + 1.5;
  bool hidden = along - aside > cut.w || along + aside < cutLeast || (asPoints == 0) != (gl_PointSize > most) && asPoints < 2
    || (flatView < 0.5 && (centre.z < nearFar.x || away < 0.02 * size * size));
  if (hidden) { gl_Position = vec4(2.0, 2.0, 2.0, 1.0); return; }
  tag = kin;
  colour = mix(coloured(place, vec3(red, green, blue)), markColour, 0.85 * marked);
  gl_Position = clip(asPoints == 0 ? corner_() : centre);
}

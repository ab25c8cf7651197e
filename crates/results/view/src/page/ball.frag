#version 300 es
// The ray of this sample against the sphere, and against the planes of the slice: outline, depth and normal are exact.
#ifdef GL_EXT_conservative_depth
// The square has the depth of the sphere's nearest point: what is hidden is not drawn at all.
#extension GL_EXT_conservative_depth : enable
layout(depth_greater) out highp float gl_FragDepth;
#endif
precision highp float;
flat in vec3 centre, colour;
flat in float size, tag;
uniform vec2 nearFar, picture;    // picture: samples
uniform vec2 lens;                // of the shorter way, scaled to the picture
uniform float flatView;
uniform vec4 cut;
uniform float cutLeast, cutEye;   // cutEye: where the eye is along the slice's normal
uniform vec3 cutSeen;             // that normal, in seen coordinates
layout(location = 0) out vec4 lit;
layout(location = 1) out vec4 normalOut;  // a: the tag of a clump, whose light comes later, in light.frag; or 1

void main() {
  vec2 here = (2.0 * gl_FragCoord.xy / picture - 1.0) / lens;
  vec3 ray = flatView > 0.5 ? vec3(0.0, 0.0, 1.0) : normalize(vec3(here, 1.0));
  vec3 from = flatView > 0.5 ? vec3(here, 0.0) : vec3(0.0);
  // The centre's offset from the ray is taken first: the difference of large squares would lose small spheres.
  vec3 towards = centre - from;
  float along = dot(towards, ray);
  vec3 aside = towards - along * ray;
  float inside = size * size - dot(aside, aside);
  if (inside < 0.0) discard;
  float half_ = sqrt(inside);
  vec3 normal = (-aside - half_ * ray) / size;
  float depth = centre.z + size * normal.z;
  // A slice through the sphere: the ray is in it from where it has entered both.
  float rate = dot(cutSeen, ray), start = cutEye + dot(cutSeen, from);
  bool face = false;
  if (abs(rate) > 1e-6) {
    float one = (cut.w - start) / rate, other = (cutLeast - start) / rate;
    float open = min(one, other), shut = max(one, other);
    if (max(open, along - half_) > min(shut, along + half_)) discard;
    face = open > along - half_;
    if (face) {
      normal = -sign(rate) * cutSeen;
      depth = (from + open * ray).z;
    }
  } else if (start > cut.w || start < cutLeast) discard;
  gl_FragDepth = clamp((depth - nearFar.x) / (nearFar.y - nearFar.x), 0.0, 1.0);
  float lamp = max(0.0, dot(normal, vec3(-0.4243, 0.7071, -0.5657)));
  float bright = face ? 0.92 : 0.64 + 0.14 * normal.y + 0.38 * lamp;
  bool later = tag < 0.999 && !face;
  lit = vec4(later ? colour : min(colour * bright + (face ? 0.0 : 0.10 * pow(lamp, 12.0)), 1.0), 1.0);
  normalOut = vec4(0.5 + 0.5 * normal, later ? tag : 1.0);
}

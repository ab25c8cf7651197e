// A corner of the mesh of a clump, whose place and size are its columns.
// Seen coordinates: x right, y up, z forward, the eye at 0.
layout(location = 0) in vec3 corner;
layout(location = 1) in vec3 outward;
layout(location = 2) in vec4 first;    // columns of the matrix, with red, green and blue
layout(location = 3) in vec4 second;
layout(location = 4) in vec4 third;
layout(location = 5) in vec4 shift;    // with the tag
uniform mat3 turn;
uniform vec3 eye;
uniform vec2 focal;
uniform float flatView;
out vec3 seen, place, normal;
flat out vec3 colour;
flat out float tag;

void main() {
  mat3 pose = mat3(first.xyz, second.xyz, third.xyz);
  place = pose * corner + shift.xyz;
  seen = turn * (place - eye);
  normal = turn * normalize(pose * outward);
  colour = coloured(shift.xyz, vec3(first.w, second.w, third.w));
  tag = shift.w;
  gl_Position = vec4(seen.xy * focal, 0.0, flatView > 0.5 ? 1.0 : seen.z);
}

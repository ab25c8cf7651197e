#version 300 es
// A rod (a bond, a crack, a contact, the shaft or the head of an arrow) is drawn on two triangles that cover the ball around it.
// Seen coordinates: x right, y up, z forward, the eye at 0.
precision highp float;
layout(location = 0) in vec3 position;  // share of the frame's box
layout(location = 1) in float radius;   // share of the frame's range
layout(location = 2) in float dx;
layout(location = 3) in float dy;
layout(location = 4) in float dz;
layout(location = 5) in float broken;   // or normal force
uniform vec3 boxLo, boxSize;
uniform vec2 radiusOf, valueOf[4];      // lowest and range
uniform mat3 turn;
uniform vec3 eye, shape;                // of bonds: radius of a bond and of a crack; of arrows: radius and length of a head, scale;
                                        // of contacts: radius of a force at the end of the scale, its ends
uniform float usual;                    // radius of the grains
uniform vec2 focal;
uniform float flatView;
uniform vec4 cut;
uniform float cutLeast;
uniform int part;                       // 0 bond or crack, 1 shaft, 2 head, 3 contact
uniform vec3 wholeColour, breakColour, arrowColour;
uniform vec3 stops[15];
uniform int stopCount;
flat out vec3 endA, endB, colour;
flat out vec2 radii;
flat out float disc;

const vec4 NOWHERE = vec4(2.0, 2.0, 2.0, 1.0);

void main() {
  vec3 place = boxLo + position * boxSize;
  vec3 along = vec3(valueOf[0].x + dx * valueOf[0].y, valueOf[1].x + dy * valueOf[1].y, valueOf[2].x + dz * valueOf[2].y);
  float state = valueOf[3].x + broken * valueOf[3].y;
  vec3 from = place, to = place;
  gl_Position = NOWHERE;
  disc = 0.0;
  if (part == 0) {
    float own = radiusOf.x + radius * radiusOf.y;
    if (state > 1.5) return;            // opened wide
    disc = state > 0.5 ? 1.0 : 0.0;
    colour = state > 0.5 ? breakColour : wholeColour;
    radii = vec2(own * (state > 0.5 ? shape.y : shape.x));
    from = state > 0.5 ? place : place - along;
    to = place + along;
  } else if (part == 3) {
    float at = clamp((state - shape.y) / (shape.z - shape.y), 0.0, 1.0) * float(stopCount - 1);
    int below = min(int(at), stopCount - 2);
    colour = state < 0.0 ? breakColour : mix(stops[below], stops[below + 1], at - float(below));
    radii = vec2(shape.x * min(abs(state) / shape.z, 1.0));
    from = place - along;
    to = place + along;
  } else {
    vec3 vector = along * shape.z;
    float length_ = length(vector);
    if (length_ < 0.1 * usual) return;
    float head = min(shape.y * usual, 0.6 * length_), thick = shape.x * head / shape.y;
    vec3 neck = place + vector * (1.0 - head / length_);
    colour = arrowColour;
    radii = part == 1 ? vec2(0.3 * thick) : vec2(thick, 0.0);
    from = part == 1 ? place : neck;
    to = part == 1 ? neck : place + vector;
  }
  vec3 middle = disc > 0.5 ? from : 0.5 * (from + to);
  float way = dot(cut.xyz, middle);
  if (way > cut.w || way < cutLeast) return;
  endA = turn * (from - eye);
  endB = turn * (to - eye);
  vec3 centre = turn * (middle - eye);
  float size = (disc > 0.5 ? 0.0 : 0.5 * length(to - from)) + max(radii.x, radii.y);
  vec2 side = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vec3 corner = centre + size * vec3(side, 0.0);
  if (flatView < 0.5) {
    if (centre.z <= 0.0 || dot(centre, centre) < 1.02 * size * size) return;
    vec3 forward = normalize(centre);
    vec3 right = normalize(cross(forward, vec3(0.0, 1.0, 0.0)));
    float wide = size * length(centre) / sqrt(dot(centre, centre) - size * size);
    corner = centre + wide * (side.x * right + side.y * cross(right, forward));
  }
  gl_Position = vec4(corner.xy * focal, 0.0, flatView > 0.5 ? 1.0 : corner.z);
}

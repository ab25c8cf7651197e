uniform sampler2D wallMap;
uniform vec2 wornOf, wornShown;         // walls: lowest and range of a column, ends of the scale
uniform int wornMode;                   // 0 none, 1 along a line, 2 along the logarithm

// The colour of a part of a wall, of which a share of its column is known.
vec3 wornColour(float share) {
  float value = wornOf.x + share * wornOf.y;
  float at = wornMode == 2 ? log(max(value, 1e-30) / wornShown.x) / log(wornShown.y / wornShown.x) : (value - wornShown.x) / (wornShown.y - wornShown.x);
  return texture(wallMap, vec2(clamp(at, 0.0, 1.0) * 255.0 / 256.0 + 0.5 / 256.0, 0.5)).rgb;
}

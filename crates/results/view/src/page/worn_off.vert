const int wornMode = 0;
vec3 wornColour(float s) { return vec3(s); }

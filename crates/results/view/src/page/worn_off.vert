const int wornMode = 0;
vec3 wornColour(float share) { return vec3(0.0); }

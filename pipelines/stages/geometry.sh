#!/usr/bin/env bash
# The surfaces of the sinter box, drawn: hopper with a slot as its mouth, chute, box. All are prisms along y, so that a slice of them,
# periodic along y, is the same plant without its panes.
#
#   geometry.sh hopper|chute|box [KEY=VALUE …] > PART.ply
#
#   scale=1     of the section: 1 is a box of 360 mm and a mouth at a height of 600 mm
#   mouth=0.034 width of the mouth [m], not scaled: grains must pass
#   low=-0.08 high=0.08  from where to where along y [m]
#   tilt=40     of the chute [deg]
#   shaft=0.35  height of the hopper's shaft [m], scaled
set -euo pipefail
part=$1
shift
awk -v part="$part" -v words="$*" '
function plate(x0, z0, x1, z1) { x[n] = x0; z[n] = z0; x[n + 1] = x1; z[n + 1] = z1; n += 2 }
BEGIN {
  scale = 1; mouth = 0.034; low = -0.08; high = 0.08; tilt = 40; shaft = 0.35
  count = split(words, word, " ")
  for (i = 1; i <= count; i++) {
    split(word[i], pair, "=")
    if (pair[1] == "scale") scale = pair[2]
    else if (pair[1] == "mouth") mouth = pair[2]
    else if (pair[1] == "low") low = pair[2]
    else if (pair[1] == "high") high = pair[2]
    else if (pair[1] == "tilt") tilt = pair[2]
    else if (pair[1] == "shaft") shaft = pair[2]
    else { print "geometry.sh: no key " pair[1] ": use scale, mouth, low, high, tilt or shaft" > "/dev/stderr"; exit 2 }
  }
  n = 0; half = mouth / 2; s = scale; slope = atan2(0, -1) / 180 * tilt
  if (part == "hopper") {
    # A spout of 10 mm, walls of 60 degrees, a shaft.
    side = 0.12 * s; foot = 0.6 * s + 0.01; knee = foot + (side - half) * sqrt(3); top = knee + shaft * s
    for (sign = -1; sign <= 1; sign += 2) {
      plate(sign * half, 0.6 * s, sign * half, foot)
      plate(sign * half, foot, sign * side, knee)
      plate(sign * side, knee, sign * side, top)
    }
    comment = sprintf("hopper: mouth %g mm wide at a height of %g mm, walls of 60 degrees", 1000 * mouth, 600 * s)
  } else if (part == "chute") {
    # It turns about the point 100 mm below the mouth; 78 mm above it a wall at its upper end, 183 mm below it its lower end.
    up = 0.078 * s; down = 0.183 * s; c = cos(slope); e = sin(slope); z0 = 0.5 * s
    plate(-up * c, z0 + up * e, down * c, z0 - down * e)
    plate(-up * c, z0 + up * e, -up * c, 0.6 * s)
    comment = sprintf("chute: tilt %g degrees, %g mm long, a wall at its upper end", tilt, 1000 * (up + down))
  } else if (part == "box") {
    plate(0, 0, 0.36 * s, 0)
    plate(0, 0, 0, 0.3 * s)
    plate(0.36 * s, 0, 0.36 * s, 0.3 * s)
    comment = sprintf("box: %g mm wide, %g mm high, open at the top", 360 * s, 300 * s)
  } else { print "geometry.sh: no part " part ": use hopper, chute or box" > "/dev/stderr"; exit 2 }
  printf "ply\nformat ascii 1.0\ncomment %s; metres\nelement vertex %d\n", comment, 2 * n
  printf "property double x\nproperty double y\nproperty double z\nelement face %d\n", n / 2
  printf "property list uchar uint vertex_indices\nend_header\n"
  for (i = 0; i < n; i++) { printf "%.6g %.6g %.6g\n%.6g %.6g %.6g\n", x[i], low, z[i], x[i], high, z[i] }
  for (i = 0; i < n; i += 2) printf "4 %d %d %d %d\n", 2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2
}'

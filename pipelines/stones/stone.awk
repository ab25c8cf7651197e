# A stone: grains on a hexagonal lattice in a sphere, turned at random; a share of them is missing (McDowell & Harireche 2002, doi:10.1680/geot.2002.52.2.131).
# awk -v seed=N -v diameter=M -v grain=M -v missing=SHARE -f stone.awk > stone.csv; its height goes to stderr
function at(i, j, k) {
    x = (i + (j % 2 + k % 2) / 2) * grain; y = (j + (k % 2) / 3) * sqrt(3) / 2 * grain; z = k * sqrt(6) / 3 * grain
}
BEGIN {
    # The generator of Park & Miller (1988), the same in every awk.
    state = (seed * 7919 + 12345) % 2147483647
    for (i = 0; i < 20; i++) random()
    # A random orientation (Shoemake 1992).
    pi = 3.14159265358979; u = random(); a = 2 * pi * random(); b = 2 * pi * random()
    qx = sqrt(1 - u) * sin(a); qy = sqrt(1 - u) * cos(a); qz = sqrt(u) * sin(b); qw = sqrt(u) * cos(b)
    half = int(diameter / grain / 1.5) + 2
    # The middle of the lattice is anywhere between its sites.
    ox = (random() - 0.5) * grain; oy = (random() - 0.5) * grain; oz = (random() - 0.5) * grain
    reach = (diameter - grain) / 2; low = 1e9; high = -1e9; n = 0
    for (k = -half; k <= half; k++) for (j = -half; j <= half; j++) for (i = -half; i <= half; i++) {
        at(i + 1000 - 1000, (j + 1000) , (k + 1000)); y -= 1000 * sqrt(3) / 2 * grain; z -= 1000 * sqrt(6) / 3 * grain
        x += ox; y += oy; z += oz
        if (x * x + y * y + z * z > reach * reach || random() < missing) continue
        tx = 2 * (qy * z - qz * y); ty = 2 * (qz * x - qx * z); tz = 2 * (qx * y - qy * x)
        X[n] = x + qw * tx + qy * tz - qz * ty; Y[n] = y + qw * ty + qz * tx - qx * tz; Z[n] = z + qw * tz + qx * ty - qy * tx
        if (Z[n] < low) low = Z[n]
        if (Z[n] > high) high = Z[n]
        n++
    }
    print "x,y,z,radius"
    for (m = 0; m < n; m++) printf "%.9g,%.9g,%.9g,%.9g\n", X[m], Y[m], Z[m] - low + grain / 2, grain / 2
    printf "%.9g %d\n", high - low + grain, n > "/dev/stderr"
}
function random() { state = (state * 16807) % 2147483647; return state / 2147483647 }

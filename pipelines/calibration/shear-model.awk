# A model of a direct shear test that costs nothing, for studies of the method: prints shear stress over shear displacement.
# awk -v load=100 -v stiffness=60 -v strength=30 -v spread=0.4 -v friction=0.6 -v envelope=0.5 -v seed=1 -f shear-model.awk
#
#   tau(u) = mu s (1 - exp(-k u/(mu s))) + c (1 + a s/100) x exp((1 - x)/(0.3 + d)),   x = u k/(3 c)
#
# s: normal load [kPa], k: stiffness [kPa/mm], c: bond strength [kPa], d: spread of the strengths, mu: friction, a: envelope. Each specimen (seed) has its own
# stiffness and strength, 3 % (standard deviation) from the mean, and each point 0.4 kPa of noise.
function normal(  k, sum) { sum = -6; for (k = 0; k < 12; k++) sum += rand(); return sum }
BEGIN {
  srand(7919 * (seed + 1) + load)
  for (k = 0; k < 20; k++) rand()
  stiffness *= 1 + 0.03 * normal(); strength *= 1 + 0.03 * normal()
  print "displacement [mm],shear_stress [kPa]"
  for (n = 0; n <= 80; n++) {
    u = 0.1 * n; limit = friction * load; x = u * stiffness / (3 * strength)
    tau = limit * (1 - exp(-stiffness * u / limit)) + strength * (1 + envelope * load / 100) * x * exp((1 - x) / (0.3 + spread))
    printf "%.3f,%.4f\n", u, tau + (n > 0) * 0.4 * normal()
  }
}

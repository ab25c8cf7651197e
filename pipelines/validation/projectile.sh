#!/usr/bin/env bash
# Steel ball shot into a bed, of the benchmark of open-source codes: projectile.sh prints the tables. SEEDS are the packings, MODULI those [Pa] of the
# runs on the benchmark's own bed, whose last one takes longest.
set -euo pipefail
cd "$(dirname "$0")"
source ./runs.sh
SEEDS=${SEEDS:-1 2 3 4 5} MODULI=${MODULI-1e8 1e9}
BED=$PWD/../../sample-data/benchmark/bed.ply
# Ball below its release [mm]: runs of other codes with 1e9 Pa, from the curves that the page "peclet.dem vs the DEM8 bulk-process benchmark" publishes
# (github.com/computational-chemical-engineering/peclet-examples, benchmarks/dem-bulk-dosta2024/data, case3_*.npz), read every millisecond and evaluated as
# here. The clock of LIGGGHTS begins at its first record, 0.05 ms after the start, and is put right. 25 000 beads: touch, 5 ms later, deepest;
# 50 000 beads: touch; 5, 10 and 15 ms later.
PEERS_25='MUSEN,109.83,19.08,138.02
LIGGGHTS,109.81,19.29,138.91
Peclet (Hertz),108.56,19.95,138.75'
PEERS_50='MUSEN,77.87,20.14,34.24,44.34
LIGGGHTS,77.84,20.15,34.05,44.03
Peclet (Hertz),77.43,20.53,36.00,46.61'

# track NAME: path of the ball, kept.
track() { [ -e "$OUT/$1.track" ] || { dem-measure "$OUT/$1.mcap" --track 1000000 -q > "$OUT/$1.part"; mv "$OUT/$1.part" "$OUT/$1.track"; }; }
# path NAME LEAD: where the ball touches the bed [mm below the release of the benchmark], how far it gets in the 5, 10 and 15 ms after that, and the deepest
# point. The run begins LEAD ms before that release. The ball touches where it is 0.2 mm behind free fall.
path() {
  awk -F, -v lead="$2" '
    function at(time,  i) { for (i = 2; i < n && t[i] < time; i++); return d[i - 1] + (d[i] - d[i - 1]) * (time - t[i - 1]) / (t[i] - t[i - 1]) }
    NR > 1 { n++; t[n] = 1000 * $1 - lead; d[n] = 60 - 1000 * $5; if (d[n] > deepest) deepest = d[n]
      behind = 5 * t[n] + 0.004905 * t[n]^2 - d[n]
      if (!touch && t[n] > 1 && behind > 0.2) touch = t[n - 1] + (0.2 - before) / (behind - before) * (t[n] - t[n - 1])
      before = behind }
    END { x = at(touch); printf "%.2f %.2f %.2f %.2f %.2f\n", x, at(touch + 5) - x, at(touch + 10) - x, at(touch + 15) - x, deepest }' "$OUT/$1.track"
}
# solid NAME LOW HIGH: solid fraction between two heights [m], away from the walls; kept.
solid() {
  [ -e "$OUT/$1.solid" ] || dem-measure "$OUT/$1.mcap" --porosity "box:-0.04,-0.02,$2,0.04,0.02,$3" --time "${4:-0.2}" -q > "$OUT/$1.solid"
  tail -1 "$OUT/$1.solid" | cut -d, -f3
}

# The benchmark's own bed of 25 000 beads, which every code starts from.
echo 'id,x,y,z,radius,vx,vy,vz
1000000,0,0,0.06,0.01,0,0,-5' > "$OUT/projectile-ball.csv"
echo '| the bed of the benchmark, 25 000 beads | modulus [Pa] | touches after [mm] | in the bed after 5 ms [mm] | deepest [mm] |'
echo '|---|---|---|---|---|'
awk -F, '{ printf "| %s | 1e9 | %.1f | %.1f | %.1f |\n", $1, $2, $3, $4 }' <<< "$PEERS_25"
for modulus in $MODULI; do
  name=projectile-own-$modulus
  steel=$(awk -v e="$modulus" 'BEGIN { print (e >= 1e9 ? "2.1e11" : 10 * e) }') box=$(awk -v e="$modulus" 'BEGIN { print (e >= 1e9 ? "2.1e11" : e) }')
  until=$(awk -v e="$modulus" 'BEGIN { print (e >= 1e9 ? 0.033 : 0.028) }')   # after that, softer beads overlap too much between ball and floor
  [ -e "$OUT/$name.track" ] || scene $name projectile --set particles.0.source="\"$BED\"" --set particles.1.source="\"$OUT/projectile-ball.csv\"" --set time.until=$until \
    --set guards.overlap=0.5 --set material.0.young=$modulus --set material.1.young=$steel --set material.2.young=$box
  track $name
  path $name 0 | awk -v e="$modulus" '{ printf "| **Grainpipe** | %s | **%.1f** | **%.1f** | %s |\n", e, $1, $2, (e >= 1e9 ? sprintf("**%.1f**", $5) : "–") }'
done
own=${name:?MODULI is empty}
echo
echo "Solid fraction of this bed, away from walls and surface: $(solid "$own" -0.085 -0.065 0 | awk '{ printf "%.3f", $1 }')."

# Own packings of 50 000 beads. The ball is released 15 ms earlier and higher, so that the bed comes to rest with the modulus of the run.
echo 'id,x,y,z,radius,vx,vy,vz
1000000,0,0,0.13389637,0.01,0,0,-4.85285' > "$OUT/projectile-early.csv"
for seed in $SEEDS; do
  bed=projectile-bed-$seed name=projectile-$seed
  [ -e "$OUT/$name.track" ] || {
    scene $bed projectile-bed --set fill.0.seed=$seed
    scene $name projectile --set particles.0.source="\"$OUT/$bed.mcap\"" --set particles.1.source="\"$OUT/projectile-early.csv\""
  }
  track $name
  echo "solid $(solid $bed -0.085 -0.045)"
  path $name 15 | awk '{ for (i = 1; i <= 4; i++) print "d" i, $i }'
done > "$OUT/projectile.values"
echo
echo '| 50 000 beads | packings | touches after [mm] | in the bed after 5 ms [mm] | after 10 ms [mm] | after 15 ms [mm] |'
echo '|---|---|---|---|---|---|'
awk -F, '{ printf "| %s, the bed of the benchmark | 1 | %.1f | %.1f | %.1f | %.1f |\n", $1, $2, $3, $4, $5 }' <<< "$PEERS_50"
intervals < "$OUT/projectile.values" | awk -v peers="$(tr '\n' ';' <<< "$PEERS_50")" '
  { mean[$1] = $3; off[$1] = $4; packings = $2 }
  END {
    m = split(peers, p, ";"); for (j = 1; j <= m; j++) if (split(p[j], v, ",") == 5) { n++; for (i = 1; i <= 4; i++) peer[i] += v[i + 1] }
    printf "| **Grainpipe**, own packings | %d |", packings
    for (i = 1; i <= 4; i++) printf " **%.1f ± %.1f** |", mean["d" i], off["d" i]
    printf "\n| difference from the mean of the three | |"
    for (i = 1; i <= 4; i++) printf " %+.1f %% |", 100 * (mean["d" i] / peer[i] * n - 1)
    printf "\n\nSolid fraction of the packings: %.3f ± %.3f.\n", mean["solid"], off["solid"] }'
if [ -n "${PAGE:-}" ]; then
  dem-view "$OUT/$own.mcap" --time 0.026 --only y=-0.0006,0.03 --camera front --size 400x250 -o "$(dirname "$PAGE")/validation-projectile.png" -q
  printf '\n![The ball in the bed of 25 000 beads, cut through its middle](validation-projectile.png)\n'
fi

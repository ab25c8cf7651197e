#!/bin/bash
# Measures the speed of the chain from scan to walls, and of the engine by effect and by size, and compares it with the limits of memory and arithmetic.
# usage: bench.sh OUT   (the tools on PATH)   environment: SIZES ("1000 10000 100000 1000000 5000000", none: ""), ROUNDS (3),
# WORK (30: millions of particle-steps a timing), EFFECTS (yes or no), EXAMPLES (folder of the examples limits and tiles)
# If none of them is set, the table is also written to docs/evidence/cost.md.
set -euo pipefail
shopt -s inherit_errexit
here=$(cd "$(dirname "$0")" && pwd)
out=$(cd "$1" && pwd)
whole=$([ -z "${SIZES+x}${ROUNDS+x}${WORK+x}${EFFECTS+x}" ] && echo yes || echo no)
sizes=${SIZES-1000 10000 100000 1000000 5000000} rounds=${ROUNDS:-3} work=${WORK:-30} effects=${EFFECTS:-yes}
examples=${EXAMPLES:-$here/../target/release/examples}
sample=$here/../sample-data/pile/pile50k.ply
folder=$(mktemp -d "$out/bench.XXXXXX")
trap 'rm -rf "$folder"' EXIT
cd "$folder"

now() { date +%s.%N; }
field() { awk -F'[:,]' -v key="\"$2\"" '{ gsub(/ /, "", $1) } $1 == key { print $2 + 0; exit }' "$1"; }
median() { sort -g | awk '{ a[NR] = $1 } END { print NR % 2 ? a[(NR + 1) / 2] : (a[NR / 2] + a[NR / 2 + 1]) / 2 }'; }

chain() {
    chute-scan --points 277647 -q -o scan.ply
    for ((k = 0; k < 3; k++)); do
        local start; start=$(now)
        cloud-crop -q scan.ply --remove halfspace:0,0,0,-1,0,0 | cloud-fill -q | bluenoise-sample -q --spacing 0.005 \
            | wallgen -q --roughness 0.001 -o walls.mcap
        awk -v a="$start" -v b="$(now)" 'BEGIN { print b - a }'
    done | median
}

# Steps that a timing takes: so much work, but 100 steps at least, several times the life of a neighbour list.
steps_of() { awk -v n="$1" -v w="$work" 'BEGIN { s = int(w * 1e6 / n); print s < 100 ? 100 : s }'; }

# Steps before a timing begins.
warm=20

# Millions of particle-steps a second of SCENE on THREADS: a long run less a short one, which has reading, first lists
# and the last frame as well. What is written goes nowhere. Leaves long.json.
speed() {
    local scene=$1 threads=$2 grains=$3 steps; steps=$(steps_of "$3"); shift 3
    local run=(dem-run "$scene" -q --threads "$threads" --set output.every=1e9 "$@")
    "${run[@]}" --until "$(awk -v n=$((steps + warm)) 'BEGIN { print n * 1e-5 }')" --report long.json > /dev/null
    "${run[@]}" --until "$(awk -v n="$warm" 'BEGIN { print n * 1e-5 }')" --report short.json > /dev/null
    awk -v n="$steps" -v g="$grains" -v a="$(field long.json seconds)" -v b="$(field short.json seconds)" \
        'BEGIN { printf "%.3f\n", g * n / (a - b) / 1e6 }'
}

# row NAME SCENE GRAINS TOUCHING LISTED KERNEL ROUNDS [--set KEY=VALUE]…: a line of the table, or why there is none.
row() {
    local name=$1 scene=$2 grains=$3 touching=$4 listed=$5 kernel=$6 times=$7; shift 7
    if ! dem-run "$scene" --check -q "$@" --report check.json 2> refused; then
        if grep -qE "unknown key|not available yet" refused; then
            echo "$name is left out: dem-run does not know its key yet ($(sed -n 's/^dem-run: //p' refused | head -n 1))" | tee -a remarks >&2
            return
        fi
        cat refused >&2; return 1
    fi
    local memory rates=() threads k
    memory=$(awk -F'[:,]' '/"bytes_per_contact"/ { sum += $2 } END { print sum + 0 }' check.json)
    for threads in 1 2; do
        for ((k = 0; k < times; k++)); do speed "$scene" "$threads" "$grains" "$@"; done > rates
        rates+=("$(median < rates)")
    done
    local peak own
    peak=$(awk -v p="$(field long.json peak_memory_bytes)" -v g="$grains" 'BEGIN { printf "%.0f", p / g }')
    own=$(field long.json bytes_per_particle)
    own=${own:-$(field check.json bytes_per_particle)}
    listed=$(field long.json listed_contacts | awk -v g="$grains" -v l="$listed" '{ l = $1 / g } END { if (l > 0) printf "%.2f", l; else print "–" }')
    local share=("–" "–" "–" "–")
    for threads in 1 2; do
        [ "$kernel" = - ] && continue
        # Bandwidth and lanes were measured once; the kernel's needs follow from its contacts.
        read -r -a limit < <("$examples/limits" "$threads" "$touching" "$listed" "limits-$threads" | awk -v k="$kernel" '$1 == k { print $5, $7 }')
        share[$((threads - 1))]=$(awk -v r="${rates[$((threads - 1))]}" -v m="${limit[0]}" 'BEGIN { printf "%.0f %%", 100 * r / m }')
        share[$((threads + 1))]=$(awk -v r="${rates[$((threads - 1))]}" -v m="${limit[1]}" 'BEGIN { printf "%.0f %%", 100 * r / m }')
        if [ "$threads" = 1 ]; then echo "$name|${rates[0]}|${limit[1]}" >> allowed; fi
    done
    echo "| $name | $grains | $touching | $listed | ${rates[0]} | ${rates[1]} | $memory | $peak | ${own:-–} | ${share[0]}, ${share[1]} | ${share[2]}, ${share[3]} |" | tee -a table
    echo "$grains ${rates[0]}" > last
}

# The bench pile's scene on other grains: scene OUT PLY X Y periodic|walls
scene() {
    local walls=""
    [ "$5" = walls ] && walls="s|^plane = .*|box = [0, 0, 0, $3, $4, 1]\nfaces = [\"x-\", \"x+\", \"y-\", \"y+\", \"z-\"]|; /^\\[domain\\]/d; /^periodic/d; /^low = /d; /^high = /d;"
    sed "$walls s|^high = .*|high = [$3, $4, 0.504]|; s|^source = .*|source = \"$2\"|" "$here/scenes/pile.toml" > "$1"
}

# A floor of wall spheres 4 mm apart, 1 mm rough, their tops at z = 0, a little wider than the bed.
floor() {
    awk -v x="$1" -v y="$2" 'BEGIN {
        p = 0.004; nx = int((x + 0.02) / p) + 1; ny = int((y + 0.02) / p) + 1
        printf "ply\nformat ascii 1.0\nelement vertex %d\nproperty double x\nproperty double y\nproperty double z\nend_header\n", nx * ny
        for (i = 0; i < nx; i++) for (j = 0; j < ny; j++) print -0.01 + p * i, -0.01 + p * j, -0.0025 }' > floor.ply
    wallgen -q floor.ply --roughness 0.001 --radius uniform --material floor --young 5e6 --poisson 0.3 -o floor.mcap
}

# A cube of grains, each bonded to its six neighbours: what a step of a bond costs, and what memory alone would allow.
bonds() {
    cat > cube.toml << 'END'
[time]
dt = 1e-5
[[material]]
name = "rock"
density = 2650
young = 1e5
poisson = 0.25
[[contact]]
between = ["rock", "rock"]
law = "hooke"
stiffness = 100
restitution = 0.5
[[fill]]
material = "rock"
shape = "box:0,0,0,0.14,0.14,0.14"
diameter = 0.002
lattice = "cubic"
[[bond]]
between = ["rock", "rock"]
kind = "parallel"
replaces_contact = true
gap = 1e-6
modulus = 1e5
stiffness_ratio = 2.5
tensile_strength = 1e9
shear_strength = 1e9
damping = 0.05
END
    local threads count bytes rates=() grains=343000
    dem-run cube.toml --until 1 --check -q --report check.json
    count=$(field check.json bonds) bytes=$(field check.json bytes_per_bond)
    for threads in 1 2; do rates+=("$(work=0 speed cube.toml "$threads" "$grains")"); done
    awk -v n="$count" -v g="$grains" -v a="${rates[0]}" -v b="${rates[1]}" -v bytes="$bytes" '$1 == "bandwidth" { limit = $2 } $1 == "bond" { operations = $3; divisions = $5; roots = $7; arithmetic = $9 } END {
        printf "%d parallel bonds instead of contacts, in a cube of %d grains: %.1f and %.1f million bond-steps per second on one and two threads, bending, shear, torsion, dashpots and stresses of both ends included. ", n, g, a * n / g, b * n / g
        printf "A bond-step reads %.0f bytes and writes 112 of them, so memory alone would allow %.0f on one thread; its %d adds and multiplies, %d divisions and %d roots would allow %.0f.\n", bytes, 1e3 * limit / (bytes + 112), operations, divisions, roots, arithmetic }' limits-1 | tee bonds
}

# Grains of 4 mm around six of 80 mm, settled from a loose filling: two sizes, 1 : 20. Prints their number and the contacts of each.
two_sizes() {
    sed '/^\[\[particles\]\]/,$d; s|^high = .*|high = [0.24, 0.24, 0.504]|' "$here/scenes/pile.toml" > sizes.toml
    cp sizes.toml loose.toml
    for grains in "0.08 6" "0.004 25000"; do
        printf '[[fill]]\nmaterial = "grain"\nshape = "box:0,0,0,0.24,0.24,0.2"\ndiameter = %s\ncount = %s\n' $grains
    done >> loose.toml
    printf '[[particles]]\nsource = "settled.mcap"\n' >> sizes.toml
    printf '[guards]\noverlap = 0.9\n[[wall]]\nname = "floor"\nmaterial = "floor"\nplane = "0,0,0,0,0,1"\n' | tee -a sizes.toml >> loose.toml
    dem-run loose.toml -q --set contact.0.restitution=0.5 --set time.dt=auto --set output.every=0.3 --until 0.3 -o settled.mcap
    dem-run sizes.toml -q --set output.contacts=true --until 1e-5 -o touch.mcap
    dem-measure touch.mcap --contacts --last -q | awk -F, 'END { printf "%d %.3f\n", $2, $3 / $2 }'
}

# 60 stones of 7 cm as clumps of 100 spheres, settled from a loose filling.
stones() {
    stone-clump "$here/../sample-data/stones/quarry.ply" --spheres 100 -q -o stone.toml
    sed '/^\[\[particles\]\]/,$d; s|^high = .*|high = [0.45, 0.45, 1.2]|' "$here/scenes/pile.toml" > stones.toml
    printf '[guards]\noverlap = 0.9\n[[wall]]\nname = "floor"\nmaterial = "floor"\nplane = "0,0,0,0,0,1"\n' >> stones.toml
    sed 's/^material = .*/material = "grain"/' stone.toml >> stones.toml
    cp stones.toml loose.toml
    printf '[[fill]]\nclump = "stone"\nscale = 0.5\nshape = "box:0,0,0,0.45,0.45,1.1"\ncount = 60\n' >> loose.toml
    dem-run loose.toml -q --set contact.0.restitution=0.5 --set time.dt=auto --set output.every=0.6 --until 0.6 -o settled.mcap
    printf '[[particles]]\nsource = "settled.mcap"\n' >> stones.toml
}

by_effect() {
    local grains x y kind touching listed rolling=(--set contact.0.rolling_resistance=0.1) twisting=(--set contact.0.twisting_resistance=0.1)
    read -r grains x y kind touching listed < <("$examples/tiles" "$sample" 50000 pile.ply)
    scene pile.toml pile.ply "$x" "$y" "$kind"
    pile() { local name=$1 kernel=$2; shift 2; row "$name" pile.toml "$grains" "$touching" "$listed" "$kernel" "$rounds" "$@"; }
    pile frictionless frictionless --set contact.0.sliding_friction=0
    pile "+ sliding friction" friction
    pile "+ rolling resistance" rolling "${rolling[@]}"
    pile "+ twisting resistance" twisting "${rolling[@]}" "${twisting[@]}"
    pile "+ cohesion" cohesion "${rolling[@]}" "${twisting[@]}" --set contact.0.cohesion=sjkr --set contact.0.cohesion_energy_density=1e4
    pile "sliding friction, mixed precision" - --set precision=mixed
    pile "sliding friction, single precision" - --set precision=f32
    { cat pile.toml; printf '[[bond]]\nbetween = ["grain", "grain"]\ngap = 0\nyoung = 1e6\npoisson = 0.25\n'; } > bonded.toml
    row "sliding friction, a bond at every contact" bonded.toml "$grains" "$touching" "$listed" - "$rounds"
    read -r grains x y kind touching listed < <("$examples/tiles" "$sample" 10000 bodies.csv)
    scene clumps.toml bodies.csv "$x" "$y" "$kind"
    sed -i 's|^material = "grain"|clump = "four"|' clumps.toml
    cat >> clumps.toml << 'END'
[[clump]]
name = "four"
material = "grain"
spheres = [[0.0004, 0.0004, 0.0004, 0.0013], [0.0004, -0.0004, -0.0004, 0.0013], [-0.0004, 0.0004, -0.0004, 0.0013], [-0.0004, -0.0004, 0.0004, 0.0013]]
END
    # Bodies are smaller than the grains whose places they take: they fall onto each other first.
    warm=600 row "clumps of 4 spheres" clumps.toml $((4 * grains)) "–" 0 - "$rounds"
    stones
    row "clumps of 100 spheres" stones.toml 6000 "–" 0 - "$rounds"
    read -r grains touching < <(two_sizes)
    row "grains of two sizes, 1 : 20" sizes.toml "$grains" "$touching" 0 - "$rounds"
    read -r grains x y kind touching listed < <("$examples/tiles" "$sample" 50000 bed.ply 0.012)
    scene bed.toml bed.ply "$x" "$y" "$kind"
    row "bed of three layers on a plane" bed.toml "$grains" "$touching" "$listed" - "$rounds"
    floor "$x" "$y"
    awk '/^\[\[wall\]\]/ { wall = 1 } wall && /^(material|plane) = / { next } { print } END { print "source = \"floor.mcap\"" }' bed.toml > spheres.toml
    row "the same on $(grep -c . floor.ply | awk '{ print $1 - 7 }') wall spheres" spheres.toml "$grains" "$touching" "$listed" - "$rounds"
}

by_size() {
    local size grains x y kind touching listed
    for size in $sizes; do
        read -r grains x y kind touching listed < <("$examples/tiles" "$sample" "$size" grains.ply)
        scene size.toml grains.ply "$x" "$y" "$kind"
        # A cube that was cut out springs apart, and half of its contacts open within some hundred steps: it settles between its walls first.
        if [ "$kind" = walls ]; then
            dem-run size.toml -q --set contact.0.restitution=0.5 --set time.dt=auto --set output.contacts=true --set output.every=0.2 \
                --until 0.2 -o settled.mcap
            touching=$(dem-measure settled.mcap --contacts --last -q | awk -F, 'END { printf "%.3f", $3 / $2 }')
            sed -i 's|^source = .*|source = "settled.mcap"|' size.toml
        fi
        row "pile" size.toml "$grains" "$touching" "$listed" friction "$([ "$size" -lt 1000000 ] && echo "$rounds" || echo 1)"
        cat last >> by-size
        if [ "$size" -ge 1000000 ]; then
            dem-run size.toml -q --threads 1 --set output.every=1e9 --until 3e-4 --report filed.json -o filed.mcap
            rm filed.mcap
            awk -v p="$(field filed.json peak_memory_bytes)" -v g="$grains" 'BEGIN { printf "%d %.0f\n", g, p / g }' >> filed
        fi
    done
}

caption() {
    echo "Speeds are millions of particle-steps per second, medians of $rounds rounds (of one from a million grains). The scene is the bench pile of"
    echo "\`make -C pipelines race\` (Hooke, Δt 10⁻⁵ s, the engine's own lists), repeated side by side. Below 50 000 grains it is a cube cut out of the pile, which first settles between walls."
    echo "Each time is the difference between a long run and a short one, both without frames and checkpoints."
    echo "*Touching* and *listed* are pairs per grain (if dem-run does not report its lists, pairs within 0.6 mm). *Memory* is the history of a contact [bytes]."
    echo "*Peak* is the largest resident memory of dem-run, *own* the engine's own count [bytes per grain]. A row with + has the effects of the row above and one more."
    echo
    echo "*Of memory* and *of arithmetic* compare the speed with the limit that memory or arithmetic alone would set, on one thread and on two. The limits were measured in the same run:"
    for threads in 1 2; do
        awk -v t=$threads '$1 == "lanes" { w = $2 } $1 != "lanes" && NF == 3 { v[$1] = $2 } END {
            printf "%s: triad %s GB/s, adds and multiplies %s, divisions %s, roots %s thousand millions a second (f64, %s lanes).\n",
                t == 1 ? "one thread" : "two threads", v["bandwidth"], v["add_multiply"], v["divide"], v["root"], w }' "limits-$threads"
    done
    echo "\`crates/engine/dem/examples/limits/kernels.rs\` has the bytes and operations of a particle and a contact: everything that a step reads or"
    echo "writes, once, as if no cache kept it until the next step. So caches can lead to more than 100 % of memory. A test counts the operations (\`crates/engine/dem/src/passes/operations.rs\`)."
    awk -F'|' 'sub(/^\+ /, "", $1) && before {
            if (!n++) printf "\n"
            printf "With %s a step takes %.2f times the time of the row above and %.2f times its arithmetic.\n", $1, before / $2, allowed / $3
        } { before = $2; allowed = $3 }' allowed
    awk -F' *[|] *' '{ if ($2 == "+ sliding friction") of = $6 * $5; if ($2 ~ /^bed|^the same|^grains of two/ && $5 > 0) all = all sprintf("%s %s: %.2f", all ? ";" : "", $2, of / ($6 * $5)) }
        END { if (of && all) printf "\nTime of a listed contact, its share of the grain included, over that of the pile –%s.\n", all }' table
    awk '$1 > 5000 && !small { small = $2 } { large = $2; n = $1 } END {
        if (small && n >= 1e6) printf "\nA particle-step of %d grains costs %.2f times that of 10 000, on one thread.\n", n, small / large }' by-size
    awk '{ printf "\nWith frames of %d grains written to a file, the peak is %d bytes per grain. A frame written to a pipe, as here, is held in memory once more.\n", $1, $2 }' filed
    sed 's/^/- /' remarks
}

touch table remarks by-size filed allowed
echo "load before: $(cut -d' ' -f1 /proc/loadavg 2> /dev/null || echo unknown) (an idle machine is below 0.3)"
for threads in 1 2; do "$examples/limits" $threads 2.4 4.3 > "limits-$threads"; done
head='| scene | grains | touching | listed | 1 thread | 2 threads | memory | peak | own | of memory | of arithmetic |
|---|---|---|---|---|---|---|---|---|---|---|'
echo "$head"
[ "$effects" = no ] || by_effect
by_size
[ "$effects" = no ] || bonds
echo
{ caption; [ "$effects" = no ] || { echo; cat bonds; }; } | tee words
echo
seconds=$(chain)
echo "Scan of 277 647 points to wall spheres, one pipe: $seconds s (median of 3)." | tee chain

page=$here/../docs/evidence/cost.md
if [ "$whole" = yes ] && [ -e "$page" ]; then
    { echo "$head"; cat table; echo; cat words; echo; cat chain; } > new
    awk '/<!-- bench begins -->/ { print; print ""; while ((getline line < "new") > 0) print line; print ""; skip = 1 }
        /<!-- bench ends -->/ { skip = 0 } !skip' "$page" > page
    cp page "$page"
    echo "written to docs/evidence/cost.md"
fi

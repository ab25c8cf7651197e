#!/usr/bin/env bash
# Measures the error of an impact over the share of the critical step, for each normal law, with contacts sampled and averaged: prints impact-error.csv, from which
# dem-run picks the step that `accuracy` asks for. Runs go to the folder $1; the tools must be on the path.
#
# Restitution of 100 head-on impacts that begin anywhere in a step, each of 0.1, 0.3, 0.5, 0.7, 0.9 and 1: the worst counts. Hooke and
# Hertz against the restitution asked for, JKR, whose adhesion takes its share, against steps of 0.002.
set -euo pipefail
mkdir -p "$1"
OUT=$(cd "$1" && pwd)
cd "$(dirname "$0")"
STEPS=0.005,0.01,0.02,0.05,0.1,0.15,0.2,0.3,0.4,0.5,0.65,0.8
echo "# Error of an impact over the share of the critical step: measured by pipelines/accuracy/table.sh with"
echo "# $(dem-run --version). Head-on, equal spheres of 5 mm, 4.295 m/s (0.9 of the overlap guard in Hertz), no friction;"
echo "# largest relative error of the restitution over 100 phases of the step and restitutions of 0.1 to 1."
echo "law,contacts,safety,error"
for contacts in sampled averaged; do
  for law in hooke hertz jkr; do
    for e in 0.1 0.3 0.5 0.7 0.9 1; do
      truth=(--exact $e)
      [ $law = jkr ] && truth=(--reference safety=0.002)
      cost-curve impact-$law.toml --set contact.0.restitution=$e --set time.contacts=$contacts --set output.every=2.6e-4 \
        --vary safety=$STEPS --measure 'each restitution of --impact' --norm max --work steps --phases 1 "${truth[@]}" \
        --dir "$OUT/table-$contacts-$law-$e" -q
    done | awk -F, -v law=$law,$contacts '$2 == "done" && $13 !~ "reference" && $6 + 0 > worst[$1] {worst[$1] = $6}
        END {for (s in worst) printf "%s,%s,%.3g\n", law, s, worst[s]}' | sort -t, -k3,3g
  done
done

# What every case needs. Read with `source`; OUT is the folder of the runs.
export LC_ALL=C
: "${OUT:?set OUT to the folder of the runs, or call run.sh}"

# scene NAME SCENE SETTINGS…: runs a scene unless that is done. The working folder is that of the cases.
scene() {
  local name=$1 scene=$2
  shift 2
  [ -e "$OUT/$name.mcap" ] || echo "validation: $name" >&2
  ../once.sh "$OUT/$name.mcap" dem-run "$scene.toml" "$@" --threads "${THREADS:-1}" -q --report "$OUT/$name.json"
}

# summary FILE KEY: a number of a measure's JSON.
summary() { tr -d ' \n' < "$1" | grep -o "\"$2\":{\"unit\":\"[^\"]*\",\"value\":[^}]*" | head -1 | sed 's/.*"value"://'; }

# intervals < "LABEL VALUE" lines: "LABEL NUMBER MEAN HALF" with the 95 % interval of Student, in the order of the labels.
intervals() {
  awk '
    BEGIN { split("12.706 4.303 3.182 2.776 2.571 2.447 2.365 2.306 2.262", t, " ") }
    { if (!($1 in n)) order[++labels] = $1; n[$1]++; sum[$1] += $2; squares[$1] += $2 * $2 }
    END {
      for (i = 1; i <= labels; i++) { l = order[i]; m = sum[l] / n[l]; v = squares[l] - n[l] * m * m
        if (n[l] < 2 || n[l] > 10) { print "intervals: " l ": " n[l] " values, and it takes 2 to 10" > "/dev/stderr"; exit 1 }
        printf "%s %d %.6g %.6g\n", l, n[l], m, t[n[l] - 1] * sqrt((v > 0 ? v : 0) / (n[l] - 1) / n[l]) }
    }'
}

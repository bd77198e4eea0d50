#!/usr/bin/env bash
# Tables and plots of the results of run.sh; with `yes`, into docs/ too.
#   report.sh FOLDER [yes]
set -euo pipefail
# shellcheck source=common.sh
. "$(dirname "$0")/common.sh"
here=$root/experiments folder=$1 tables=$1/tables all=$1/runs.csv
mkdir -p "$tables"
{
  echo "$head"
  find "$folder/results" -name '*.csv' -exec cat {} + | LC_ALL=C sort -t, -k1,3 -k4,4n -k5,5n
} >"$all"

# GROUP CASE AXIS, regular expressions
select_runs() { awk -F, -v g="^($1)$" -v c="^($2)$" -v a="$3" '$1 ~ g && $2 ~ c && $3 ~ a' "$all"; }
table() { # NAME GROUP CASE AXIS ROWS NAMES VALUE VARIANTS
  select_runs "$2" "$3" "$4" |
    awk -v rows="$5" -v names="$6" -v value="$7" -v columns="$8" -f "$here/table.awk" >"$tables/$1.md"
}
worse='bias|consumer|100hz|offset|all'
for axis in "rate:peak rate [deg/s]" "speed:speed [m/s]"; do
  for score in points:11 ate:8; do
    name=${axis%%:*} unit=${axis#*:} column=${score#*:} what=${score%%:*}
    table "$name-$what" sweep good "$name" 4 "$unit" "$column" "$modes"
    table "worse-$name-$what" sweep "$worse" "$name" "2 4" "prior | $unit" "$column" "$modes"
  done
done
table recordings-ate recording '.*' - 2 recording 8 "$modes"
table recordings-rotation recording '.*' - 2 recording 10 "$modes"
for kind in recording sequence; do table "ablations-$kind" $kind '.*' - 2 $kind 8 "$ablations"; done
for score in ate:8 max:9; do table "starts-${score%:*}" start '.*' . "2 3" "place | LiDAR" "${score#*:}" default; done
for score in ate:8 rotation:10; do
  table "reality-${score%:*}" reality '.*' - 2 scenario "${score#*:}" "$reality"
done
table sweep-iterations sweep '.*' rate "2 4" "prior | peak rate [deg/s]" 13 "$modes"
select_runs sweep '.*' . | awk -f "$here/gain.awk" >"$tables/gain.md"
select_runs cost '.*' - | awk -v modes="$modes" -f "$here/cost.awk" >"$tables/cost.md"
echo "Commit $(cat "$folder/commit"), $(($(wc -l <"$all") - 1)) runs," \
  "$(awk -F, '$1 == "sweep" && !seen[$5]++ {n++} END {print n + 0}' "$all") seeds of the sweeps," \
  "$(sed -n 's/^model name.*: //p' /proc/cpuinfo | head -1)." >"$tables/origin.md"

# Mean and deviation for the plots: prior axis level variant points sd ate sd
awk -F, '
  function deviation(s, q, m,    v) {v = m > 1 ? (q - s * s / m) / (m - 1) : 0; return sqrt(v > 0 ? v : 0)}
  $1 == "sweep" && $7 == "ok" {
    k = $2 " " $3 " " $4 " " $6
    n[k]++; p[k] += $11; pp[k] += $11 * $11; a[k] += $8; aa[k] += $8 * $8
  }
  END {
    for (k in n)
      print k, p[k] / n[k], deviation(p[k], pp[k], n[k]), a[k] / n[k], deviation(a[k], aa[k], n[k])
  }' "$all" | LC_ALL=C sort -k1,2 -k3,3n >"$folder/plot.dat"
if command -v gnuplot >/dev/null; then
  (cd "$folder" && gnuplot -e "modes='$modes'" "$here/plots.gp")
else
  echo "gnuplot is absent (Debian: gnuplot-nox): no plots" >&2
fi

# What has no rows yet leaves the page as it is.
for file in "$tables"/*.md; do
  case $file in */origin.md) ;; *) [ "$(wc -l <"$file")" -gt 2 ] || rm "$file" ;; esac
done
[ "${2:-no}" = yes ] || exit 0
find "$folder" -maxdepth 1 -name 'results_*.svg' -exec cp {} "$root/docs/images/" \;
# Between the lines "<!-- table NAME -->" and "<!-- end -->" of the page stands the table of that name.
awk -v tables="$tables" '
  /^<!-- end -->/ {skip = 0}
  !skip {print}
  /^<!-- table / {
    file = tables "/" $3 ".md"
    while ((getline line <file) > 0) {print line; skip = 1}
  }' "$root/docs/results.md" >"$folder/results.md"
mv "$folder/results.md" "$root/docs/results.md"

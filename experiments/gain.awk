# A Markdown table of the error of undistorted points [mm] one-pass (imu), iterated and bridge; and the ratios, each taken
# on one recording: mean, and range over the seeds. Reads lines of results (common.sh: head).
BEGIN { FS = "," }

$7 == "ok" {
  error[$2, $3, $4, $5, $6] = $11
  if (!(($2, $3, $4, $5) in seen)) { seen[$2, $3, $4, $5] = 1; key[++n] = $2 SUBSEP $3 SUBSEP $4 SUBSEP $5 }
}

function add(place, what, value) {
  sum[place, what] += value
  if (count[place] == 1 || value < low[place, what]) low[place, what] = value
  if (count[place] == 1 || value > high[place, what]) high[place, what] = value
}

function ratio(place, what) {
  return sprintf("%.2f (%.2f to %.2f)", sum[place, what] / count[place], low[place, what], high[place, what])
}

END {
  print "| prior | axis | level | imu [mm] | iterated [mm] | bridge [mm] | imu / iterated | imu / bridge |"
  print "|---|---|---|---|---|---|---|---|"
  for (i = 1; i <= n; i++) {
    split(key[i], part, SUBSEP)
    place = part[1] " | " part[2] " | " part[3]
    imu = error[key[i], "imu"]
    iterated = error[key[i], "iterated"]
    bridge = error[key[i], "bridge"]
    if (!(imu > 0 && iterated > 0 && bridge > 0)) continue
    if (!(place in count)) order[++places] = place
    count[place]++
    add(place, "imu", imu); add(place, "iterated", iterated); add(place, "bridge", bridge)
    add(place, "by iterated", imu / iterated); add(place, "by bridge", imu / bridge)
  }
  for (i = 1; i <= places; i++) {
    p = order[i]; m = count[p]
    printf "| %s | %.2f | %.2f | %.2f | %s | %s |\n", p, sum[p, "imu"] / m, sum[p, "iterated"] / m,
      sum[p, "bridge"] / m, ratio(p, "by iterated"), ratio(p, "by bridge")
  }
}

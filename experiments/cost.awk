# A Markdown table of the time a scan takes in each mode, and its ratio to imu in the same round: mean +- standard deviation.
# Reads lines of results (common.sh: head). Variable: modes.
BEGIN { FS = "," }
{ ms[$5, $6] = $14; iterations[$6] += $13; runs[$6]++; rounds[$5] = 1 }
END {
  print "| undistortion | iterations | ms a scan | times imu |"
  print "|---|---|---|---|"
  n = split(modes, mode, " ")
  for (i = 1; i <= n; i++) {
    sum = ratios = squares = m = 0
    for (r in rounds)
      if (ms[r, mode[i]] > 0 && ms[r, "imu"] > 0) {
        q = ms[r, mode[i]] / ms[r, "imu"]
        m++; sum += ms[r, mode[i]]; ratios += q; squares += q * q
      }
    if (m == 0) continue
    variance = m > 1 ? (squares - ratios * ratios / m) / (m - 1) : 0
    printf "| %s | %.2f | %.1f | %.3f ± %.3f |\n", mode[i], iterations[mode[i]] / runs[mode[i]], sum / m, ratios / m,
      sqrt(variance > 0 ? variance : 0)
  }
}

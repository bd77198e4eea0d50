# A Markdown table of mean +- standard deviation, out of lines of results (common.sh: head).
# Variables: rows (the columns of the CSV that name a row, as "2 4"), names (of them), value (column), columns (variants).
BEGIN {
  FS = ","
  nrows = split(rows, row_columns, " ")
  nvariants = split(columns, variants, " ")
}

function shown(x) { return sprintf(x < 10 ? "%.2f" : x < 100 ? "%.1f" : "%.0f", x) }

function text_of(cell,    mean, variance, text) {
  text = ""
  if (n[cell] > 0) {
    mean = sum[cell] / n[cell]
    text = shown(mean)
  }
  if (n[cell] > 1) {
    variance = (squares[cell] - n[cell] * mean * mean) / (n[cell] - 1)
    text = text " ± " shown(sqrt(variance > 0 ? variance : 0))
  }
  if (failed[cell] > 0) text = text " (" failed[cell] " failed)"
  return text
}

{
  key = $(row_columns[1])
  for (i = 2; i <= nrows; i++) key = key " | " $(row_columns[i])
  if (!(key in seen)) { seen[key] = 1; order[++keys] = key }
  cell = key SUBSEP $6
  if ($7 != "ok" || $value == "") { failed[cell]++; next }
  n[cell]++; sum[cell] += $value; squares[cell] += $value * $value
}

END {
  line = "| " names " |"; rule = "|"
  for (i = 1; i <= nrows; i++) rule = rule "---|"
  for (v = 1; v <= nvariants; v++) { line = line " " variants[v] " |"; rule = rule "---|" }
  print line; print rule
  for (k = 1; k <= keys; k++) {
    line = "| " order[k] " |"
    for (v = 1; v <= nvariants; v++) line = line " " text_of(order[k] SUBSEP variants[v]) " |"
    print line
  }
}
